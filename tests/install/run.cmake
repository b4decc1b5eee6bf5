# The install test: installs BUILD_DIRECTORY below WORK_DIRECTORY, builds the user's project of this directory against it alone, and runs it.
# cmake -D BUILD_DIRECTORY=build -D WORK_DIRECTORY=build/install-test -P tests/install/run.cmake
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK_DIRECTORY})
set(stage ${WORK_DIRECTORY}/stage)
run(${CMAKE_COMMAND} --install ${BUILD_DIRECTORY} --prefix ${stage})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIRECTORY}/user -DCMAKE_PREFIX_PATH=${stage} -DCMAKE_BUILD_TYPE=Debug)
run(${CMAKE_COMMAND} --build ${WORK_DIRECTORY}/user)
run(${WORK_DIRECTORY}/user/user)
run(${stage}/bin/karcher version)
# Examples come along, and are found from where the program is.
file(MAKE_DIRECTORY ${WORK_DIRECTORY}/elsewhere)
run(${stage}/bin/karcher new ${WORK_DIRECTORY}/elsewhere/mine --from cantilever)
run(${stage}/bin/karcher check ${WORK_DIRECTORY}/elsewhere/mine/problem.toml)

# Nothing installed may point back into the source tree.
file(GLOB_RECURSE package_files ${stage}/*.cmake)
cmake_path(ABSOLUTE_PATH CMAKE_CURRENT_LIST_DIR BASE_DIRECTORY ${CMAKE_CURRENT_LIST_DIR} NORMALIZE OUTPUT_VARIABLE here)
cmake_path(GET here PARENT_PATH tests_directory)
cmake_path(GET tests_directory PARENT_PATH source_directory)
foreach(file ${package_files})
  file(READ ${file} text)
  string(FIND "${text}" "${source_directory}/" place)
  if(NOT place EQUAL -1)
    message(FATAL_ERROR "${file} names the source tree ${source_directory}.")
  endif()
endforeach()
