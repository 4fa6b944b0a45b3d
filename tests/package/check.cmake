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

# With the module for pictures, where the package has it: also from a program that was installed elsewhere, and from the installed
# programs of a prefix that was moved.
set(picture "")
if(OIIO)
    set(picture "${work}/picture.png")
endif()
run("${work}/build/libraries" ${picture})
run("${CMAKE_COMMAND}" --install "${work}/build" --prefix "${work}/elsewhere")
run("${work}/elsewhere/bin/libraries" ${picture})
if(OIIO)
    file(REMOVE "${picture}")
    file(RENAME "${prefix}" "${work}/moved")
    file(WRITE "${work}/scene.json" [[{"film": {"width": 8, "height": 6}, "materials": {"m": {}},
        "objects": [{"solid": "cube", "material": "m"}], "lights": [{"position": [3, -4, 5]}]}]])
    run("${work}/moved/bin/render" "${work}/scene.json" -q -o "${work}/picture.exr" --preview "${picture}")
    if(NOT EXISTS "${picture}")
        message(FATAL_ERROR "the moved program wrote no ${picture}")
    endif()
endif()
