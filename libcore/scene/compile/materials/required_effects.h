// The effects that a scene requires, with reasons.
#pragma once

#include <string>
#include <vector>

#include "cistula/model/effects.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_source.h"
#include "scene/description/description.h"

namespace cistula {

/// A material in use: the object that uses it and the kind of that object.
struct MaterialUse {
    const MaterialDescription* material = nullptr;
    std::string place;                      // "/objects/2"
    bool closed = true;                     // it has an inside
    uint32_t primitive = effect_triangles;  // the effect of what it is made of
    bool smooth = false;                    // triangles with normals of their own
};

/// The reasons for all effects, in bit order. `uses` in file order; the lights considered give light or are visible.
/// `light_on_face`: which light lies on which face ("the light /lights/0 lies on a face of /objects/2"); empty: none.
/// `contact`: which objects have faces in one plane; empty: none.
std::vector<EffectReason> explain_effects(const SceneDescription& scene, const std::vector<MaterialUse>& uses,
                                          const std::string& light_on_face, const std::string& contact);

/// The reasons for all effects of a scene, compiled in that precision: it decides what touches. Throws Error as
/// compile_scene does.
std::vector<EffectReason> explain_effects(SceneSource source, Precision precision);
std::vector<EffectReason> explain_effects(const SceneDescription& scene, Precision precision = Precision::single_);

/// The names of the effects in a mask, in bit order.
std::vector<std::string> names_of_effects(uint32_t mask);

uint32_t required_effects(const std::vector<EffectReason>& reasons);
uint32_t required_effects(const SceneDescription& scene);

}  // namespace cistula
