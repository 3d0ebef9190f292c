# Runs PROGRAM, a build of `determinism` with a fault, until it finds a difference: at once, unless
# the fault is one of chance. It must say in which stage and tile.
set(rounds 0)
while(rounds LESS 20)
    math(EXPR rounds "${rounds} + 1")
    execute_process(COMMAND ${PROGRAM} --few RESULT_VARIABLE code OUTPUT_VARIABLE report
                    ERROR_VARIABLE report)
    if(NOT code STREQUAL "0")
        break()
    endif()
endwhile()
string(REGEX MATCH "[^\n]+, frame [0-9]+, stage [a-z]+, tile \\([0-9]+, [0-9]+\\)[^\n]*\n[^\n]*" first
       "${report}")
if(NOT code STREQUAL "1" OR first STREQUAL "")
    message(FATAL_ERROR "exit code ${code}, expected 1 and a line with stage and tile:\n${report}")
endif()
message("Found in round ${rounds}: ${first}")
