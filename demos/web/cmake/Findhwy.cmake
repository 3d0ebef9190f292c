# Highway for WebAssembly: headers only. Its library holds the choice of a target at run time, and
# here the flag -msimd128 has chosen one already.
add_library(hwy::hwy INTERFACE IMPORTED)
target_include_directories(hwy::hwy SYSTEM INTERFACE ${STILL_WEB_HEADERS})
set(hwy_FOUND TRUE)
