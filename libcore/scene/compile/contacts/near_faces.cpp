#include "scene/compile/contacts/near_faces.h"

#include <algorithm>
#include <cmath>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr size_t few_pairs = 4096;  // of triangles, that are looked at one by one

using Triangle = std::array<dvec3, 3>;

/// A tree of so many boxes.
template <class BoxOf>
Tree tree_of(size_t count, const BoxOf& box) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(count);
    for (uint32_t i = 0; i < count; ++i) primitives.push_back(padded_primitive(box(i), 0, i));
    return build_tree(primitives, 0);
}

/// More than what any two faces that touch, or are told of, are apart.
double reach(const FlatFace& a, const FlatFace& b) {
    return a.body->pad + b.body->pad;
}

/// Whether two unit normals differ by no more than rounding, or by their sign.
bool are_parallel(const dvec3& a, const dvec3& b) {
    return length(dot(a, b) < 0 ? a + b : a - b) <= 8 * RealTraits<double>::unit;
}

/// By how much more than its corners a plane is moved elsewhere where these are off: where p is the sum of weights
/// times corners, as the plane nearest to them has it, by the sum of the weights' sizes.
class Leverage {
  public:
    explicit Leverage(const FlatFace& plane) : plane_(plane) {
        u_ = normalized(perpendicular_to(plane.normal));
        v_ = cross(plane.normal, u_);
        for (const uint32_t corner : plane.corners) {
            const dvec3 out = plane.points()[corner] - plane.middle;
            const double x = dot(u_, out), y = dot(v_, out);
            xx_ += x * x, xy_ += x * y, yy_ += y * y;
        }
    }

    double at(const dvec3& p) const {
        const double determinant = xx_ * yy_ - xy_ * xy_;
        if (!(determinant > 0)) return 1;
        const dvec3 out = p - plane_.middle;
        const double x = (yy_ * dot(u_, out) - xy_ * dot(v_, out)) / determinant;
        const double y = (xx_ * dot(v_, out) - xy_ * dot(u_, out)) / determinant;
        const dvec3 along = x * u_ + y * v_;
        double sum = 0;
        for (const uint32_t corner : plane_.corners)
            sum += magnitude(1.0 / double(plane_.corners.size()) + dot(along, plane_.points()[corner] - plane_.middle));
        return min_or_second(sum, most_leverage);
    }

  private:
    static dvec3 perpendicular_to(const dvec3& n) {
        return magnitude(n.x) < 0.5 ? dvec3(0, -n.z, n.y) : dvec3(-n.y, n.x, 0);
    }

    const FlatFace& plane_;
    dvec3 u_, v_;  // along the plane
    double xx_ = 0, xy_ = 0, yy_ = 0;
};

/// The triangles of a face, moved, that meet a box.
std::vector<Triangle> triangles_of(const FlatFace& face, const dvec3& way, const Box& box) {
    std::vector<Triangle> triangles;
    const auto add = [&](const TriangleCorners& corners) {
        Triangle triangle = points_of(face.points(), corners);
        for (dvec3& p : triangle) p += way;
        if (touch(box_of(triangle), box, 0)) triangles.push_back(triangle);
    };
    if (!face.body->planes)
        for (const uint32_t t : face.parts) add(face.body->facets[t]);
    else
        for (size_t i = 2; i < face.corners.size(); ++i) add({face.corners[0], face.corners[i - 1], face.corners[i]});
    return triangles;
}

/// Whether triangles of two faces that lie near one plane, or of one face, overlap by more than `least` in every
/// direction along it; below 0: are no farther apart.
bool overlap_by(const FlatFace& a, const FlatFace& b, double least) {
    if (a.is_endless() || b.is_endless()) return true;
    const bool one = &a == &b;
    const dvec3 way = way_between(a, b);
    const double pad = 2 * reach(a, b);  // above all distances from the plane in which they may overlap
    const std::vector<Triangle> of_b = triangles_of(b, way, padded(a.box, pad));
    const std::vector<Triangle> of_a = triangles_of(a, dvec3(0), padded(moved(b.box, way), pad));
    if (of_a.size() * of_b.size() <= few_pairs) {
        for (size_t j = 0; j < of_b.size(); ++j)
            for (size_t i = 0; i < (one ? j : of_a.size()); ++i)
                if (overlap(of_a[i], of_b[j], least)) return true;
        return false;
    }
    const bool swap = of_a.size() < of_b.size();
    const std::vector<Triangle>&many = swap ? of_b : of_a, &few = swap ? of_a : of_b;
    const Tree tree = tree_of(many.size(), [&](size_t i) { return padded(box_of(many[i]), pad); });
    for (size_t j = 0; j < few.size(); ++j)
        if (any_in_box(tree, box_of(few[j]),
                       [&](uint32_t i) { return (!one || i < j) && overlap(many[i], few[j], least); }))
            return true;
    return false;
}

}  // namespace

