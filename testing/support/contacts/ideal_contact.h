// Scenes of flat bodies that touch, turned and moved at random, and what is true about every ray in them: computed from
// the ideal bodies, not from what the tracer knows.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "testing/support/scene.h"

namespace cistula::test {

/// An orthonormal basis: the columns of a rotation.
struct Basis {
    dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    dvec3 operator()(const dvec3& p) const { return x * p.x + y * p.y + z * p.z; }
    /// The basis turned about its own z by an angle.
    Basis turned(double radians) const {
        const double s = std::sin(radians), c = std::cos(radians);
        return {x * c + y * s, y * c - x * s, z};
    }
    /// The angles in degrees of class Rotation.
    dvec3 degrees() const {
        constexpr double degree = 180 / 3.14159265358979323846;
        const double b = std::asin(max_or_second(min_or_second(-x.z, 1.0), -1.0));
        return {std::atan2(y.z, z.z) * degree, b * degree, std::atan2(x.y, x.x) * degree};
    }
    static Basis random(Random& random) {
        const dvec3 x = random.direction(), y = normalized(cross(random.direction(), x));
        return {x, y, cross(x, y)};
    }
};

/// A convex part of an ideal body: the points with normal.p <= offset for all planes.
struct IdealPart {
    std::vector<dvec3> normals;
    std::vector<double> offsets;

    /// How deep a point lies inside; negative outside.
    double depth(const dvec3& p) const {
        double least = 1e300;
        for (size_t i = 0; i < normals.size(); ++i) least = min_or_second(least, offsets[i] - dot(normals[i], p));
        return least;
    }
    /// The shares of a segment between which it lies inside the part grown by a length. False if it passes by.
    bool chord(const dvec3& from, const dvec3& to, double grown, double& enter, double& leave) const {
        enter = 0, leave = 1;
        for (size_t i = 0; i < normals.size(); ++i) {
            const double a = dot(normals[i], from) - offsets[i] - grown, b = dot(normals[i], to) - offsets[i] - grown;
            if (a > 0 && b > 0) return false;
            if (a > 0) enter = max_or_second(enter, a / (a - b));
            if (b > 0) leave = min_or_second(leave, a / (a - b));
        }
        return enter < leave;
    }
    /// An axis-parallel box in a turned frame with its origin at `middle`.
    static IdealPart box(const Basis& basis, const dvec3& middle, const dvec3& low, const dvec3& high) {
        IdealPart part;
        const dvec3 axes[] = {basis.x, basis.y, basis.z};
        for (int k = 0; k < 3; ++k)
            for (const double sign : {-1.0, 1.0}) {
                part.normals.push_back(axes[k] * sign);
                part.offsets.push_back(dot(axes[k] * sign, middle) + sign * (sign < 0 ? low[k] : high[k]));
            }
        return part;
    }
};

/// An ideal body: the union of convex parts, which overlap wherever they meet; or a parallelogram.
struct IdealBody {
    std::vector<IdealPart> parts;
    bool sheet = false;
    dvec3 corner{0}, along{0}, across{0};  // of a sheet

