# The floating-point contract, one target that everything links: what IEEE 754 says is what is computed, by the host compiler
# and by nvcc alike. Contraction is off on both sides; where a fused multiply-add helps, the code asks for it by name.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    message(FATAL_ERROR "Cistula needs an x86-64 processor with AVX2 and FMA (x86-64-v3); this one is ${CMAKE_SYSTEM_PROCESSOR}.")
endif()
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$")
    message(FATAL_ERROR "Cistula's floating-point flags are known for GCC and Clang, not for ${CMAKE_CXX_COMPILER_ID}.")
endif()

# Flags from outside (command line, environment, toolchain file) that would break it.
string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
foreach(_variable CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${_type} CMAKE_CUDA_FLAGS CMAKE_CUDA_FLAGS_${_type})
    if("${${_variable}}" MATCHES "(-ffast-math|-Ofast|-funsafe-math-optimizations|-fassociative-math|-freciprocal-math|-ffinite-math-only|-ffp-contract=(fast|on)|-use_fast_math|-fmad=true|-ftz=true)")
        message(FATAL_ERROR "${_variable} has ${CMAKE_MATCH_1}: Cistula's images are defined by IEEE arithmetic. Leave it out.")
    endif()
endforeach()

# GCC 12 takes double -> float -> double roundings away where its basic-block vectorizer pairs them (tests/numerics/compiler.cpp).
set(_host -ffp-contract=off -fno-math-errno -fno-trapping-math -fno-tree-slp-vectorize -march=x86-64-v3)
string(REPLACE ";" "," _host_of_nvcc "${_host}")
set(_device -fmad=false -prec-div=true -prec-sqrt=true -ftz=false)

add_library(cistula_contract INTERFACE)
add_library(cistula::contract ALIAS cistula_contract)
set_target_properties(cistula_contract PROPERTIES EXPORT_NAME contract)
target_compile_features(cistula_contract INTERFACE cxx_std_20)
target_compile_definitions(cistula_contract INTERFACE GLM_FORCE_PURE)
target_compile_options(cistula_contract INTERFACE
    "$<$<COMPILE_LANGUAGE:CXX>:${_host}>"
    "$<$<COMPILE_LANGUAGE:CUDA>:${_device};-Xcompiler=${_host_of_nvcc}>"
    # GLM's constexpr constructors; its headers are system headers, but nvcc warns all the same.
    "$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-Xcudafe --diag_suppress=20012>")
