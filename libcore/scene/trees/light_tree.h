// The tree over seen lights, from a binary one.
#pragma once

#include "scene/trees/tree_build.h"

namespace cistula {

/// Item i of `binary` is light i.
std::vector<LightNode> light_tree(const Tree& binary);

}  // namespace cistula
