# Every header of libcore compiles alone and twice: in g++, and those of the shading library in nvcc too, there for the device
# alone, which takes a third of the time. A header that does not breaks the build of the tests.

# cistula_headers_alone(TARGET SUFFIX HEADER...): an object library with one source a header.
function(cistula_headers_alone target suffix)
    set(sources "")
    foreach(header IN LISTS ARGN)
        string(REPLACE "/" "_" name "${header}")
        set(source "${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.${suffix}")
        file(CONFIGURE OUTPUT "${source}" CONTENT "#include \"${header}\"\n#include \"${header}\"\n")
        list(APPEND sources "${source}")
    endforeach()
    add_library(${target} OBJECT ${sources})
    target_link_libraries(${target} PRIVATE cistula cistula_warnings)
endfunction()

file(GLOB_RECURSE core_headers RELATIVE "${PROJECT_SOURCE_DIR}/libcore" CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libcore/cistula/*.h")
file(GLOB_RECURSE scene_headers RELATIVE "${PROJECT_SOURCE_DIR}/libcore" CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libcore/scene/*.h")
list(APPEND scene_headers cistula.h)

cistula_headers_alone(core_headers_alone cpp ${core_headers})
if(TARGET cistula_scene)
    cistula_headers_alone(scene_headers_alone cpp ${scene_headers})
    target_link_libraries(scene_headers_alone PRIVATE
        cistula_scene embree TBB::tbb OpenEXR::OpenEXR fmt::fmt nlohmann_json::nlohmann_json)
endif()
if(CISTULA_CUDA)
    cistula_headers_alone(core_headers_alone_cuda cu ${core_headers})
    set_target_properties(core_headers_alone_cuda PROPERTIES CUDA_PTX_COMPILATION ON CUDA_ARCHITECTURES 75-virtual)
endif()
