# make install: programs, libraries, headers, and a CMake package for find_package(cistula) with the targets
# cistula::cistula | scene | embree | cuda.
include(CMakePackageConfigHelpers)

install(DIRECTORY libcore/cistula libcore/scene DESTINATION "${CISTULA_INSTALL_HEADERS}" FILES_MATCHING PATTERN "*.h")
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")

install(TARGETS cistula_contract cistula EXPORT cistulaCore)
install(EXPORT cistulaCore NAMESPACE cistula:: DESTINATION "${CISTULA_INSTALL_CMAKE}")

set(CISTULA_COMPONENTS cistula)
foreach(_component scene embree cuda)  # cuda: whoever links it brings the language CUDA, and with that the static runtime
    if(TARGET cistula_${_component})
        install(TARGETS cistula_${_component} EXPORT cistula_${_component}
            ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
        install(EXPORT cistula_${_component} NAMESPACE cistula:: DESTINATION "${CISTULA_INSTALL_CMAKE}"
            FILE cistula_${_component}.cmake)
        list(APPEND CISTULA_COMPONENTS ${_component})
    endif()
endforeach()
if(TARGET cistula_embree)
    install(FILES backend_embree/embree/embree_renderer.h DESTINATION "${CISTULA_INSTALL_HEADERS}/backend_embree/embree")
endif()
if(TARGET cistula_cuda)
    install(FILES backend_cuda/host/cuda_renderer.h DESTINATION "${CISTULA_INSTALL_HEADERS}/backend_cuda/host")
endif()

set(CISTULA_READ_PICTURE "cistula-read-picture${CMAKE_EXECUTABLE_SUFFIX}")
set(CISTULA_OIIO_MODULE "")
if(TARGET cistula_oiio)
    set(CISTULA_OIIO_MODULE "${CMAKE_SHARED_MODULE_PREFIX}cistula_oiio${CMAKE_SHARED_MODULE_SUFFIX}")
endif()
configure_package_config_file(cmake/cistulaConfig.cmake.in "${PROJECT_BINARY_DIR}/cistulaConfig.cmake"
    INSTALL_DESTINATION "${CISTULA_INSTALL_CMAKE}" PATH_VARS CISTULA_INSTALL_MODULES NO_SET_AND_CHECK_MACRO)
# Before version 1.0, minor versions may be incompatible.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/cistulaConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/cistulaConfig.cmake" "${PROJECT_BINARY_DIR}/cistulaConfigVersion.cmake"
    DESTINATION "${CISTULA_INSTALL_CMAKE}")
