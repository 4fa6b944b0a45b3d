// Material libraries of OBJ files.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "scene/description/description.h"
#include "scene/readers/meshes/mesh_text.h"

namespace cistula {

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

}  // namespace cistula
