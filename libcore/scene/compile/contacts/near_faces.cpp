#include "scene/compile/contacts/near_faces.h"

#include <cmath>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr size_t few_pairs = 4096;  // of triangles, that are looked at one by one

/// A tree of so many boxes, each grown by `pad`.
template <class BoxOf>
Tree tree_of(size_t count, double pad, const BoxOf& box) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(count);
    for (uint32_t i = 0; i < count; ++i) primitives.push_back(padded_primitive(box(i), pad, i));
    return build_tree(primitives, 0);
}

}  // namespace

double FaceTest::tolerance(const FlatFace& plane, const FlatFace& face) const {
    if (exact()) return exact_;
    const ContactReach &a = plane.body->reach, &b = face.body->reach;
    const bool alike = plane.level >= 0 && plane.level == face.level && a.rounding.digits == b.rounding.digits;
    const double rounding =
        alike ? 0
              : rounding_along(plane.normal, a.rounding.half_unit) + rounding_along(plane.normal, b.rounding.half_unit);
    return range_.tolerance(rounding, min_or_second(a.most, b.most));
}

double FaceTest::distance(const FlatFace& a, const FlatFace& b) const {
    const bool first = is_larger(a, b);
    const FlatFace &large = first ? a : b, &small = first ? b : a;
    if (magnitude(dot(large.normal, small.middle) - large.offset) > 2 * range_.near) return INFINITY;
    return farthest_from(large.normal, large.offset, small);
}

bool FaceTest::touching(const FlatFace& a, const FlatFace& b, double distance) const {
    if (distance > 2 * range_.near) return false;
    const bool first = is_larger(a, b);
    const double most = tolerance(first ? a : b, first ? b : a);
    return distance <= most && touch(a.box, b.box, most);
}

bool FaceTest::overlapping(const FlatFace& a, const FlatFace& b) const {
    if (a.parts.size() < b.parts.size()) return overlapping(b, a);
    const double pad = 4 * range_.near;  // above all distances from the plane in which they may overlap
    const auto overlap_at = [&](size_t i, const std::array<dvec3, 3>& triangle) {
        return overlap(points_of(*a.body, a.parts[i]), triangle, least_);
    };
    if (a.parts.size() * b.parts.size() <= few_pairs) {
        for (size_t j = 0; j < b.parts.size(); ++j) {
            const auto triangle = points_of(*b.body, b.parts[j]);
            for (size_t i = 0; i < a.parts.size(); ++i)
                if ((&a != &b || i < j) && overlap_at(i, triangle)) return true;
        }
        return false;
    }
    const Tree tree = tree_of(a.parts.size(), pad, [&](size_t i) { return box_of(points_of(*a.body, a.parts[i])); });
    for (size_t j = 0; j < b.parts.size(); ++j) {
        const auto triangle = points_of(*b.body, b.parts[j]);
        if (any_in_box(tree, padded(box_of(triangle), pad),
                       [&](uint32_t i) { return (&a != &b || i < j) && overlap_at(i, triangle); }))
            return true;
    }
    return false;
}

bool FaceTest::lie_in_one_plane(const std::vector<FlatFace>& faces) const {
    const FlatFace* plane = nullptr;
    for (const FlatFace& face : faces)
        if (!plane || face.area > plane->area) plane = &face;
    for (const FlatFace& face : faces)
        if (farthest_from(plane->normal, plane->offset, face) > exact_) return false;
    return plane != nullptr;
}

FaceTree::FaceTree(FaceList of, double grown) : faces(std::move(of)), pad(grown) {
    constexpr size_t few = 16;
    if (faces.size() > few) tree = tree_of(faces.size(), pad, [&](size_t i) { return faces[i].box; });
}

}  // namespace cistula
