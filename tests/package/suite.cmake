# Another repository, of scenes and a suite of golden images: its cases are tests of ctest by the installed package, and fail where they
# should. Included by check.cmake.
set(scenes "${work}/scenes")
file(COPY "${source}/suite/" DESTINATION "${scenes}")
run("${CMAKE_COMMAND}" -S "${scenes}" -B "${scenes}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}")

# expect_tests(STATUS LINE...): ctest ends so, and each regular expression fits a line of its output.
function(expect_tests status)
    execute_process(COMMAND "${CMAKE_CTEST_COMMAND}" --test-dir "${scenes}/build" --output-on-failure
        RESULT_VARIABLE ended OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT ended EQUAL status)
        message(FATAL_ERROR "ctest of a suite ended with ${ended}:\n${output}")
    endif()
    foreach(line IN LISTS ARGN)
        if(NOT output MATCHES "${line}")
            message(FATAL_ERROR "ctest of a suite does not say ${line}:\n${output}")
        endif()
    endforeach()
endfunction()

# Cases with golden images that were made elsewhere.
expect_tests(0 "golden/cube \\.+ +Passed" "golden/glass/layers \\.+ +Passed" "golden/film \\.+ +Passed" "again/film \\.+ +Passed"
    "quick += " "mirrors += ")
if(NOT CUDA)
    expect_tests(0 "golden/gpu \\.+\\*+Skipped")
endif()

# A scene that changed fails its own case, and says which pixel is worst.
file(READ "${scenes}/cube.json" cube)
string(REPLACE "0.5" "0.4" other "${cube}")
file(WRITE "${scenes}/cube.json" "${other}")
expect_tests(8 "golden/cube \\.+\\*+Failed" "floats differ; worst: [BGR] at \\(" "golden/film \\.+ +Passed")
file(WRITE "${scenes}/cube.json" "${cube}")

# What is added to the suite is tested without another configuration; what is wrong with it is said.
file(READ "${scenes}/golden/suite.json" suite)
set(none "{\"name\": \"none\", \"scene\": \"../film.json\", \"golden\": \"none.exr\"}")
string(REPLACE "\"cases\": [" "\"cases\": [${none}," other "${suite}")
file(WRITE "${scenes}/golden/suite.json" "${other}")
expect_tests(8 "golden/none \\.+\\*+Failed" "none.exr is not there; --update none records it" "golden/cube \\.+ +Passed")
string(REPLACE "\"bits\"" "\"bit\"" other "${suite}")
file(WRITE "${scenes}/golden/suite.json" "${other}")
expect_tests(8 "golden/suite.json \\.+\\*+Failed" "/cases/1/bit: unknown key; did you mean 'bits'")
