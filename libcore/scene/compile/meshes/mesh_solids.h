// Meshes as solids. Private to libcore/scene.
#pragma once

#include "scene/compile/meshes/mesh_pieces.h"
#include "scene/compile/scene_source.h"
#include "scene/readers/meshes/mesh_file.h"

namespace cistula {

/// Groups of a mesh file that are one mesh.
struct MeshGroup {
    MeshPart part;
    MeshPieces pieces;
};

/// The groups of a mesh file. Those that are closed stay as they are; but one that is wound inward, and lies in one of
/// its material that is not, is joined to it as a hole. Of one material, those that are open are joined if that closes
/// them; else what an earlier one has, too, is left out. one_material: all of the groups have one, whatever the file
/// says.
std::vector<MeshGroup> join_groups(std::vector<MeshPart> parts, bool one_material, StopSignal stop);

/// Adds the solids of a mesh, which is `solid.mesh`, and warnings about it.
void add_mesh_solids(SceneSource& source, SourceSolid solid, MeshPieces pieces);

}  // namespace cistula
