// The least size that a scene's precision must tell apart (docs/rules.md, 12), and the precision that it needs.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "scene/compile/scene_source.h"
#include "scene/description/description.h"

namespace cistula {

/// The part of a scene that is smallest beside the scene's extent M.
struct SmallestPart {
    double share = std::numeric_limits<double>::infinity();  // its size as a share of M; infinity: there is none
    std::string what;                                        // "/objects/1: pebble: its inradius"
};

/// The least share of M of which a precision keeps its promises: 2^11 u, so 2^-13 in float and 2^-42 in double.
constexpr double least_share(Precision precision) {
    return precision == Precision::single_ ? 0x1p-13 : 0x1p-42;
}

/// The smallest of: inradii of convex solids and radii of spheres; thicknesses of meshes (a closed one's volume over
/// its area, half the width of others: half the area over the diagonal of the box); in meshes that mirror or transmit
/// heights of triangles, but those too low for double, and half the thinnest wall, where nothing else takes double;
/// distances of lights from faces, but those up to 16 u M in float, where they lie on them; radii of visible lights;
/// gaps that float would close, between solids and between balls. Not other gaps, nor the camera. Of a scene that
/// changes: the smallest at the frames of its keys and, if float holds these, at those between in which something is
/// smaller or comes near something, whichever is shown.
SmallestPart smallest_part(const SceneSource& source);

/// The smallest part of a scene. Opens its meshes. Throws Error as compile_scene does.
SmallestPart smallest_part(const SceneDescription& description);

/// A precision and what is to be said about it; empty texts: nothing.
struct PrecisionChoice {
    Precision precision = Precision::single_;
    std::string note;     // why `auto` is double
    std::string warning;  // why the precision does not hold
};

/// The wanted precision; without one, float unless the scene's smallest part is too small for it.
PrecisionChoice choose_precision(const std::optional<Precision>& wanted, const SmallestPart& part);

}  // namespace cistula
