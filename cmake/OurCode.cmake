# SPDX-License-Identifier: GPL-3.0-or-later
# What all of our own targets share: warnings, floating-point rules, sanitizers, and a library per folder.

# A package's headers are system headers to us, whatever its config file says.
foreach(package IN ITEMS embree glm::glm TBB::tbb CGAL::CGAL OpenImageIO::OpenImageIO CLI11::CLI11
                         tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json
                         draco::draco meshoptimizer::meshoptimizer)
  if(TARGET ${package})
    get_target_property(aliased ${package} ALIASED_TARGET)
    if(aliased)
      set(package ${aliased})
    endif()
    get_target_property(directories ${package} INTERFACE_INCLUDE_DIRECTORIES)
    if(directories)
      # Debian's OpenImageIO names a folder of OpenCV that it does not depend on; CMake refuses folders that are absent.
      list(FILTER directories EXCLUDE REGEX "opencv4$")
      set_target_properties(${package} PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${directories}" INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${directories}")
    endif()
  endif()
endforeach()

# GLM's length() is an int and its enums are unsigned; nothing in it needs our flags.
add_library(clerestory_our_code INTERFACE)
if(MSVC)
  target_compile_options(clerestory_our_code INTERFACE /W4 /WX /permissive- /fp:precise /arch:AVX2)
else()
  # -ffp-contract=off: a fused multiply-add rounds once where the compiler likes, so results would depend on it.
  target_compile_options(clerestory_our_code INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Werror -ffp-contract=off)
  # g++ 12 sees overlapping copies in "text" + std::string() (its bug 105651).
  target_compile_options(clerestory_our_code INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(clerestory_our_code INTERFACE -march=x86-64-v3)
  endif()
  if(CLERESTORY_SANITIZE)
    target_compile_options(clerestory_our_code INTERFACE
      -fsanitize=${CLERESTORY_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    # The sanitizers stand between us and dlopen, which then looks along the program's RPATH, not its RUNPATH.
    target_link_options(clerestory_our_code INTERFACE -fsanitize=${CLERESTORY_SANITIZE}
                        $<$<PLATFORM_ID:Linux>:-Wl,--disable-new-dtags>)
  endif()
endif()

# clerestory_library(NAME SOURCES… ): the library clerestory_NAME of this folder, its headers in include/.
function(clerestory_library name)
  add_library(clerestory_${name} STATIC ${ARGN})
  target_include_directories(clerestory_${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include)
  target_link_libraries(clerestory_${name} PRIVATE clerestory_our_code)
endfunction()
