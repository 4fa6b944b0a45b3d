// Transparent bodies that are in one another, of which the later in the file fills the common space (docs/rules.md, 4).
#pragma once

#include <vector>

#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Two solids, the earlier in the file first.
struct Overlap {
    uint32_t first, second;
};

/// The pairs of a scene's transparent bodies that overlap on one of 192 lines through the box that is common to theirs:
/// 64 along each axis. Bodies that only touch do not. Of very many pairs the first are looked at.
template <class Real>
std::vector<Overlap> find_overlaps(const CompiledScene<Real>& scene);

}  // namespace cistula
