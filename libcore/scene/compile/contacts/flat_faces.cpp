#include "scene/compile/contacts/flat_faces.h"

#include <algorithm>
#include <cmath>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_edges.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The axis along which a box has no size; -1: none.
int level_of(const Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.low[axis] == box.high[axis]) return axis;
    return -1;
}

/// The face that some triangles make, whose numbers are kept for it.
FlatFace face_of(ContactBody& body, std::span<const uint32_t> triangles) {
    FlatFace face{};
    face.body = &body;
    face.solid = body.solid;
    face.parts = triangles;
    std::vector<uint32_t>& numbers = body.numbers;
    const auto first = ptrdiff_t(numbers.size());
    dvec3 area(0);
    for (const uint32_t t : triangles) {
        const auto corner = points_of(body, t);
        area += cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (const uint32_t vertex : body.facets[t]) numbers.push_back(body.welded[vertex]);
    }
    std::sort(numbers.begin() + first, numbers.end());
    numbers.erase(std::unique(numbers.begin() + first, numbers.end()), numbers.end());
    face.corners = {numbers.begin() + first, numbers.end()};
    face.normal = normalized(area);
    face.area = length(area) / 2;
    for (const uint32_t corner : face.corners) {
        face.box.add(body.points[corner]);
        face.middle += body.points[corner] / double(face.corners.size());
    }
    face.offset = dot(face.normal, face.middle);
    face.level = level_of(face.box);
    return face;
}

/// Room for the triangles and corners of all faces, which their lists stay in.
void make_room(ContactBody& body) {
    body.numbers.clear();
    body.numbers.reserve(4 * body.near.size());
}

/// Joins triangles to flat faces. Of the triangles along one edge, which may be all of a mesh, it looks at the next
/// few.
class FaceGrowth {
  public:
    explicit FaceGrowth(ContactBody& body) : body_(body), triangles_(body.near), tolerance_(body.reach.own) {
        std::vector<TriangleCorners> corners;
        for (const uint32_t t : triangles_) {
            const auto corner = points_of(t);
            areas_.push_back(cross(corner[1] - corner[0], corner[2] - corner[0]));
            corners.push_back({welded(t, 0), welded(t, 1), welded(t, 2)});
        }
        next_ = link_edges(corners, body.points.size()).next;
    }

    std::vector<FlatFace> grow() {
        struct Size {
            double area;
            uint32_t triangle;
        };
        std::vector<Size> order;
        for (uint32_t i = 0; i < triangles_.size(); ++i) order.push_back({dot(areas_[i], areas_[i]), i});
        std::stable_sort(order.begin(), order.end(), [](const Size& a, const Size& b) { return a.area > b.area; });
        joined_.assign(triangles_.size(), false);
        make_room(body_);
        std::vector<uint32_t>& numbers = body_.numbers;
        std::vector<FlatFace> faces;
        for (const auto& [area, first] : order) {
            if (joined_[first] || !(area > 0)) continue;
            const std::vector<uint32_t> members = flat_neighbors(first);
            if (members.size() == 1) {
                faces.push_back(face_of_one(first));
                continue;
            }
            const size_t before = numbers.size();
            for (const uint32_t i : members) numbers.push_back(triangles_[i]);
            std::sort(numbers.begin() + ptrdiff_t(before), numbers.end());
            faces.push_back(face_of(body_, std::span(numbers).subspan(before)));
            if (!(farthest_from(faces.back().normal, faces.back().offset, faces.back()) > 2 * tolerance_)) continue;
            faces.pop_back();
            numbers.resize(before);
            for (const uint32_t i : members) faces.push_back(face_of_one(i));
        }
        return faces;
    }

  private:
    static constexpr uint32_t most_tried = 16;

    std::array<dvec3, 3> points_of(uint32_t triangle) const { return cistula::points_of(body_, triangle); }
    FlatFace face_of_one(uint32_t i) { return face_of(body_, {&triangles_[i], 1}); }
    uint32_t welded(uint32_t triangle, size_t corner) const { return body_.welded[body_.facets[triangle][corner]]; }

    /// A triangle and all that lie in its plane and hang together with it.
    std::vector<uint32_t> flat_neighbors(uint32_t first) {
        const dvec3 normal = normalized(areas_[first]);
        const auto corner = points_of(triangles_[first]);
        const double offset = dot(normal, (corner[0] + corner[1] + corner[2]) / 3.0);
        const auto lies_in_plane = [&](uint32_t i) {
            for (const dvec3& p : points_of(triangles_[i]))
                if (!(magnitude(dot(normal, p) - offset) <= 2 * tolerance_)) return false;
            return dot(areas_[i], normal) >= 0;
        };
        std::vector<uint32_t> members{first};
        joined_[first] = true;
        for (size_t m = 0; m < members.size(); ++m)
            for (uint32_t e = 3 * members[m]; e < 3 * members[m] + 3; ++e)
                for (uint32_t other = next_[e], tried = 0; other != e && tried < most_tried; other = next_[other]) {
                    const uint32_t i = other / 3;
                    ++tried;
                    if (joined_[i] || !lies_in_plane(i)) continue;
                    joined_[i] = true;
                    members.push_back(i);
                }
        return members;
    }

