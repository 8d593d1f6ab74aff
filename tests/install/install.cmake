# Installs the core of the build in BUILD into the folder WORK and moves the installation. Then
# builds a program that uses only the installation, with the settings of that build (GENERATOR,
# COMPILER, TYPE, FLAGS), and runs it: with CMake's package, and with pkg-config.
file(REMOVE_RECURSE ${WORK})
function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first --component core)
file(RENAME ${WORK}/first ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${TYPE}
    "-DCMAKE_CXX_FLAGS=${FLAGS} -Wall -Wextra -Wpedantic -Werror")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/outside)

file(GLOB_RECURSE description ${WORK}/prefix/*/vines-core.pc)
cmake_path(GET description PARENT_PATH descriptions)
set(ENV{PKG_CONFIG_PATH} ${descriptions})
find_program(PKG_CONFIG pkg-config REQUIRED)
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs vines-core
    OUTPUT_VARIABLE words OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(words UNIX_COMMAND "${words}")
separate_arguments(flags UNIX_COMMAND "${FLAGS} -O1")
run(${COMPILER} -std=c++20 ${flags} ${CMAKE_CURRENT_LIST_DIR}/outside.cpp ${words} -o ${WORK}/outside)
run(${WORK}/outside)
