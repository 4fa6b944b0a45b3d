// The vertices of a body that are moved into the planes of its contacts (docs/rules.md, 11, lines A7 to A9). Private to
// libcore/scene.
#pragma once

#include <span>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/flat_faces.h"

namespace cistula {

/// The most that a vertex is moved, in the largest tolerance of its faces.
inline constexpr double most_moved = 4;

/// The point nearest to `point` on up to three planes; none if they are too nearly parallel to fix one.
std::optional<glm::dvec3> nearest_on(std::span<const PlaneEquation> planes, const glm::dvec3& point);

/// A face of a body and the plane that it is to lie in.
struct BoundFace {
    const FlatFace* face;
    uint32_t plane;
    double tolerance;  // with the largest face there; of that the largest with the others
};

/// Moves a body's vertices into the planes of its faces, each from its place to the nearest point of all its planes,
/// those of the largest faces first. Faces that cannot follow are taken out of `faces` and returned: a vertex would lie
/// in a fourth plane or too nearly parallel ones, would move by more than four tolerances, or a triangle would turn.
/// `rounding`: what lies as near to a plane lies in it.
std::vector<BoundFace> move_into_planes(ContactBody& body, std::vector<BoundFace>& faces,
                                        std::span<const PlaneEquation> planes, std::span<const double> plane_areas,
                                        double rounding);

}  // namespace cistula
