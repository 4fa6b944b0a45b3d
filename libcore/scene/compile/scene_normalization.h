// The frame of reference (docs/rules.md, 1): centered, and scaled by a power of two so that coordinates stay under 2.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "base/box.h"
#include "scene/description/description.h"

namespace cistula {

struct SceneSource;
struct SourceSolid;

struct SceneNormalization {
    glm::dvec3 center{0};
    int scale = 0;
    double factor = 1;  // 2^scale
    double extent = 1;  // M: largest absolute coordinate

    glm::dvec3 point(const glm::dvec3& world) const { return (world - center) * factor; }
};

/// A box around a solid and its visible edge lights, in scene units; of a plane without end empty.
Box world_box(const SourceSolid& solid);
/// A box around a scene's solids and visible lights.
Box world_box(const SceneSource& source);

/// The frame of a scene, for all frames of a film. M lies in [1, 2), unless the description gives the frame; then M
/// follows from it, and 2 or more is an error.
SceneNormalization find_normalization(const SceneSource& source);

/// A solid's corners in scene units.
std::vector<glm::dvec3> world_vertices(const SolidObject& solid);

}  // namespace cistula
