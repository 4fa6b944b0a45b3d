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
