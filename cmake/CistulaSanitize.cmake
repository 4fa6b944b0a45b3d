# -DCISTULA_SANITIZE=address,undefined: sanitizers for every host source of this build. An error ends the program.
set(CISTULA_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them")
if(CISTULA_SANITIZE)
    add_compile_options(
        "$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${CISTULA_SANITIZE};-fno-sanitize-recover=all>")
    add_link_options("-fsanitize=${CISTULA_SANITIZE}")
endif()
