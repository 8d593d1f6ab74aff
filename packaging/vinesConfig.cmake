# What find_package(vines) reads: the installed core and what it needs.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/vinesTargets.cmake)
