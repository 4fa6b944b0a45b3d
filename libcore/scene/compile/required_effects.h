// Which effects a scene calls for, and because of what.
#pragma once

#include <string>
#include <vector>

#include "cistula/model/effects.h"
#include "scene/compile/effect_reason.h"
#include "scene/description/description.h"

namespace cistula {

/// A material as it is used: by which object, and of what kind that is.
struct MaterialUse {
    const MaterialDescription* material = nullptr;
    std::string place;    // "/objects/2"
    bool closed = true;   // it has an inside
    bool convex = false;  // a solid of planes; else triangles
};

/// One entry per effect, in the order of the bits. `uses` in file order; lights are those that light or are seen.
/// `lamp_on_face`: which lamp lies on a face, and where ("the light /lights/0 lies on a face of /objects/2"); empty:
/// none.
std::vector<EffectReason> explain_effects(const SceneDescription& scene, const std::vector<MaterialUse>& uses,
                                          const std::string& lamp_on_face);

/// Opens the meshes that the scene names, but no textures. What lies on a face does so in single precision. Throws
/// Error as compile_scene does.
std::vector<EffectReason> explain_effects(const SceneDescription& scene);

/// The names of the effects in a mask, in the order of the bits.
std::vector<std::string> names_of_effects(uint32_t mask);

uint32_t required_effects(const std::vector<EffectReason>& reasons);
uint32_t required_effects(const SceneDescription& scene);

}  // namespace cistula