    /// How deep a point lies inside; negative outside.
    double depth(const dvec3& p) const {
        double deepest = -1e300;
        for (const IdealPart& part : parts) deepest = max_or_second(deepest, part.depth(p));
        return deepest;
    }
    /// How often a segment passes the surface of the body grown by a length.
    int crossings(const dvec3& from, const dvec3& to, double grown) const {
        std::vector<std::array<double, 2>> chords;
        for (const IdealPart& part : parts)
            if (std::array<double, 2> c; part.chord(from, to, grown, c[0], c[1])) chords.push_back(c);
        std::sort(chords.begin(), chords.end());
        int count = 0;
        double inside_to = -1;
        for (const auto& [enter, leave] : chords) {
            if (enter > inside_to) count += (enter > 0) + (inside_to > 0);
            inside_to = max_or_second(inside_to, leave);
        }
        return count + (inside_to > 0 && inside_to < 1);
    }
    /// How far inside the sheet's border a point of its plane lies.
    double inside_border(const dvec3& p) const {
        const double a = length(along), b = length(across), u = dot(p - corner, along) / a,
                     v = dot(p - corner, across) / b;
        return min_or_second(min_or_second(u, a - u), min_or_second(v, b - v));
    }
    dvec3 sheet_normal() const { return normalized(cross(along, across)); }
};

/// An axis-parallel box.
struct BlockShape {
    dvec3 low, high;
};

/// Three of the four columns of a cube of the side `side`, on z = `low`.
inline std::vector<BlockShape> three_quarters(double side, double low) {
    const double h = side / 2;
    return {{{-h, -h, low}, {h, 0, low + side}}, {{-h, -h, low}, {0, h, low + side}}};
}

/// The surface of a union of boxes as a closed mesh: the faces between inner and outer cells of the grid of all their
/// sides.
inline TrianglesObject blocks_mesh(const std::vector<BlockShape>& boxes) {
    std::vector<double> sides[3];
    for (int k = 0; k < 3; ++k) {
        for (const BlockShape& box : boxes) sides[k].insert(sides[k].end(), {box.low[k], box.high[k]});
        std::sort(sides[k].begin(), sides[k].end());
        sides[k].erase(std::unique(sides[k].begin(), sides[k].end()), sides[k].end());
    }
    const auto inside = [&](std::array<int, 3> cell) {
        dvec3 p(0);
        for (size_t k = 0; k < 3; ++k) {
            if (cell[k] < 0 || cell[k] + 1 >= int(sides[k].size())) return false;
            p[int(k)] = (sides[k][size_t(cell[k])] + sides[k][size_t(cell[k] + 1)]) / 2;
        }
        return std::any_of(boxes.begin(), boxes.end(), [&](const BlockShape& box) {
            return p.x > box.low.x && p.x < box.high.x && p.y > box.low.y && p.y < box.high.y && p.z > box.low.z &&
                   p.z < box.high.z;
        });
    };
    TrianglesObject mesh;
    std::map<std::array<int, 3>, uint32_t> numbers;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [found, added] = numbers.emplace(at, uint32_t(mesh.vertices.size()));
        if (added)
            mesh.vertices.emplace_back(sides[0][size_t(at[0])], sides[1][size_t(at[1])], sides[2][size_t(at[2])]);
        return found->second;
    };
    std::array<int, 3> cell;
    for (cell[0] = 0; cell[0] < int(sides[0].size()); ++cell[0])
        for (cell[1] = 0; cell[1] < int(sides[1].size()); ++cell[1])
            for (cell[2] = 0; cell[2] < int(sides[2].size()); ++cell[2])
                for (size_t axis = 0; axis < 3; ++axis) {  // the face on the cell's low side
                    std::array<int, 3> below = cell;
                    --below[axis];
                    if (inside(cell) == inside(below)) continue;
                    const size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
                    std::array<int, 3> corner = cell;
                    uint32_t q[4];
                    for (int c = 0; c < 4; ++c) {
                        corner[a] = cell[a] + (c == 1 || c == 2);
                        corner[b] = cell[b] + (c >= 2);
                        q[inside(cell) ? 3 - c : c] = vertex(corner);
                    }
                    const int turn = (cell[0] + cell[1] + cell[2]) & 1;
                    mesh.triangles.push_back({q[turn], q[turn + 1], q[turn + 2]});
                    mesh.triangles.push_back({q[turn], q[turn + 2], q[(turn + 3) % 4]});
                }
    return mesh;
}

enum class BodyKind { planes, convex_mesh, mesh };

/// A scene under construction, in coordinates that `basis` turns and `origin` moves.
class ContactScene {
  public:
    SceneDescription scene;
    std::vector<IdealBody> bodies;  // by solid

    ContactScene(const Basis& basis, const dvec3& origin) : basis_(basis), origin_(origin) {}

