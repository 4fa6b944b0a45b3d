// OBJ files with their material libraries. docs/meshes.md says which of their contents are used.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

/// The files that an OBJ names, by their names in it.
struct ObjSurroundings {
    std::function<bool(const std::string& name)> has;
    std::function<std::string(const std::string& name)> bytes;  // of one that is there
    std::function<std::string(const std::string& name)> label;  // names it in messages
    std::string default_library;                                // read too where one that is named is missing
};

/// The groups of an OBJ file in file order: a new one begins where the object, the group or the material changes.
/// Throws Error(file): `label`, which names the file, then the line, what is wrong and what would be right. Adds
/// warnings that name missing files and materials, and what has no meaning here.
std::vector<PolygonMesh> read_obj(std::string_view bytes, const std::string& label, const ObjSurroundings& surroundings,
                                  std::vector<std::string>& warnings);

}  // namespace cistula
