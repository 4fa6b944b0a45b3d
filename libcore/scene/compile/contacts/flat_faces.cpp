#include "scene/compile/contacts/flat_faces.h"

#include <algorithm>
#include <cmath>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The axis along which a box has no size; -1: none.
int level_of(const Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.low[axis] == box.high[axis]) return axis;
    return -1;
}

/// The face that some triangles make.
FlatFace face_of(const ContactBody& body, std::vector<uint32_t> triangles) {
    FlatFace face{};
    face.solid = body.solid;
    dvec3 area(0);
    for (const uint32_t t : triangles) {
        const auto corner = points_of(body, t);
        area += cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (const uint32_t vertex : body.facets[t]) face.corners.push_back(body.welded[vertex]);
    }
    std::sort(face.corners.begin(), face.corners.end());
    face.corners.erase(std::unique(face.corners.begin(), face.corners.end()), face.corners.end());
    face.parts = std::move(triangles);
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

/// An edge of a triangle, by its welded vertices.
struct FaceEdge {
    uint32_t low, high, triangle;  // the triangle's place in the list

    bool same_as(const FaceEdge& other) const { return low == other.low && high == other.high; }
};

/// Joins triangles to flat faces. Of the triangles along one edge, which may be all of a mesh, it looks at the next
/// few.
class FaceGrowth {
  public:
    FaceGrowth(const ContactBody& body, const std::vector<uint32_t>& triangles, double tolerance)
        : body_(body), triangles_(triangles), tolerance_(tolerance) {
        for (const uint32_t t : triangles) {
            const auto corner = points_of(t);
            areas_.push_back(cross(corner[1] - corner[0], corner[2] - corner[0]));
        }
        link();
    }

    void grow(std::vector<FlatFace>& faces) {
        std::vector<uint32_t> order(triangles_.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return dot(areas_[a], areas_[a]) > dot(areas_[b], areas_[b]); });
        joined_.assign(triangles_.size(), false);
        for (const uint32_t first : order) {
            if (joined_[first] || !(dot(areas_[first], areas_[first]) > 0)) continue;
            const std::vector<uint32_t> members = flat_neighbors(first);
            FlatFace face = face_of(body_, numbers(members));
            if (members.size() > 1 && farthest_from(face.normal, face.offset, body_, face) > 2 * tolerance_)
                for (const uint32_t one : members) faces.push_back(face_of(body_, {triangles_[one]}));
            else
                faces.push_back(std::move(face));
        }
    }

  private:
    static constexpr uint32_t most_tried = 16;

    std::array<dvec3, 3> points_of(uint32_t triangle) const { return cistula::points_of(body_, triangle); }

    std::vector<uint32_t> numbers(const std::vector<uint32_t>& members) const {
        std::vector<uint32_t> numbers;
        for (const uint32_t i : members) numbers.push_back(triangles_[i]);
        std::sort(numbers.begin(), numbers.end());
        return numbers;
    }

    void link() {
        for (uint32_t i = 0; i < triangles_.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const auto& c = body_.facets[triangles_[i]];
                const uint32_t a = body_.welded[c[size_t(k)]];
                const uint32_t b = body_.welded[c[size_t((k + 1) % 3)]];
                edges_.push_back({std::min(a, b), std::max(a, b), i});
            }
        std::vector<uint32_t> order(edges_.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            const FaceEdge &x = edges_[a], &y = edges_[b];
            return x.low != y.low ? x.low < y.low : x.high != y.high ? x.high < y.high : a < b;
        });
        next_.resize(edges_.size());
        for (size_t first = 0; first < order.size();) {
            size_t end = first + 1;
            while (end < order.size() && edges_[order[end]].same_as(edges_[order[first]])) ++end;
            for (size_t i = first; i < end; ++i) next_[order[i]] = order[i + 1 == end ? first : i + 1];
            first = end;
        }
    }

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
                    const uint32_t i = edges_[other].triangle;
                    ++tried;
                    if (joined_[i] || !lies_in_plane(i)) continue;
                    joined_[i] = true;
                    members.push_back(i);
                }
        return members;
    }

    const ContactBody& body_;
    const std::vector<uint32_t>& triangles_;
    const double tolerance_;
    std::vector<dvec3> areas_;     // twice the area vectors
    std::vector<FaceEdge> edges_;  // 3 triangle + corner
    std::vector<uint32_t> next_;   // along the same edge, in a ring
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

void add_mesh_faces(const ContactBody& body, const std::vector<uint32_t>& triangles, double tolerance,
                    std::vector<FlatFace>& faces) {
    FaceGrowth(body, triangles, tolerance).grow(faces);
}

std::array<dvec3, 3> points_of(const ContactBody& body, uint32_t facet) {
    const TriangleCorners& c = body.facets[facet];
    return {body.points[c[0]], body.points[c[1]], body.points[c[2]]};
}

void add_triangles(const ContactBody& body, const std::vector<uint32_t>& triangles, std::vector<FlatFace>& faces) {
    for (const uint32_t t : triangles)
        if (FlatFace face = face_of(body, {t}); face.area > 0) faces.push_back(std::move(face));
}

void add_polyhedron_faces(const ContactBody& body, const SolidObject& solid, std::vector<FlatFace>& faces) {
    for (const Polyhedron::Face& from : polyhedron_of(solid).faces) {
        FlatFace face{};
        face.solid = body.solid;
        face.parts = {from.id};
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
        faces.push_back(std::move(face));
    }
}

double farthest_from(const dvec3& normal, double offset, const ContactBody& body, const FlatFace& face) {
    double farthest = 0;
    for (const uint32_t corner : face.corners)
        farthest = max_or_second(magnitude(dot(normal, body.points[corner]) - offset), farthest);
    return farthest;
}

bool overlap(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double least) {
    return !apart(a, b, least) && !apart(b, a, least);
}

}  // namespace cistula
