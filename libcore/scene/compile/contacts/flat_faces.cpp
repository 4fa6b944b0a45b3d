#include "scene/compile/contacts/flat_faces.h"

#include <algorithm>
#include <cmath>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/description/rotation.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The axis along which a box has no size; -1: none.
int level_of(const Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.low[axis] == box.high[axis]) return axis;
    return -1;
}

/// Half the longest side of a box.
double half_longest(const Box& box) {
    return box.empty() ? 0 : largest_component(box.high - box.low) / 2;
}

FlatFace empty_face(const ContactBody& body, bool as_given) {
    FlatFace face{};
    face.body = &body;
    face.solid = body.solid;
    face.as_given = as_given;
    return face;
}

/// Finds the boxes and the middle of a face that has its corners.
void place_corners(FlatFace& face) {
    const std::vector<dvec3>& points = face.points();
    for (const uint32_t corner : face.corners) {
        face.box.add(points[corner]);
        face.in_frame.add(face.body->points[corner]);
        face.middle += points[corner] / double(face.corners.size());
    }
    face.level = level_of(face.box);
}

/// The plane without end that a face stands for.
void place_endless(FlatFace& face) {
    place_corners(face);
    face.normal = normalized(face.body->place->endless->normal);
    face.area = INFINITY;
    face.level = -1;
    for (int axis = 0; axis < 3; ++axis)
        if (magnitude(face.normal[axis]) == 1) face.level = axis;
    face.box = {dvec3(-INFINITY), dvec3(INFINITY)};
}

/// The plane of a mesh's face that has its triangles and corners.
void place_triangles(FlatFace& face) {
    if (face.is_endless()) return place_endless(face);
    dvec3 area(0);
    for (const uint32_t t : face.parts) {
        const auto corner = points_of(face.points(), face.body->facets[t]);
        area += cross(corner[1] - corner[0], corner[2] - corner[0]);
    }
    face.normal = normalized(area);
    face.area = length(area) / 2;
    place_corners(face);
    face.offset = dot(face.normal, face.middle);
}

/// The face that some triangles make, whose numbers are kept for it.
FlatFace face_of(ContactBody& body, std::span<const uint32_t> triangles, bool as_given) {
    FlatFace face = empty_face(body, as_given);
    face.parts = triangles;
    std::vector<uint32_t>& numbers = body.numbers;
    const auto first = ptrdiff_t(numbers.size());
    for (const uint32_t t : triangles)
        for (const uint32_t vertex : body.facets[t]) numbers.push_back(body.welded[vertex]);
    std::sort(numbers.begin() + first, numbers.end());
    numbers.erase(std::unique(numbers.begin() + first, numbers.end()), numbers.end());
    face.corners = {numbers.begin() + first, numbers.end()};
    place_triangles(face);
    return face;
}

FlatFace polyhedron_face(const ContactBody& body, const SolidObject& solid, const Polyhedron::Face& from,
                         bool as_given) {
    FlatFace face = empty_face(body, as_given);
    face.parts = {&from.id, 1};
    face.corners = from.vertices;
    place_corners(face);
    const std::vector<dvec3>& points = face.points();
    dvec3 area(0);
    for (size_t i = 2; i < face.corners.size(); ++i) {
        const dvec3& first = points[face.corners[0]];
        area += cross(points[face.corners[i - 1]] - first, points[face.corners[i]] - first);
    }
    face.area = length(area) / 2;
    const PlanePair& pair = body.planes->planes[from.id / 2];
    const bool high = from.id % 2 == 1;
    if (!as_given && body.moved) {
        face.normal = normalized(area);
        face.offset = dot(face.normal, face.middle);
        return face;
    }
    face.normal = high ? pair.normal : -pair.normal;
    face.offset = high ? pair.high : -pair.low;
    if (as_given) {
        const Polyhedron::Planes& own = polyhedron_of(solid).planes[from.id / 2];
        face.offset = body.place->scaled * (high ? own.high : -own.low);
    }
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
        next_ = link_edges(corners, body.given.size()).next;
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
            faces.push_back(face_of(body_, std::span(numbers).subspan(before), true));
            if (!(farthest_from(faces.back(), faces.back()) > 2 * tolerance_)) continue;
            faces.pop_back();
            numbers.resize(before);
            for (const uint32_t i : members) faces.push_back(face_of_one(i));
        }
        return faces;
    }

  private:
    static constexpr uint32_t most_tried = 16;

    std::array<dvec3, 3> points_of(uint32_t triangle) const {
        return cistula::points_of(body_.given, body_.facets[triangle]);
    }
    FlatFace face_of_one(uint32_t i) { return face_of(body_, {&triangles_[i], 1}, true); }
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

BodyPlace::BodyPlace(const SourceSolid& solid, double factor) {
    if (solid.sphere) return;
    const std::span<const TriangleCorners> triangles = solid.mesh.triangles;
    if (solid.polyhedron) {
        anchor = solid.polyhedron->center * factor;
        scaled = solid.polyhedron->radius * factor;
        span = box_of(vertices(solid, factor));
    } else if (solid.disk) {
        anchor = solid.disk->center * factor;
        if (solid.disk->is_endless()) endless = solid.disk;
    } else if (!triangles.empty()) {
        anchor = solid.mesh.vertices[triangles[0][0]] * factor;
    }
    if (!solid.polyhedron && !endless)
        for (const TriangleCorners& corners : triangles)
            for (const uint32_t corner : corners) span.add(solid.mesh.vertices[corner] * factor - anchor);
    for (int axis = 0; axis < 3; ++axis) {
        largest = max_or_second(magnitude(anchor[axis]), largest);
        if (span.empty()) continue;
        for (const double end : {span.low[axis], span.high[axis]})
            largest = max_or_second(magnitude(anchor[axis] + end), largest);
    }
}

