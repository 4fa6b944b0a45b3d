# Installs BUILD into an empty prefix, builds projects against it and runs their programs and the installed ones.
set(work "${BUILD}/tests/package")
set(prefix "${work}/prefix")
set(source "${CMAKE_CURRENT_LIST_DIR}")
file(REMOVE_RECURSE "${work}")

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        list(JOIN ARGN " " line)
        message(FATAL_ERROR "${line}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

# A project against the prefix, configured and built in work/FOLDER.
function(build project folder)
    run("${CMAKE_COMMAND}" -S "${project}" -B "${work}/${folder}" -G "${GENERATOR}" -D "CMAKE_PREFIX_PATH=${prefix}"
        -D "CMAKE_CXX_COMPILER=${COMPILER}" -D CMAKE_BUILD_TYPE=Release)
    if(output MATCHES "Imath")
        message(FATAL_ERROR "find_package(cistula) tells of a library's library:\n${output}")
    endif()
    run("${CMAKE_COMMAND}" --build "${work}/${folder}")
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD}" --config "${CONFIG}" --prefix "${prefix}")
# Installed files name neither the build nor the source folder.
cmake_path(GET source PARENT_PATH tree)
cmake_path(GET tree PARENT_PATH tree)
file(GLOB_RECURSE installed "${prefix}/*.cmake" "${prefix}/*.1" "${prefix}/share/doc/*.txt")
foreach(file IN LISTS installed)
    file(STRINGS "${file}" lines REGEX "(^|[^A-Za-z0-9_./-])(${BUILD}|${tree})(/|[^A-Za-z0-9_.-]|$)")
    if(lines)
        message(FATAL_ERROR "${file} points into ${BUILD} or ${tree}: ${lines}")
    endif()
endforeach()
run(bash "${source}/installed.sh" "${prefix}")

build("${source}" build)
run("${work}/build/headers")
run("${work}/build/verify")
set(PREFIX "${prefix}")
set(WORK "${work}/refused")
include("${source}/refused.cmake")
run(bash "${source}/uninstall.sh" "${CMAKE_COMMAND}" "${BUILD}" "${work}")

# The example, as it is installed, writes what the installed render writes: of a scene in float, and of one whose parts make it double.
file(GLOB examples "${prefix}/share/doc/*/examples")
build("${examples}" example)
file(WRITE "${work}/scene.json" [[{"film": {"width": 8, "height": 6, "supersample": 2}, "depth": 3, "materials": {"m": {"reflection": 0.5}},
    "objects": [{"solid": "cube", "material": "m"}], "lights": [{"position": [3, -4, 5]}]}]])
file(WRITE "${work}/double.json" [[{"film": {"width": 7, "height": 5}, "materials": {"m": {}}, "lights": [{"position": [3, -4, 5]}],
    "objects": [{"solid": "cube", "material": "m", "radius": 1e-5}, {"solid": "cube", "center": [3, 3, 3], "material": "m"}]}]])
foreach(scene scene double)
    run("${work}/example/example" "${work}/${scene}.json" "${work}/example.exr" "${work}/example.png")
    if(scene STREQUAL "double" AND NOT output MATCHES "^double: ")
        message(FATAL_ERROR "the example does not say that it takes double: ${output}")
    endif()
    run("${prefix}/bin/render" "${work}/${scene}.json" -o "${work}/render.exr" --preview "${work}/render.png")
    foreach(kind exr png)
        run("${CMAKE_COMMAND}" -E compare_files "${work}/example.${kind}" "${work}/render.${kind}")
    endforeach()
endforeach()

include("${source}/suite.cmake")

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
    run("${work}/moved/bin/render" "${work}/scene.json" -q -o "${work}/picture.exr" --preview "${picture}")
    if(NOT EXISTS "${picture}")
        message(FATAL_ERROR "the moved program wrote no ${picture}")
    endif()
endif()
