// Lists of layers by name, as --layers takes them: path,Z,N.
#pragma once

#include <string_view>

#include "render/record/film_layers.h"
#include "render/record/film_picture.h"

namespace cistula {

/// The channels with the layers of a list of layers and groups of layers (docs/programs/layers.md), and no others.
/// Throws Error (usage) with the nearest name for an unknown one, but for light layers, which depend on the scene.
OutputChannels parse_layers(std::string_view text, OutputChannels channels = {});

/// Throws Error (usage) for a light layer that the scene does not have, with those that it has.
void require_light_layers(const OutputChannels& channels, const LayerNames& names);

}  // namespace cistula
