# Compiler flags and commit of a build, for libcore/base/machine.cpp: recorded by render --stats and the benchmarks.
string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
set(_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_type}} ${_host}")
string(REPLACE ";" " " _flags "${_flags}")
string(STRIP "${_flags}" _flags)

# A source tree without its own .git may lie inside another repository, whose commit would be wrong.
set(_commit "")
find_program(CISTULA_GIT git)
mark_as_advanced(CISTULA_GIT)
if(CISTULA_GIT AND EXISTS "${PROJECT_SOURCE_DIR}/.git")
    execute_process(COMMAND "${CISTULA_GIT}" -C "${PROJECT_SOURCE_DIR}" describe --always --dirty --abbrev=12
        OUTPUT_VARIABLE _commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    # The log of HEAD changes with every commit and checkout; the next build then reconfigures, so that records name the
    # commit that ran.
    execute_process(COMMAND "${CISTULA_GIT}" -C "${PROJECT_SOURCE_DIR}" rev-parse --git-path logs/HEAD
        OUTPUT_VARIABLE _head_log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    get_filename_component(_head_log "${_head_log}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
    if(EXISTS "${_head_log}" AND NOT IS_DIRECTORY "${_head_log}")
        set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${_head_log}")
    endif()
endif()
if(NOT _commit)
    set(_commit "unknown")
endif()

set_source_files_properties("${PROJECT_SOURCE_DIR}/libcore/base/machine.cpp" TARGET_DIRECTORY cistula_scene PROPERTIES
    COMPILE_DEFINITIONS "CISTULA_BUILD_FLAGS=\"${_flags}\";CISTULA_BUILD_COMMIT=\"${_commit}\"")

# cistula_record_cuda(TARGET FLAG...): defines the name of nvcc and the flags of kernels in a program, for its
# records.
function(cistula_record_cuda target)
    string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
    list(JOIN ARGN " " flags)
    list(JOIN CMAKE_CUDA_ARCHITECTURES "," architectures)
    string(STRIP "${CMAKE_CUDA_FLAGS} ${CMAKE_CUDA_FLAGS_${type}}" any_flags)
    string(STRIP "${any_flags} ${flags} -arch ${architectures}" flags)
    target_compile_definitions(${target} PRIVATE
        CISTULA_CUDA_COMPILER="${CMAKE_CUDA_COMPILER_ID} ${CMAKE_CUDA_COMPILER_VERSION}" CISTULA_CUDA_FLAGS="${flags}")
endfunction()
