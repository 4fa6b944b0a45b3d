// Normals at the corners of smooth meshes (docs/rules.md, 17). Private to libcore/scene.
#pragma once

#include <span>

#include "scene/compile/scene_source.h"

namespace cistula {

/// The least cosine of a corner's normal to its face's.
inline constexpr double least_cosine = 1.0 / 8;

/// Gives the solids of one mesh the normals of their corners: those of their vertices, or by the angles between faces.
/// `turned`: of the triangles of each solid, 1 for those that are wound the other way than in the mesh; empty: none is.
/// Warns of the file's normals that are of no use. Throws Error with the place if they are more than half.
void find_corner_normals(SceneSource& source, std::span<SourceSolid> solids,
                         const std::vector<std::vector<uint8_t>>& turned);

}  // namespace cistula
