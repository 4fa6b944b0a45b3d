# cistula_test_limit(VARIABLE SECONDS): the limit of tests of which the longest takes SECONDS on idle cores, for their TIMEOUT. It is ten
# times that up to a minute, four times above, in whole tens; three times as much under sanitizers. It is there for what hangs: a
# machine half as fast, and loaded, does not meet it. So no test waits by the clock for what may take longer.
function(cistula_test_limit variable seconds)
    if(seconds LESS_EQUAL 60)
        math(EXPR limit "10 * ${seconds}")
    else()
        math(EXPR limit "(4 * ${seconds} + 9) / 10 * 10")
    endif()
    if(CISTULA_SANITIZE)
        math(EXPR limit "3 * ${limit}")
    endif()
    set(${variable} ${limit} PARENT_SCOPE)
endfunction()
