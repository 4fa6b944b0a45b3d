// How thin a mesh is and how small its triangles are. Private to libcore/scene.
#pragma once

#include "base/box.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/mesh_source.h"

namespace cistula {

/// Sizes of a mesh in the frame, over its triangles with an area and finite corners.
struct MeshSize {
    Box box;
    size_t triangles = 0;
    double half_width = 0;    // area / 2 over the diagonal of the box
    double least_height = 0;  // of a triangle that is higher than asked for; infinity: there is none
};

MeshSize mesh_size(const MeshSource& mesh, const SceneNormalization& normalization, double least_height);

/// The least distance of a point from the planes of those triangles that it lies over, of all that are more than
/// `least`; infinity if none is less than `most`.
double distance_to_triangles(const MeshSource& mesh, const SceneNormalization& normalization, const glm::dvec3& point,
                             double least, double most);

}  // namespace cistula
