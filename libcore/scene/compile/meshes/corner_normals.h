// Normals at the corners of smooth meshes (docs/rules.md, 17). Private to libcore/scene.
#pragma once

#include <span>

#include "scene/compile/meshes/mesh_pieces.h"
#include "scene/compile/scene_source.h"

namespace cistula {

/// The least cosine of a corner's normal to its face's.
inline constexpr double least_cosine = 1.0 / 8;

/// Turns the winding of a sheet's triangles whose normals all oppose it: of each run of triangles that are joined by
/// edges of two, wound alike, if no corner's normal agrees with it and one at least is of use once it is turned.
void turn_to_normals(const MeshSource& mesh, MeshPieces& pieces);

/// Gives the solids of one mesh the normals of their corners: those of their vertices, or by the angles between faces.
/// `turned`: of the triangles of each closed solid, 1 for those that are wound the other way than in the mesh; empty:
/// none is.
/// Warns of the file's normals that are of no use. Throws Error with the place if they are more than half.
void find_corner_normals(SceneSource& source, std::span<SourceSolid> solids,
                         const std::vector<std::vector<uint8_t>>& turned);

}  // namespace cistula
