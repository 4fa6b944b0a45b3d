// OBJ files and, behind a line "---", the library that they name, to their triangles and topology.
#include <cstdint>

#include "mesh_checks.h"
#include "scene/readers/meshes/mesh_formats.h"
#include "scene/readers/meshes/mesh_text.h"
#include "target.h"

FUZZ_TARGET(obj) {
    using namespace cistula;
    const std::string input(reinterpret_cast<const char*>(data), size);
    const std::string separator = "\n---\n";
    const size_t end = std::min(input.find(separator), size);
    ObjSurroundings around;
    around.has = [](const std::string& name) { return name.ends_with(".mtl"); };
    around.bytes = [&](const std::string&) {
        return end == size ? std::string() : input.substr(end + separator.size());
    };
    around.label = [](const std::string&) { return std::string("a.mtl"); };
    try {
        std::vector<std::string> warnings;
        fuzz::check_meshes(read_obj(utf8_of(input.substr(0, end)), "a.obj", around, warnings));
        for (const std::string& warning : warnings) fuzz::check_line(warning);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
