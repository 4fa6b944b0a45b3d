# Warnings for Cistula's own sources; never exported.
option(CISTULA_WARNINGS_AS_ERRORS "Stop at the first warning" OFF)

add_library(cistula_warnings INTERFACE)
target_compile_options(cistula_warnings INTERFACE
    "$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wshadow;-Wnon-virtual-dtor;-Wno-missing-field-initializers>"
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
