# -DCISTULA_SANITIZE=address,undefined: sanitizers for every host source of this build. An error ends the program.
set(CISTULA_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them")
if(CISTULA_SANITIZE)
    add_compile_options(
        "$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${CISTULA_SANITIZE};-fno-sanitize-recover=all>")
    add_link_options("-fsanitize=${CISTULA_SANITIZE}")
endif()
if(CISTULA_FUZZ)  # what the fuzzer learns from: which branches an input takes
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link>")
endif()
