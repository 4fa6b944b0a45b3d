// Layers by name: those that --layer names, and the table of --list.
#pragma once

#include <string>
#include <vector>

#include "layers.h"

namespace cistula {

/// The layers that these texts name, each once: a name, or several with commas between; without texts the default
/// layer. A channel's name is a layer of that channel, the name of a Cryptomatte all its ranks. Throws Error (usage)
/// for an unknown one, with all names, those most like it first. `file` is for messages.
std::vector<Layer> chosen_layers(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers,
                                 const std::vector<std::string>& texts, const std::string& file);

/// A line for each layer: name, how it is shown, size, channels.
std::string layer_table(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers);

}  // namespace cistula