std::vector<dvec3> BodyPlace::vertices(const SourceSolid& solid, double factor) const {
    std::vector<dvec3> all;
    if (solid.polyhedron) {
        const Rotation rotation(solid.polyhedron->rotation);
        for (const dvec3& p : polyhedron_of(*solid.polyhedron).vertices) all.push_back(rotation(scaled * p));
        return all;
    }
    all.reserve(solid.mesh.vertices.size());
    for (const dvec3& p : solid.mesh.vertices) all.push_back(endless ? dvec3(0) : p * factor - anchor);
    return all;
}

double BodyPlace::half_side() const {
    return half_longest(span);
}

ContactRange::ContactRange(const SceneSource& source, double factor) : contact_(source.description->contact) {
    if (contact_) *contact_ *= factor;
}

double ContactRange::tau(const BodyPlace& a, const BodyPlace& b) const {
    if (a.endless && b.endless) return ulps(a, b);
    if (a.endless || b.endless) return share * (a.endless ? b : a).half_side();
    Box both = a.span;
    both.add(moved(b.span, b.anchor - a.anchor));
    return share * half_longest(both);
}

double ContactRange::tolerance(const BodyPlace& a, const BodyPlace& b, double rounding, double most) const {
    const double touching = contact_ ? max_or_second(*contact_, ulps(a, b)) : max_or_second(tau(a, b), rounding);
    return min_or_second(touching, most);
}

double ContactRange::ulps(const BodyPlace& a, const BodyPlace& b) {
    return 16 * 2 * RealTraits<double>::unit * max_or_second(a.largest, b.largest);
}

double rounding_along(const dvec3& normal, const dvec3& half_unit) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += magnitude(normal[axis]) * half_unit[axis];
    return sum;
}

bool touch(const Box& a, const Box& b, double pad) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] > b.high[axis] + pad || b.low[axis] - pad > a.high[axis]) return false;
    return true;
}

Box padded(const Box& box, double pad) {
    return {box.low - dvec3(pad), box.high + dvec3(pad)};
}

Box moved(const Box& box, const dvec3& way) {
    return {box.low + way, box.high + way};
}

NearSolids::NearSolids(std::vector<Box> boxes, std::vector<double> pads)
    : boxes_(std::move(boxes)), pads_(std::move(pads)) {
    std::vector<RTCBuildPrimitive> primitives;
    for (uint32_t i = 0; i < boxes_.size(); ++i)
        if (!boxes_[i].empty()) primitives.push_back(padded_primitive(boxes_[i], pads_[i], i));
    tree_ = build_tree(primitives, 0);
}

std::vector<FlatFace> joined_faces(ContactBody& body) {
    return FaceGrowth(body).grow();
}

std::array<dvec3, 3> points_of(std::span<const dvec3> points, const TriangleCorners& corners) {
    return {points[corners[0]], points[corners[1]], points[corners[2]]};
}

std::vector<FlatFace> single_faces(ContactBody& body) {
    make_room(body);
    std::vector<FlatFace> faces;
    faces.reserve(body.near.size());
    for (const uint32_t& t : body.near)
        if (const FlatFace face = face_of(body, {&t, 1}, false); face.area > 0) faces.push_back(face);
    return faces;
}

std::vector<FlatFace> polyhedron_faces(const ContactBody& body, const SolidObject& solid, bool as_given) {
    std::vector<FlatFace> faces;
    for (const Polyhedron::Face& from : polyhedron_of(solid).faces)
        faces.push_back(polyhedron_face(body, solid, from, as_given));
    return faces;
}

std::vector<FlatFace> endless_faces(ContactBody& body) {
    make_room(body);
    return {face_of(body, body.near, true)};
}

FlatFace seen(const FlatFace& face, bool as_given, const SourceSolid& solid) {
    if (face.as_given == as_given) return face;
    FlatFace there = empty_face(*face.body, as_given);
    there.number = face.number;
    there.parts = face.parts;
    there.corners = face.corners;
    if (!solid.polyhedron) {
        place_triangles(there);
        return there;
    }
    const std::vector<Polyhedron::Face>& faces = polyhedron_of(*solid.polyhedron).faces;
    const auto is_this = [&](const Polyhedron::Face& other) { return other.id == face.parts[0]; };
    return polyhedron_face(*face.body, *solid.polyhedron, *std::find_if(faces.begin(), faces.end(), is_this), as_given);
}

double signed_distance(const FlatFace& plane, const FlatFace& of, const dvec3& point) {
    return dot(plane.normal, point + way_between(plane, of)) - plane.offset;
}

double farthest_from(const FlatFace& plane, const FlatFace& face) {
    const dvec3 way = way_between(plane, face);
    const std::vector<dvec3>& points = face.points();
    double farthest = 0;
    for (const uint32_t corner : face.corners)
        farthest = max_or_second(magnitude(dot(plane.normal, points[corner] + way) - plane.offset), farthest);
    return farthest;
}

bool overlap(const std::array<dvec3, 3>& a, const std::array<dvec3, 3>& b, double least) {
    return !apart(a, b, least) && !apart(b, a, least);
}

}  // namespace cistula
