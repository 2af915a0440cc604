# Installs the build in BUILD below WORK, builds the example against it, and renders with it.
#   cmake -D BUILD=… -D SOURCE=… -D WORK=… -P run.cmake
function(run expected)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status
    OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL expected)
    message(FATAL_ERROR "${ARGN}: expected status ${expected}, found ${status}\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(0 ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
run(0 ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/build -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${WORK}/installed -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_CXX_FLAGS=${FLAGS})
run(0 ${CMAKE_COMMAND} --build ${WORK}/build)

set(scene "LookAt 1 -2 2  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 40
Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32
Sampler \"independent\" \"integer pixelsamples\" 64
WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] MATERIAL
Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  0 1 0]")
foreach(material "\"diffuse\"" "\"minnaert\"" "\"minnaert\" \"float darkening\" 2")
  string(REPLACE MATERIAL "Material ${material}" text "${scene}")
  string(MAKE_C_IDENTIFIER "${material}" name)
  file(WRITE ${WORK}/${name}.pbrt "${text}")
endforeach()
set(own ${WORK}/build/minnaert)
set(lambert _diffuse_)
set(same _minnaert_)
set(darker _minnaert___float_darkening__2)
foreach(name ${lambert} ${same} ${darker})
  run(0 ${own} render ${name}.pbrt -o ${name}.exr)
endforeach()
# With an exponent of 1 it is Lambert's law, which the tree has; with 2 it is another.
run(0 ${own} diff ${lambert}.exr ${same}.exr)
run(1 ${own} diff ${lambert}.exr ${darker}.exr)
# Our own program does not know it.
run(2 ${WORK}/installed/bin/rapport render ${same}.pbrt -o none.exr)