    ContactBody& body_;
    const std::vector<uint32_t>& triangles_;
    const double tolerance_;
    std::vector<dvec3> areas_;    // twice the area vectors
    std::vector<uint32_t> next_;  // half-edges along the same edge, in a ring
    std::vector<bool> joined_;
};

/// Whether the triangles are apart along an in-plane normal of one of a's edges.
bool apart(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double least) {
    const dvec3 normal = cross(a[1] - a[0], a[2] - a[0]);
    for (size_t i = 0; i < 3; ++i) {
        dvec3 out = cross(a[(i + 1) % 3] - a[i], normal);
        const double size = length(out);
        if (!(size > 0)) continue;
        out /= size;
        double nearest = INFINITY;
        for (const dvec3& p : b) nearest = min_or_second(dot(out, p - a[i]), nearest);
        if (nearest > -least || dot(out, a[(i + 2) % 3] - a[i]) > -least) return true;
    }
    return false;
}

}  // namespace

ContactRange::ContactRange(const SceneSource& source, const SceneNormalization& normalization) {
    const double tau = 0x1p-20 * normalization.extent;
    touching = tau;
    const std::optional<double>& contact = source.description->contact;
    given = contact.has_value();
    if (given) {
        const dvec3& center = normalization.center;
        const double largest = largest_component(dvec3{magnitude(center.x), magnitude(center.y), magnitude(center.z)}) *
                                   normalization.factor +
                               normalization.extent;
        touching = max_or_second(*contact * normalization.factor, 16 * 2 * RealTraits<double>::unit * largest);
    }
    near = max_or_second(16 * tau, touching);
}

double rounding_along(const dvec3& normal, const dvec3& half_unit) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += magnitude(normal[axis]) * half_unit[axis];
    return sum;
}

bool touch(const Box& a, const Box& b, double pad) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] - pad > b.high[axis] + pad || b.low[axis] - pad > a.high[axis] + pad) return false;
    return true;
}

Box padded(const Box& box, double pad) {
    return {box.low - dvec3(pad), box.high + dvec3(pad)};
}

NearSolids::NearSolids(std::vector<Box> boxes, double pad) : boxes_(std::move(boxes)), pad_(pad) {
    std::vector<RTCBuildPrimitive> primitives;
    for (uint32_t i = 0; i < boxes_.size(); ++i)
        if (!boxes_[i].empty()) primitives.push_back(padded_primitive(boxes_[i], pad_, i));
    tree_ = build_tree(primitives, 0);
}

bool NearSolids::meets_another(const Box& box, uint32_t solid) const {
    return !box.empty() && any_in_box(tree_, padded(box, pad_), [&](uint32_t other) {
        return other != solid && touch(box, boxes_[other], pad_);
    });
}

std::vector<FlatFace> joined_faces(ContactBody& body) {
    return FaceGrowth(body).grow();
}

std::array<dvec3, 3> points_of(const ContactBody& body, uint32_t facet) {
    const TriangleCorners& c = body.facets[facet];
    return {body.points[c[0]], body.points[c[1]], body.points[c[2]]};
}

std::vector<FlatFace> single_faces(ContactBody& body) {
    make_room(body);
    std::vector<FlatFace> faces;
    faces.reserve(body.near.size());
    for (const uint32_t& t : body.near)
        if (const FlatFace face = face_of(body, {&t, 1}); face.area > 0) faces.push_back(face);
    return faces;
}

std::vector<FlatFace> polyhedron_faces(const ContactBody& body, const SolidObject& solid) {
    std::vector<FlatFace> faces;
    for (const Polyhedron::Face& from : polyhedron_of(solid).faces) {
        FlatFace face{};
        face.body = &body;
        face.solid = body.solid;
        face.parts = {&from.id, 1};
        face.corners = from.vertices;
        dvec3 area(0);
        for (size_t i = 0; i < face.corners.size(); ++i) {
            const dvec3 &first = body.points[face.corners[0]], &p = body.points[face.corners[i]];
            face.box.add(p);
            face.middle += p / double(face.corners.size());
            if (i >= 2) area += cross(body.points[face.corners[i - 1]] - first, p - first);
        }
        face.area = length(area) / 2;
        face.level = level_of(face.box);
        const PlanePair& pair = body.planes->planes[from.id / 2];
        const bool high = from.id % 2 == 1;
        face.normal = body.moved ? normalized(area) : high ? pair.normal : -pair.normal;
        face.offset = body.moved ? dot(face.normal, face.middle) : high ? pair.high : -pair.low;
        faces.push_back(face);
    }
    return faces;
}

double farthest_from(const dvec3& normal, double offset, const FlatFace& face) {
    double farthest = 0;
    for (const uint32_t corner : face.corners)
        farthest = max_or_second(magnitude(dot(normal, face.body->points[corner]) - offset), farthest);
    return farthest;
}

bool overlap(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double least) {
    return !apart(a, b, least) && !apart(b, a, least);
}

}  // namespace cistula
