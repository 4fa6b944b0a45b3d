// The radiance bound B (docs/rules.md, 7): no ray of a scene carries more. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/compile_lights.h"
#include "scene/compile/compile_materials.h"

namespace cistula {

/// Factor on B for the rounding of shading.
inline constexpr double bound_slack = 1 + 0x1p-10;

/// The bound per channel, without slack, in scene units. `boxes` are the solids' boxes in the frame.
glm::dvec3 radiance_bound(const SceneSource& source, const TextureSet& textures,
                          const std::vector<NormalizedLight>& lights, const std::vector<Box>& boxes);

struct RadianceScale {
    glm::dvec3 bound{0};  // slack included, at most 1 after scaling
    int exponent = 0;     // radiances are divided by 2^exponent
};
/// The power of two that scales the largest channel of the bound to (1/2, 1]. A bound given in the scene replaces the
/// computed one and must not be less. Throws Error for bounds that the precision cannot scale.
RadianceScale radiance_scale(const SceneDescription& scene, const glm::dvec3& bound, bool single_precision);

}  // namespace cistula