    /// A cube of side `side` standing on the height z = `low`, turned by an angle about the vertical through its
    /// middle.
    void cube(double x, double y, double low, double side, double turn, int material, BodyKind kind) {
        const Basis own = basis_.turned(turn);
        const dvec3 middle = place({x, y, low + side / 2});
        IdealBody body;
        body.parts.push_back(IdealPart::box(own, middle, dvec3(-side / 2), dvec3(side / 2)));
        bodies.push_back(body);
        const double radius = side / 2 * square_root(3.0);
        if (kind == BodyKind::planes) {
            add_solid(scene, PlatonicSolid::cube, middle, radius, own.degrees(), material);
        } else if (kind == BodyKind::mesh) {
            TrianglesObject mesh = solid_mesh(PlatonicSolid::cube, middle, radius, own.degrees());
            mesh.keep_triangles = true;
            add_object(scene, mesh, material);
        } else {
            // From the basis itself: in double, angles near the poles lose more than what still counts as a contact.
            TrianglesObject mesh = blocks_mesh({{dvec3(-side / 2), dvec3(side / 2)}});
            for (dvec3& p : mesh.vertices) p = middle + own(p);
            add_object(scene, mesh, material);
        }
    }

    /// A closed mesh of boxes that overlap wherever they meet, about the vertical through (x, y) and turned about it;
    /// their z is the scene's.
    void blocks(double x, double y, double turn, const std::vector<BlockShape>& boxes, int material) {
        const Basis own = basis_.turned(turn);
        const dvec3 middle = place({x, y, 0});
        IdealBody body;
        for (const BlockShape& box : boxes) body.parts.push_back(IdealPart::box(own, middle, box.low, box.high));
        bodies.push_back(body);
        TrianglesObject mesh = blocks_mesh(boxes);
        mesh.keep_triangles = true;
        for (dvec3& p : mesh.vertices) p = middle + own(p);
        add_object(scene, mesh, material);
    }

    /// The parallelogram corner, corner + along, corner + along + across, corner + across.
    void quad(const dvec3& corner, const dvec3& along, const dvec3& across, int material) {
        IdealBody body;
        body.sheet = true;
        body.corner = place(corner), body.along = basis_(along), body.across = basis_(across);
        bodies.push_back(body);
        TrianglesObject quad;
        quad.vertices = {body.corner, body.corner + body.along, body.corner + body.along + body.across,
                         body.corner + body.across};
        quad.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_object(scene, quad, material);
    }

    dvec3 place(const dvec3& p) const { return origin_ + basis_(p); }

  private:
    Basis basis_;
    dvec3 origin_;
};

/// Counts of what was asked, and of answers that the ideal bodies contradict.
struct ContactCounts {
    size_t lines = 0, shadows = 0;
    size_t media = 0;        // a solid is around a line that lies well outside it, or the other way round
    size_t passed = 0;       // a line goes through a sheet
    size_t false_sheet = 0;  // a sheet is hit well outside its border
    size_t later = 0;        // a sheet is hit although a later one lies on it
    size_t shaded = 0;       // a shadow ray's faces are miscounted
    size_t gaps = 0;         // a new line ends where it starts, away from edges: a gap between bodies that touch

    size_t faults() const { return media + passed + false_sheet + later + shaded + gaps; }
    void add(const ContactCounts& other) {
        lines += other.lines, shadows += other.shadows, media += other.media, passed += other.passed;
        false_sheet += other.false_sheet, later += other.later, shaded += other.shaded, gaps += other.gaps;
    }
};

/// Checks every query of a ray tree against the ideal bodies. Every material must let half of all light pass.
template <class Real, class Inner>
class CheckedIntersector {
  public:
    using Media = typename Inner::Media;
    using Scene = typename Inner::Scene;

    CheckedIntersector(const CompiledScene<Real>& compiled, const std::vector<IdealBody>& bodies, const Inner& inner,
                       ContactCounts& counts)
        : scene(inner.scene), inner_(inner), compiled_(compiled), bodies_(bodies), counts_(counts) {}

    const Scene& scene;

