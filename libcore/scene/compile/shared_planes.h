// Faces of several solids that lie in one plane (docs/rules.md, 11, lines 1 and 2). Private to libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "scene/compile/compile_lights.h"
#include "scene/compile/compile_solids.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// The two solids whose faces coincide first, by number; none where none do.
struct FirstContact {
    uint32_t solids[2] = {0, 0};
    bool found = false;
};

/// The most pairs of faces of different objects, or of one open sheet, that may come near one another. Memory and time
/// grow with them: many objects in one place have as many as the square of their number.
inline constexpr size_t most_near_pairs = 16'000'000;

/// There are more.
struct TooManyPairs {
    uint32_t solid;  // that is near others
};

/// Finds the faces that coincide to within 16 u M and gives them one plane: in `convex`, whose slabs are not yet in the
/// scene, and in the scene's triangle_planes. Fills the scene's shared_planes, near_planes and plane_solids, and
/// changes the numbers of faces in `incidents` that move because a slab is split. `boxes`: of each solid. Throws
/// TooManyPairs for more than most_near_pairs.
template <class Real>
FirstContact share_planes(CompiledScene<Real>& scene, std::vector<ConvexSolid>& convex, const std::vector<Box>& boxes,
                          IncidentLists& incidents);

}  // namespace cistula
