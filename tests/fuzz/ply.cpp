// PLY files, to their triangles and topology.
#include <cstdint>

#include "mesh_checks.h"
#include "scene/readers/meshes/mesh_formats.h"
#include "scene/readers/meshes/mesh_text.h"
#include "target.h"

FUZZ_TARGET(ply) {
    using namespace cistula;
    try {
        std::vector<std::string> warnings;
        const std::string bytes = utf8_of(std::string(reinterpret_cast<const char*>(data), size));
        std::vector<PolygonMesh> meshes;
        meshes.push_back(read_ply(bytes, "a.ply", warnings));
        fuzz::check_meshes(std::move(meshes));
        for (const std::string& warning : warnings) fuzz::check_line(warning);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
