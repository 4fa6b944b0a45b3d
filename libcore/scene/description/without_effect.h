// A scene without one of its effects, to measure what that effect costs in time.
#pragma once

#include <optional>

#include "cistula/model/effects.h"
#include "scene/description/description.h"

namespace cistula {

/// The scene with `effect` (one bit) removed from its materials, lights or objects, and otherwise as little changed as
/// possible (docs/effects.md). Lights placed on a face explicitly stay. Nothing for shadows, which no description can
/// leave out, and where nothing would be left to render.
std::optional<SceneDescription> without_effect(const SceneDescription& scene, uint32_t effect);

}  // namespace cistula
