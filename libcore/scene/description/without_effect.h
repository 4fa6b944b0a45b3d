// A scene that no longer calls for one of its effects: what that effect costs is the difference in time.
#pragma once

#include <optional>

#include "cistula/model/effects.h"
#include "scene/description/description.h"

namespace cistula {

/// The scene with `effect`, one bit, taken out of its materials, lights or objects and as little else as that allows
/// (docs/effects.md); lamps that a scene places on a face by hand stay. Nothing for shadows, which no description
/// leaves out (FrameSettings::unshadowed), and where nothing would be left to render.
std::optional<SceneDescription> without_effect(const SceneDescription& scene, uint32_t effect);

}  // namespace cistula
