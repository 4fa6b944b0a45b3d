// Scenes by number, for tests of parity: small ones that between them hold all that a description can.
#pragma once

#include <cstdint>
#include <string>

#include "scene/description/description.h"
#include "scene/film/renderer.h"

namespace cistula {

/// How many there are: every feature, and every mask of effects.h, is met often among seeds 0 to 199.
inline constexpr uint64_t generated_scene_count = 200;

/// The scene of a seed, equal on every machine. `files` is the folder of the repository's scenes: some scenes then take
/// a picture from there in the place of a checker, or a mesh in that of a torus; without it no file is read.
SceneDescription generated_scene(uint64_t seed, const std::string& files = "");

/// The whole frame that the scene asks for: size, samples, depth and cutoff.
FrameSettings generated_settings(const SceneDescription& scene);

}  // namespace cistula
