# Installs BUILD into an empty prefix, builds the project in SOURCE against it and runs its programs.
set(work "${BUILD}/tests/package")
set(prefix "${work}/prefix")
file(REMOVE_RECURSE "${work}")

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGN " " line)
        message(FATAL_ERROR "${line}\n${output}")
    endif()
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD}" --config "${CONFIG}" --prefix "${prefix}")
# Installed files name neither the build nor the source folder.
file(GLOB_RECURSE installed "${prefix}/*.cmake")
foreach(file IN LISTS installed)
    file(STRINGS "${file}" lines REGEX "${BUILD}")
    if(lines)
        message(FATAL_ERROR "${file} points into ${BUILD}: ${lines}")
    endif()
endforeach()

run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${work}/build" -G "${GENERATOR}" -D "CMAKE_PREFIX_PATH=${prefix}"
    -D "CMAKE_CXX_COMPILER=${COMPILER}" -D CMAKE_BUILD_TYPE=Release)
run("${CMAKE_COMMAND}" --build "${work}/build")
run("${work}/build/headers")
run("${work}/build/libraries")