FaceTest::Rounding FaceTest::rounding(const FlatFace& plane, const FlatFace& face) const {
    const CoordinateRounding &a = plane.body->reach.rounding, &b = face.body->reach.rounding;
    if (plane.level >= 0 && plane.level == face.level && a.digits >= 0 && a.digits == b.digits) return {};
    return {rounding_along(plane.normal, a.half_unit), rounding_along(plane.normal, b.half_unit)};
}

double FaceTest::tolerance(const FlatFace& plane, const FlatFace& face, const Rounding& rounding) const {
    return range_.tolerance(*plane.body->place, *face.body->place, rounding.plane + rounding.face,
                            min_or_second(plane.body->reach.most, face.body->reach.most));
}

bool FaceTest::lies_in(const FlatFace& plane, const FlatFace& face, double farthest) const {
    if (exact()) return farthest <= exact_;
    const Rounding written = rounding(plane, face);
    if (farthest <= tolerance(plane, face, written)) return true;
    if (range_.given() || farthest > tolerance(plane, face, {most_leverage * written.plane, written.face}))
        return false;
    const Leverage leverage(plane);
    const dvec3 way = way_between(plane, face);
    return std::all_of(face.corners.begin(), face.corners.end(), [&](uint32_t corner) {
        const dvec3& p = face.points()[corner];
        return magnitude(signed_distance(plane, face, p)) <=
               tolerance(plane, face, {leverage.at(p + way) * written.plane, written.face});
    });
}

double FaceTest::distance(const FlatFace& a, const FlatFace& b) const {
    const bool first = is_larger(a, b);
    const FlatFace &large = first ? a : b, &small = first ? b : a;
    if (large.is_endless() && small.is_endless() && !are_parallel(large.normal, small.normal)) return INFINITY;
    if (magnitude(signed_distance(large, small, small.middle)) > 2 * reach(a, b)) return INFINITY;
    return farthest_from(large, small);
}

bool FaceTest::touching(const FlatFace& a, const FlatFace& b, double distance) const {
    if (distance > 2 * reach(a, b)) return false;
    const bool first = is_larger(a, b);
    const FlatFace &large = first ? a : b, &small = first ? b : a;
    const double most = tolerance(large, small);
    return boxes_touch(a, b, 2 * most) && lies_in(large, small, distance) && (exact() || meeting(a, b, 2 * most));
}

bool boxes_touch(const FlatFace& a, const FlatFace& b, double pad) {
    return touch(a.box, moved(b.box, way_between(a, b)), pad);
}

bool FaceTest::overlapping(const FlatFace& a, const FlatFace& b) {
    return overlap_by(a, b, 0x1p-18 * min_or_second(a.body->place->half_side(), b.body->place->half_side()));
}

bool FaceTest::meeting(const FlatFace& a, const FlatFace& b, double most) {
    return overlap_by(a, b, -most);
}

bool FaceTest::lie_in_one_plane(const std::vector<FlatFace>& faces) const {
    const FlatFace* plane = nullptr;
    for (const FlatFace& face : faces)
        if (!plane || face.area > plane->area) plane = &face;
    for (const FlatFace& face : faces)
        if (farthest_from(*plane, face) > exact_) return false;
    return plane != nullptr;
}

FaceTree::FaceTree(FaceList of) : faces(std::move(of)) {
    constexpr size_t few = 16;
    if (faces.size() > few)
        tree = tree_of(faces.size(), [&](size_t i) { return padded(faces[i].in_frame, faces[i].body->pad); });
}

}  // namespace cistula
