# Read by ctest: a test for each case of the suite in cistula_suite, or one that fails and says what is wrong with suite.json.
# cistula_add_golden_suite sets cistula_compare (the program), cistula_suite (the folder) and cistula_suite_name.
execute_process(COMMAND "${cistula_compare}" suite "${cistula_suite}" --list
    OUTPUT_VARIABLE cistula_cases ERROR_VARIABLE cistula_error RESULT_VARIABLE cistula_status)
if(NOT cistula_status EQUAL 0)
    add_test("${cistula_suite_name}/suite.json" "${cistula_compare}" suite "${cistula_suite}" --list)
    return()
endif()
string(REGEX REPLACE "\n$" "" cistula_cases "${cistula_cases}")
string(REPLACE "\n" ";" cistula_cases "${cistula_cases}")
foreach(cistula_case IN LISTS cistula_cases)
    string(REGEX MATCH "^([^\t]*)\t(.*)$" cistula_case "${cistula_case}")
    set(cistula_case "${CMAKE_MATCH_1}")
    string(REPLACE "," ";" cistula_tags "${CMAKE_MATCH_2}")
    add_test("${cistula_suite_name}/${cistula_case}" "${cistula_compare}" suite "${cistula_suite}" "${cistula_case}")
    set_tests_properties("${cistula_suite_name}/${cistula_case}" PROPERTIES SKIP_RETURN_CODE 4 LABELS "${cistula_tags}")
endforeach()
