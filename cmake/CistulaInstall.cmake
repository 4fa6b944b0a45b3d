# make install: programs with manuals and completion, libraries, headers, scenes, documents, and a CMake package for
# find_package(cistula) with the targets cistula::cistula | scene | embree | cuda | sequence | compare | verify, the programs' and cistula_add_golden_suite.
include(CMakePackageConfigHelpers)

# Headers: the shading library, whole; of the others those that cistula.h lists, which are public, and what they include, which is
# internal. tests/package compiles them as another project sees them.
function(cistula_add_header header)
    if(header IN_LIST _headers OR header MATCHES "^cistula/")
        return()
    endif()
    set(file "${PROJECT_SOURCE_DIR}/libcore/${header}")
    if(NOT EXISTS "${file}")
        set(file "${PROJECT_SOURCE_DIR}/${header}")  # of a backend
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
    list(APPEND _headers "${header}")
    cmake_path(GET header PARENT_PATH folder)
    install(FILES "${file}" DESTINATION "${CISTULA_INSTALL_HEADERS}/${folder}")
    file(STRINGS "${file}" includes REGEX "^#include \"")
    foreach(line IN LISTS includes)
        string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
        cistula_add_header("${included}")
    endforeach()
    set(_headers "${_headers}" PARENT_SCOPE)
endfunction()
set(_headers "")
cistula_add_header(cistula.h)
cistula_add_header(backend_embree/embree/embree_renderer.h)
cistula_add_header(backend_cuda/host/cuda_renderer.h)
install(DIRECTORY libcore/cistula DESTINATION "${CISTULA_INSTALL_HEADERS}" FILES_MATCHING PATTERN "*.h")

# Scenes beside the schema that they name. Documents lie as in the source tree, so that their links hold.
install(DIRECTORY scenes DESTINATION "${CMAKE_INSTALL_DATADIR}/cistula" PATTERN "*.py" EXCLUDE)
install(FILES docs/scene.schema.json docs/suite.schema.json DESTINATION "${CMAKE_INSTALL_DATADIR}/cistula/docs")
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright)  # where Debian looks for it
install(DIRECTORY docs examples DESTINATION "${CMAKE_INSTALL_DOCDIR}"
    PATTERN Doxyfile EXCLUDE PATTERN packages.txt EXCLUDE PATTERN pictures/render EXCLUDE)

# Completion asks the program for its options. Debian's zsh reads vendor-completions of /usr, others site-functions.
set(_shells "${PROJECT_SOURCE_DIR}/cmake/completion")
install(FILES "${_shells}/_cistula" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions")
install(FILES "${_shells}/_cistula" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")

# Manuals are what the programs say of themselves.
find_program(CISTULA_HELP2MAN help2man)
mark_as_advanced(CISTULA_HELP2MAN)
if(NOT CISTULA_HELP2MAN)
    message(STATUS "No help2man, so no manuals are made (Debian: apt-get install help2man)")
endif()
get_property(_programs DIRECTORY apps PROPERTY BUILDSYSTEM_TARGETS)
foreach(_program IN LISTS _programs)
    get_target_property(_type ${_program} TYPE)
    if(NOT _type STREQUAL "EXECUTABLE")
        continue()
    endif()
    install(FILES "${_shells}/cistula.bash" RENAME "${_program}" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
    if(CISTULA_HELP2MAN)
        set(_manual "${PROJECT_BINARY_DIR}/man/${_program}.1")
        add_custom_command(OUTPUT "${_manual}"
            COMMAND "${PROJECT_SOURCE_DIR}/cmake/make-manual" "${CISTULA_HELP2MAN}" $<TARGET_FILE:${_program}> "${_manual}"
            DEPENDS ${_program} cmake/make-manual VERBATIM)
        add_custom_target(${_program}-manual ALL DEPENDS "${_manual}")
        add_dependencies(installed ${_program}-manual)
        install(FILES "${_manual}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
    endif()
endforeach()

install(TARGETS cistula_contract cistula EXPORT cistulaCore)
install(EXPORT cistulaCore NAMESPACE cistula:: DESTINATION "${CISTULA_INSTALL_CMAKE}")

set(CISTULA_COMPONENTS cistula)
foreach(_component scene embree cuda sequence compare verify)
    if(TARGET cistula_${_component})
        install(TARGETS cistula_${_component} EXPORT cistula_${_component}
            ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
        install(EXPORT cistula_${_component} NAMESPACE cistula:: DESTINATION "${CISTULA_INSTALL_CMAKE}"
            FILE cistula_${_component}.cmake)
        list(APPEND CISTULA_COMPONENTS ${_component})
    endif()
endforeach()
if(TARGET render-compare)
    install(EXPORT cistula_programs NAMESPACE cistula:: DESTINATION "${CISTULA_INSTALL_CMAKE}")
    install(FILES cmake/CistulaGoldenSuite.cmake cmake/CistulaSuiteTests.cmake DESTINATION "${CISTULA_INSTALL_CMAKE}")
    list(APPEND CISTULA_COMPONENTS programs)
endif()
set(CISTULA_READ_PICTURE "cistula-read-picture${CMAKE_EXECUTABLE_SUFFIX}")
set(CISTULA_OIIO_MODULE "")
if(TARGET cistula_oiio)
    set(CISTULA_OIIO_MODULE "${CMAKE_SHARED_MODULE_PREFIX}cistula_oiio${CMAKE_SHARED_MODULE_SUFFIX}")
endif()
# In lower case with a dash, find_package finds the files by any spelling of the name: cistula, Cistula.
configure_package_config_file(cmake/cistula-config.cmake.in "${PROJECT_BINARY_DIR}/cistula-config.cmake"
    INSTALL_DESTINATION "${CISTULA_INSTALL_CMAKE}" PATH_VARS CISTULA_INSTALL_MODULES NO_SET_AND_CHECK_MACRO)
# Before version 1.0, minor versions may be incompatible.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/cistula-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/cistula-config.cmake" "${PROJECT_BINARY_DIR}/cistula-config-version.cmake"
    DESTINATION "${CISTULA_INSTALL_CMAKE}")
include(cmake/CistulaPackage.cmake)
