// The tree over visible lights, made from a binary tree.
#pragma once

#include "scene/trees/tree_build.h"

namespace cistula {

/// The light tree with the nodes of `binary` collapsed; item i of `binary` is light i.
std::vector<LightNode> light_tree(const Tree& binary);

}  // namespace cistula