    /// A line's next crossing, checked.
    template <class E>
    Hit<Real> closest(const Ray<Real, Media>& ray) const {
        const Hit<Real> hit = inner_.template closest<E>(ray);
        check(ray, hit);
        return hit;
    }
    /// A crossing on which no line ends by itself: how a line goes on is decided by several.
    Hit<Real> closest(const Ray<Real, Media>& ray) const { return inner_.closest(ray); }

    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real, Media>& shadow) const {
        const Throughput<Real, E> arrives = inner_.template transmittance<E>(shadow);
        ++counts_.shadows;
        int certain = 0, possible = 0;
        const dvec3 from = world(shadow.ray.origin);
        const dvec3 to = world(along(shadow.ray.origin, shadow.distance, shadow.ray.direction));
        for (uint32_t i = 0; i < bodies_.size(); ++i) {
            const Crossings crossings = crossings_of(bodies_[i], from, to, shadow.ray.media.contains(i));
            certain += crossings.certain, possible += crossings.possible;
        }
        const double halvings = -std::log2(double(largest_component(Vec3<Real>(arrives))));
        if (halvings < certain - 0.01 || halvings > possible + 0.01) ++counts_.shaded;
        if (target) look_at_target(shadow.ray);
        return arrives;
    }

    /// Draws points at which one line more is sent from each surface that shadow rays leave; none if empty.
    std::function<dvec3()> target;

  private:
    struct Crossings {
        int certain, possible;
    };

    double tolerance() const {
        return 512 * double(RealTraits<Real>::unit) * double(compiled_.extent) / std::ldexp(1.0, compiled_.scale);
    }
    dvec3 world(const Vec3<Real>& p) const {
        return dvec3(Vec3<double>(p)) / std::ldexp(1.0, compiled_.scale) + compiled_.center;
    }

    /// The faces of a body that a segment crosses, for the body grown and shrunk by the tolerance. `listed`: the
    /// segment starts inside by what its ray knows, which decides where the start is on a face.
    Crossings crossings_of(const IdealBody& body, const dvec3& from, const dvec3& to, bool listed) const {
        if (body.sheet) {
            const int crossed = crosses(body, from, to);
            return {crossed == 1, crossed != 0};
        }
        const double begin = body.depth(from), end = body.depth(to);
        if (magnitude(begin) > tolerance() && (begin > 0) != listed) ++counts_.media;
        if (magnitude(end) < tolerance()) return {0, 2 * int(body.parts.size())};
        Crossings range{1 << 20, 0};
        for (const double grown : {-tolerance(), 0.0, tolerance()}) {
            const bool starts_inside = begin > -grown;
            if (listed && !starts_inside) continue;
            const int count = body.crossings(from, to, grown) + (starts_inside && !listed);
            range = {std::min(range.certain, count), std::max(range.possible, count)};
        }
        return range.certain <= range.possible ? range : Crossings{0, 0};
    }

    /// Whether a segment crosses a sheet: 1 surely, 0 surely not, -1 near its border or at an end.
    int crosses(const IdealBody& sheet, const dvec3& from, const dvec3& to) const {
        const dvec3 n = sheet.sheet_normal();
        const double a = dot(n, from - sheet.corner), b = dot(n, to - sheet.corner);
        if (magnitude(a) < tolerance() || magnitude(b) < tolerance()) return -1;
        if ((a > 0) == (b > 0)) return 0;
        const double inside = sheet.inside_border(from + (to - from) * (a / (a - b)));
        const double border = tolerance() * length(to - from) / magnitude(a - b);
        return inside > border ? 1 : inside < -border ? 0 : -1;
    }

    /// Sends a ray from a shadow ray's start to a target on the same side of the face that it leaves, and straight on.
    void look_at_target(const Ray<Real, Media>& shadow) const {
        const dvec3 from = world(shadow.origin), way = target() - from;
        const dvec3 normal = normal_left(shadow);
        const dvec3 light(Vec3<double>(shadow.direction));
        if (!(length(way) > 0) || !(dot(normal, way) * dot(normal, light) > 0)) return;
        Ray<Real, Media> ray = shadow;
        ray.direction = Vec3<Real>(normalized(way));
        const double slope = double(dot(Vec3<Real>(normal), ray.direction));
        if (magnitude(slope) < 0x1p-10 || !(slope * dot(normal, light) > 0)) return;
        count_meshes(scene, *this, ray);
        for (int faces = 0; faces < 8; ++faces) {
            const Hit<Real> hit = closest<Effects<all_effects>>(ray);
            if (!hit.found() || hit.wrong_side_t <= hit.t) return;  // refused crossings are for NextSurface to count
            if (const int change = media_change(key_kind(hit.key)); change != 0)
                ray.media.add(key_solid(hit.key), change);
            ray.after = {hit.t, hit.key};
        }
    }

    /// A normal of the face that a ray leaves.
    dvec3 normal_left(const Ray<Real, Media>& ray) const {
        const Solid& solid = scene.solids[ray.from_solid];
        if (solid.kind == SolidKind::convex)
            return dvec3(Vec3<double>(scene.slabs[solid.first_slab + ray.from_face / 2].normal));
        for (uint32_t slot = 0; slot < scene.clusters.size * cluster_lanes; ++slot) {
            const auto& cluster = scene.clusters[slot / cluster_lanes];
            if (slot % cluster_lanes < cluster.count && cluster.triangle[slot % cluster_lanes] == ray.from_face)
                return dvec3(Vec3<double>(outward_normal(scene, slot)));
        }
        return dvec3(0);
    }

    /// Whether a point lies where faces of different directions meet, or at a sheet's border.
    bool at_edge(const dvec3& p) const {
        dvec3 first(0);
        bool edge = false;
        const auto add = [&](const dvec3& normal) {
            if (dot(first, first) > 0 && magnitude(dot(first, normal)) < 0.999) edge = true;
            first = normal;
        };
        for (const IdealBody& body : bodies_) {
            if (body.sheet) {
                if (magnitude(dot(body.sheet_normal(), p - body.corner)) > 2 * tolerance()) continue;
                if (body.inside_border(p) > -2 * tolerance()) add(body.sheet_normal());
                edge |= magnitude(body.inside_border(p)) < 2 * tolerance();
            } else {
                for (const IdealPart& part : body.parts)
                    for (size_t i = 0; part.depth(p) > -2 * tolerance() && i < part.normals.size(); ++i)
                        if (magnitude(dot(part.normals[i], p) - part.offsets[i]) < 2 * tolerance())
                            add(part.normals[i]);
            }
        }
        return edge;
    }

    void check(const Ray<Real, Media>& ray, const Hit<Real>& hit) const {
        ++counts_.lines;
        if (ray.fresh() && ray.from_solid != no_solid && hit.found() &&
            double(hit.t) < 64 * double(RealTraits<Real>::unit) && !at_edge(world(ray.origin)))
            ++counts_.gaps;
        const Real begin = max_or_second(ray.after.t, Real(0));
        const Real end = hit.found() ? hit.t : Real(8);
        const dvec3 from = world(along(ray.origin, begin, ray.direction)),
                    to = world(along(ray.origin, end, ray.direction));
        if (length(to - from) < 4 * tolerance()) return;
        for (uint32_t i = 0; i < bodies_.size(); ++i) {
            if (bodies_[i].sheet) {
                counts_.passed += crosses(bodies_[i], from, to) == 1;
                continue;
            }
            bool wrong = false;
            for (const double share : {0.01, 0.3, 0.5, 0.9, 0.99}) {
                const double depth = bodies_[i].depth(from + (to - from) * share);
                if (magnitude(depth) > tolerance()) wrong |= (depth > 0) != ray.media.contains(i);
            }
            counts_.media += wrong;
        }
        if (hit.found() && key_kind(hit.key) == CrossingKind::sheet) check_sheet(ray, hit, to);
    }
    void check_sheet(const Ray<Real, Media>& ray, const Hit<Real>& hit, const dvec3& at) const {
        const uint32_t met = key_solid(hit.key);
        const double slant = magnitude(dot(bodies_[met].sheet_normal(), dvec3(Vec3<double>(ray.direction))));
        if (slant < 0x1p-10) return;  // the place of so flat a crossing is not known well enough
        const double border = tolerance() / slant;
        counts_.false_sheet += bodies_[met].inside_border(at) < -border;
        for (uint32_t i = met + 1; i < bodies_.size(); ++i)
            if (bodies_[i].sheet && magnitude(dot(bodies_[i].sheet_normal(), at - bodies_[i].corner)) < tolerance() &&
                magnitude(dot(bodies_[i].sheet_normal(), bodies_[met].sheet_normal())) > 0.999)
                counts_.later += ray.fresh() && bodies_[i].inside_border(at) > border;
    }

    const Inner& inner_;
    const CompiledScene<Real>& compiled_;
    const std::vector<IdealBody>& bodies_;
    ContactCounts& counts_;
};

}  // namespace cistula::test
