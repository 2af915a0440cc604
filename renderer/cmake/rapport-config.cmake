# find_package(rapport): the rooms as rapport::core, rapport::materials, …, rapport::app. An executable
# that links rapport::app and calls rapport::run_program (renderer/app/program.h) is the `rapport`
# command with its own materials, lights and shapes added.
include(CMakeFindDependencyMacro)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}) # FindEmbree, FindOpenSubdiv
find_dependency(glm)
find_dependency(fmt)
find_dependency(OpenEXR 3)
find_dependency(Embree)
find_dependency(OpenSubdiv MODULE)
find_dependency(TinyGLTF)
find_dependency(nlohmann_json)
find_dependency(CLI11)
find_dependency(tomlplusplus)
find_dependency(PkgConfig)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
find_dependency(glfw3 3.3)
include(${CMAKE_CURRENT_LIST_DIR}/rapport-targets.cmake)
