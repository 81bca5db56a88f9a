# SPDX-License-Identifier: GPL-3.0-or-later
# Finds OpenColorIO; Debian's own config file lies where CMake does not look and is wrong if it is forced.
# Gives OpenColorIO::OpenColorIO and OpenColorIO_VERSION.
find_path(OpenColorIO_INCLUDE_DIR OpenColorIO/OpenColorABI.h)
find_library(OpenColorIO_LIBRARY OpenColorIO)
if(OpenColorIO_INCLUDE_DIR)
  file(STRINGS ${OpenColorIO_INCLUDE_DIR}/OpenColorIO/OpenColorABI.h version_line
       REGEX "define OCIO_VERSION_FULL_STR|define OCIO_VERSION_STR|define OCIO_VERSION ")
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" OpenColorIO_VERSION "${version_line}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenColorIO REQUIRED_VARS OpenColorIO_LIBRARY OpenColorIO_INCLUDE_DIR
                                  VERSION_VAR OpenColorIO_VERSION)
if(OpenColorIO_FOUND AND NOT TARGET OpenColorIO::OpenColorIO)
  add_library(OpenColorIO::OpenColorIO UNKNOWN IMPORTED)
  set_target_properties(OpenColorIO::OpenColorIO PROPERTIES
    IMPORTED_LOCATION ${OpenColorIO_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OpenColorIO_INCLUDE_DIR})
endif()
mark_as_advanced(OpenColorIO_INCLUDE_DIR OpenColorIO_LIBRARY)
