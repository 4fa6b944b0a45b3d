# find_package says why a component is not there. Included by check.cmake, which sets WORK, a folder for projects, and PREFIX.
function(expect_refused components reason)
    file(WRITE "${WORK}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)\nproject(refused LANGUAGES CXX)\n"
        "find_package(cistula REQUIRED COMPONENTS ${components})\n")
    execute_process(COMMAND "${CMAKE_COMMAND}" -S "${WORK}" -B "${WORK}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${PREFIX}"
        "-DCMAKE_CXX_COMPILER=${COMPILER}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(REGEX REPLACE "[ \n]+" " " output "${output}")  # CMake breaks lines
    string(FIND "${output}" "${reason}" at)
    if(status EQUAL 0 OR at EQUAL -1)
        message(FATAL_ERROR "COMPONENTS ${components}: not refused with \"${reason}\":\n${output}")
    endif()
endfunction()

if(NOT CUDA)
    expect_refused("embree cuda" "This installation of Cistula was built without CUDA")
endif()
expect_refused("embre" "There is no component embre; there are cistula, scene, embree")
