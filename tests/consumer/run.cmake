# Builds the consumer in WORK_DIR and looks at the picture that it prints. Takes MODE:
#   installed      installs BUILD_DIR to a prefix of its own and finds the package there; the tests
#                  of golden pictures, too
#   subdirectory   takes SOURCE_DIR in by FetchContent
# and GENERATOR, COMPILER, CONSUMER_FLAGS.
function(run_or_fail)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${ARGN}\n${log}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR}/prefix)
if(MODE STREQUAL "installed")
    run_or_fail(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
    set(where -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
else()
    set(where -DSTILLFRAME_SOURCE=${SOURCE_DIR})
endif()
run_or_fail(${CMAKE_COMMAND} --fresh -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build
            -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} ${CONSUMER_FLAGS} ${where})
run_or_fail(${CMAKE_COMMAND} --build ${WORK_DIR}/build --target consumer --parallel)
run_or_fail(${WORK_DIR}/build/consumer)

execute_process(COMMAND ${WORK_DIR}/build/consumer OUTPUT_FILE ${WORK_DIR}/triangle.ppm)
file(READ ${WORK_DIR}/triangle.ppm picture HEX)
# "P6 320 180 255", then black corners, and the triangle's colour somewhere.
string(LENGTH "${picture}" digits)
math(EXPR expected "2 * (15 + 320 * 180 * 3)")
if(NOT digits EQUAL expected)
    message(FATAL_ERROR "the picture has ${digits} hex digits, expected ${expected}")
endif()
if(NOT picture MATCHES "^50362033323020313830203235350a000000")
    message(FATAL_ERROR "the picture does not begin with its header and black")
endif()
if(NOT picture MATCHES "ffbc59ffbc59ffbc59")
    message(FATAL_ERROR "the triangle is missing")
endif()

if(NOT MODE STREQUAL "installed")
    return()
endif()
# A stranger's tests of his pictures: they pass, and fail with the place when a colour of a scene is
# changed by a thousandth.
file(REMOVE_RECURSE ${WORK_DIR}/changed)
file(COPY ${CMAKE_CURRENT_LIST_DIR}/golden DESTINATION ${WORK_DIR}/changed)
file(READ ${WORK_DIR}/changed/golden/ball.json scene)
string(REPLACE "[0.9, 0.3, 0.1]" "[0.901, 0.3, 0.1]" scene "${scene}")
file(WRITE ${WORK_DIR}/changed/golden/ball.json "${scene}")

set(place "ball-rolls: frame [012]: color is the first stage that differs, in tile")
function(check_change)
    execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK_DIR}/changed
                    RESULT_VARIABLE code OUTPUT_VARIABLE log ERROR_VARIABLE log)
    if(NOT code EQUAL 1 OR NOT log MATCHES "${place}")
        message(FATAL_ERROR "${ARGN}: expected exit code 1 and \"${place}\"\n${code}\n${log}")
    endif()
endfunction()

foreach(framework catch2 gtest)
    run_or_fail(${CMAKE_COMMAND} --fresh -S ${CMAKE_CURRENT_LIST_DIR}/${framework}
                -B ${WORK_DIR}/${framework} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                ${CONSUMER_FLAGS} -DCMAKE_BUILD_TYPE=Debug ${where})
    run_or_fail(${CMAKE_COMMAND} --build ${WORK_DIR}/${framework})
    run_or_fail(${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR}/${framework})
    check_change(${WORK_DIR}/${framework}/golden_test)
endforeach()
run_or_fail(${WORK_DIR}/prefix/bin/stillframe golden verify ${CMAKE_CURRENT_LIST_DIR}/golden)
check_change(${WORK_DIR}/prefix/bin/stillframe golden verify golden)
