# Warnings for Cistula's own sources; never exported.
option(CISTULA_WARNINGS_AS_ERRORS "Stop at the first warning" OFF)

# Where several sources are compiled as one, a local name may be that of another source's.
set(_shadow -Wshadow)
if(CMAKE_UNITY_BUILD)
    set(_shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endif()

add_library(cistula_warnings INTERFACE)
target_compile_options(cistula_warnings INTERFACE
    "$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;${_shadow};-Wnon-virtual-dtor;-Wno-missing-field-initializers>"
    "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra>")
if(CISTULA_WARNINGS_AS_ERRORS)
    target_compile_options(cistula_warnings INTERFACE
        $<$<COMPILE_LANGUAGE:CXX>:-Werror> "$<$<COMPILE_LANGUAGE:CUDA>:-Werror=all-warnings>")
endif()

# GCC 13 and later take the entries of an interior list that are beyond its size for read where the list is copied.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
    target_compile_options(cistula_warnings INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>")
endif()
# Without optimization Clang cannot vectorize the loops that ask for it.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CISTULA_SANITIZE)
    target_compile_options(cistula_warnings INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-Wno-pass-failed>")
endif()
