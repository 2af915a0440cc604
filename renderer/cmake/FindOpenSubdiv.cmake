# OpenSubdiv::OpenSubdiv (CPU). Debian's package configuration names a static library that it does
# not ship, so the header and the shared library are found directly.
find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/bfr/refinerSurfaceFactory.h)
find_library(OpenSubdiv_LIBRARY osdCPU)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_LIBRARY OpenSubdiv_INCLUDE_DIR)
if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::OpenSubdiv)
  add_library(OpenSubdiv::OpenSubdiv SHARED IMPORTED)
  set_target_properties(OpenSubdiv::OpenSubdiv PROPERTIES
    IMPORTED_LOCATION ${OpenSubdiv_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenSubdiv_INCLUDE_DIR})
endif()
