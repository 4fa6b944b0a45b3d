// The triangles of smooth meshes that keep their normals on shared planes (docs/rules.md, 17, line 2). Private to
// libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "scene/compile/solids/placed_bodies.h"

namespace cistula {

struct SmoothFaces {
    std::vector<std::vector<uint32_t>> kept;  // of each solid, ascending
    std::string warning;                      // of those that are made flat; empty: there are none

    bool keeps(uint32_t solid, uint32_t triangle) const;
};

/// Finds which smooth triangles on shared planes keep their normals: those where every body that overlaps them has the
/// same triangle, with normals within 2^-8 of theirs.
SmoothFaces find_smooth_faces(const SceneSource& source, const PlacedBodies& bodies);

}  // namespace cistula
