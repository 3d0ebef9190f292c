# Highway's headers alone. Its library holds the choice of a target at run time; for another machine
# the compiler's flags have chosen one already.
if(CMAKE_CROSSCOMPILING)
    add_library(hwy::hwy INTERFACE IMPORTED)
    target_include_directories(hwy::hwy SYSTEM INTERFACE ${STILL_MATRIX_HEADERS})
    target_compile_definitions(hwy::hwy INTERFACE HWY_COMPILE_ONLY_STATIC)
    set(hwy_FOUND TRUE)
else()
    find_package(hwy CONFIG REQUIRED)
endif()
