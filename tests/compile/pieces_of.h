// What a list of triangles encloses.
#pragma once

#include "scene/compile/meshes/mesh_pieces.h"
#include "scene/description/description.h"

namespace cistula {

inline MeshPieces pieces_of(const TrianglesObject& object) {
    MeshSource source;
    source.vertices = object.vertices;
    source.triangles = object.triangles;
    return find_pieces(source);
}

}  // namespace cistula
