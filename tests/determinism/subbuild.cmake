# Builds the program `determinism` in a folder of its own and runs it against the committed table.
# Takes SOURCE_DIR, BUILD_DIR, COMPILER, BUILD_TYPE, EXPECTED_EXIT and EXTRA_ARGS.
find_program(compiler ${COMPILER})
if(NOT compiler)
    message("SKIPPED: ${COMPILER} is not installed")
    return()
endif()
find_program(ninja ninja)
if(ninja)
    set(generator -G Ninja)
endif()
function(run_or_fail)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${log}")
    endif()
endfunction()
run_or_fail(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${BUILD_DIR} ${generator}
            -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DSTILL_TESTS=ON -DSTILL_SUBBUILDS=OFF
            ${EXTRA_ARGS})
run_or_fail(${CMAKE_COMMAND} --build ${BUILD_DIR} --target determinism --parallel)

execute_process(COMMAND ${BUILD_DIR}/tests/determinism/determinism --few RESULT_VARIABLE code)
if(NOT code EQUAL EXPECTED_EXIT)
    message(FATAL_ERROR "exit code ${code}, expected ${EXPECTED_EXIT}")
endif()
