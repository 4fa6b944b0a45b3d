// Mesh files: OBJ with material libraries, and PLY, text and binary. docs/meshes.md says which of their contents are
// used.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scene/description/description.h"
#include "scene/readers/meshes/mesh_text.h"
#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {

/// So many statements of an OBJ, or rows of a PLY, are read before the signal to stop is looked at.
constexpr uint32_t rows_between_stops = 1 << 14;

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
                                  std::vector<std::string>& warnings, StopSignal stop = {});

/// A material as an OBJ names it, before its library is read.
MaterialDescription default_obj_material(const std::string& name);

struct MaterialLibrary {
    std::map<std::string, MaterialDescription, std::less<>> materials;  // by utf8_name() of their names
    NameList ignored;                                                   // what has no meaning here
    NameList missing_maps;
};

/// Adds the materials of a library in text, mapped as docs/meshes.md says. `has_map` tells whether a map's file exists.
/// Throws Error(file): `label`, which names the file, then the line, what is wrong and what would be right.
void read_mtl(std::string_view text, const std::string& label, const std::function<bool(const std::string&)>& has_map,
              MaterialLibrary& library);

/// Throws as read_ply() does if these are not the first bytes of a PLY file.
void check_ply_start(std::string_view start, const std::string& label);

/// The mesh in a PLY file's bytes, with all of its vertices in file order. Throws Error(file): `label`, which names the
/// file, then the line or the byte, what is wrong and what would be right. Adds a warning where vertices have normals.
PolygonMesh read_ply(std::string_view bytes, const std::string& label, std::vector<std::string>& warnings,
                     StopSignal stop = {});

}  // namespace cistula
