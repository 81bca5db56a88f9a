# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the viewer's one script: npm fetches what package-lock.json names, esbuild bundles it. Run as
#   cmake -DSOURCE=report/viewer -DWORK=DIR -DOUTPUT=viewer.js -P bundle.cmake
# Without npm, or where its registry does not answer, OUTPUT is empty and the page says that it has no viewer.
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
set(reason "")
if(NOT NPM OR NOT NODE)
  set(reason "npm is not installed")
else()
  file(MAKE_DIRECTORY ${WORK})
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${WORK})
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
                  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
  if(failed)
    set(reason "npm could not fetch its packages: ${said}")
  else()
    set(ENV{NODE_PATH} ${WORK}/node_modules)
    execute_process(COMMAND ${NODE} ${WORK}/node_modules/esbuild/bin/esbuild ${SOURCE}/viewer.js --bundle
                            --minify --format=iife --target=es2020 --charset=ascii --legal-comments=inline
                            --log-level=error --outfile=${OUTPUT}
                    RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "esbuild could not bundle ${SOURCE}/viewer.js")
    endif()
  endif()
endif()
if(reason)
  message(WARNING "The report's page will have no 3D viewer: ${reason}")
  file(WRITE ${OUTPUT} "")
endif()
