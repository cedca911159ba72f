# find_package(mpm) after an installation: mpm::mpm and mpm::impl.
include(${CMAKE_CURRENT_LIST_DIR}/mpm-targets.cmake)
get_filename_component(MPM_SOURCE ${CMAKE_CURRENT_LIST_DIR}/../../mpm/mpm.c ABSOLUTE)
include(${CMAKE_CURRENT_LIST_DIR}/mpm-impl.cmake)
