// The radiance bound B (docs/rules.md, 7): no ray of a scene carries more. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/lights/light_distance.h"
#include "scene/compile/materials/compile_materials.h"

namespace cistula {

/// Factor on B for the rounding of shading.
inline constexpr double bound_slack = 1 + 0x1p-10;

/// How much brighter than what the scene's lights give to surfaces a bound may be. With 64 samples along a pixel's side
/// a unit of the sums is then 2^-18 of that, so that the units of 64 contributions make a step of 12 bits.
inline constexpr double largest_contrast = 0x1p32;

/// Where the solids are.
struct SolidPlaces {
    std::vector<Box> boxes;                             // in the frame
    std::vector<std::vector<LightDistance>> distances;  // of lights, in their order
    std::vector<double> bulges;                         // the farthest that points of a solid are lit off its faces
};

/// The bound per channel, without slack, in scene units. Spheres that are too bright for the sums only because their
/// glow is their color are brought down to what they hold, with a warning. Throws Error for what else the sums cannot
/// hold beside the rest of the scene.
glm::dvec3 radiance_bound(const SceneSource& source, const TextureSet& textures, const SolidPlaces& solids,
                          double unit_length, std::vector<NormalizedLight>& lights, std::vector<std::string>& warnings);

struct RadianceScale {
    glm::dvec3 bound{0};  // slack included, at most 1 after scaling
    int exponent = 0;     // radiances are divided by 2^exponent
};
/// The power of two that scales the largest channel of the bound to (1/2, 1]. A bound given in the scene replaces the
/// computed one and must not be less. Throws Error for bounds that the precision cannot scale.
RadianceScale radiance_scale(const SceneDescription& scene, const glm::dvec3& bound, bool single_precision);

}  // namespace cistula
