# Every header of the shading library compiles alone and twice, and all in one source in nvcc, for the device alone; where sources are
# compiled one by one (preset clang), those of libcore/scene compile alone, too. A header that does not breaks the build of the tests.

# cistula_headers_alone(TARGET HEADER...): an object library with one source a header.
function(cistula_headers_alone target)
    set(sources "")
    foreach(header IN LISTS ARGN)
        string(REPLACE "/" "_" name "${header}")
        set(source "${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp")
        file(CONFIGURE OUTPUT "${source}" CONTENT "#include \"${header}\"\n#include \"${header}\"\n")
        list(APPEND sources "${source}")
    endforeach()
    add_library(${target} OBJECT ${sources})
    set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O0>)
    target_link_libraries(${target} PRIVATE cistula cistula_warnings)
endfunction()

file(GLOB_RECURSE core_headers RELATIVE "${PROJECT_SOURCE_DIR}/libcore" CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libcore/cistula/*.h")
file(GLOB_RECURSE scene_headers RELATIVE "${PROJECT_SOURCE_DIR}/libcore" CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libcore/scene/*.h")
list(APPEND scene_headers cistula.h)

list(REMOVE_ITEM core_headers cistula/lanes/register_avx512.h)  # for one instruction set; lanes.h includes it there
cistula_headers_alone(core_headers_alone ${core_headers})
if(TARGET cistula_scene AND NOT CMAKE_UNITY_BUILD)
    cistula_headers_alone(scene_headers_alone ${scene_headers})
    target_link_libraries(scene_headers_alone PRIVATE
        cistula_scene embree TBB::tbb OpenEXR::OpenEXR fmt::fmt nlohmann_json::nlohmann_json)
endif()
if(CISTULA_CUDA)
    list(FILTER core_headers EXCLUDE REGEX "^cistula/lanes/")  # for the host's registers
    list(TRANSFORM core_headers REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
    list(JOIN includes "" includes)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/headers/all.cu")
    file(CONFIGURE OUTPUT "${source}" CONTENT "${includes}${includes}" @ONLY)
    add_library(core_headers_cuda OBJECT "${source}")
    set_target_properties(core_headers_cuda PROPERTIES CUDA_PTX_COMPILATION ON CUDA_ARCHITECTURES 75-virtual)
    target_link_libraries(core_headers_cuda PRIVATE cistula cistula_warnings)
endif()
