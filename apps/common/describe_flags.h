// Descriptions of a film's flags in words.
#pragma once

#include <cstdint>
#include <string>

#include "scene/description/description.h"

namespace cistula {

/// The reason why a film of a scene with these flags (RenderFlag bits) is unreliable, for a message; empty for 0.
std::string describe_flags(uint32_t flags, const SceneDescription& scene);

}  // namespace cistula
