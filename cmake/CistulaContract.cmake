# The floating-point contract, a target that everything links: host compiler and nvcc compute exactly what IEEE 754
# says. Contraction is off in both; code that wants a fused multiply-add calls fma explicitly.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    message(FATAL_ERROR "Cistula needs an x86-64 processor with AVX2 and FMA (x86-64-v3); this one is ${CMAKE_SYSTEM_PROCESSOR}.")
endif()
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$")
    message(FATAL_ERROR "Cistula's floating-point flags are known for GCC and Clang, not for ${CMAKE_CXX_COMPILER_ID}.")
endif()

# Flags from outside (command line, environment, toolchain file) that would violate the contract.
string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
foreach(_variable CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${_type} CMAKE_CUDA_FLAGS CMAKE_CUDA_FLAGS_${_type})
    if("${${_variable}}" MATCHES "(-ffast-math|-Ofast|-funsafe-math-optimizations|-fassociative-math|-freciprocal-math|-ffinite-math-only|-ffp-contract=(fast|on)|-use_fast_math|-fmad=true|-ftz=true)")
        message(FATAL_ERROR "${_variable} has ${CMAKE_MATCH_1}: Cistula's images are defined by IEEE arithmetic. Leave it out.")
    endif()
endforeach()

# GCC 12 removes double -> float -> double roundings where its basic-block vectorizer pairs them
# (tests/numerics/compiler.cpp).
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
    # For GLM's constexpr constructors; its headers are system headers, but nvcc warns all the same.
    "$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-Xcudafe --diag_suppress=20012>")
