// Ray trees in scenes of balls that touch, cut and contain one another, sheets, a cube and a mesh: every line is
// compared with what is true of the compiled balls, in long double (docs/rules.md, 14). The sheets are quads, disks and
// planes without end (17).
#include <map>

#include "cistula/traversal/bvh.h"
#include "testing/support/contacts/contact_walk.h"
#include "testing/support/intersectors.h"

namespace cistula {
namespace {

using namespace test;
using Exact = long double;
using ExactPoint = Vec3<Exact>;

Exact exact_dot(const ExactPoint& a, const ExactPoint& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Exact exact_length(const ExactPoint& a) {
    return std::sqrt(exact_dot(a, a));
}

/// A quad; a disk of a radius about `corner`, or a plane through it, of an infinite one.
struct Quad {
    dvec3 corner, along, across;
    double radius = 0;
};

enum class Sheet { quad, disk, plane };
constexpr const char* sheet_names[] = {"quads", "disks", "planes"};

/// A scene in its own frame, with the places at which lines are aimed.
struct BallScene {
    SceneDescription scene;
    std::vector<Quad> quads;  // the first objects
    std::vector<dvec3> aims;
    Sheet sheet = Sheet::quad;
    bool afar = false;          // lines start far away
    std::vector<dvec3> around;  // lines start near these, as far as their sizes say; anywhere if there are none
    double size = 1;
    bool opaque = false;  // no line comes from above the quad to below it
    int tolerance = 8;    // u M; more where lines start off flat faces: 8 off sheets, up to 2^9 along those of a mesh

    BallScene() {
        scene.frame = FrameOfReference{};
        add_light(scene, {1.99, 0, 0});  // seen, so that M is 2 but for rounding
        scene.lights[0].color = dvec3(0);
        scene.lights[0].radius = 0x1p-10;
        add_material(scene, 0.2, 0.5, dvec3(1), 1.5);
        add_material(scene, 0.2, 0.5, dvec3(1), 1.2);
        add_material(scene, 0.2, 0.5, dvec3(1), 1.0);
        add_material(scene, 0.2, 0.5);
        add_material(scene, 0.5);
    }
    void ball(const dvec3& center, double radius, int material = 0) {
        SphereObject sphere;
        sphere.center = center;
        sphere.radius = radius;
        add_object(scene, sphere, material);
    }
    void quad(const dvec3& middle, const dvec3& normal, Random& random, double half = 0.7) {
        const dvec3 e = normalized(cross(normal, random.direction()));
        const dvec3 f = cross(normal, e);
        tolerance = 20;
        const int material = opaque ? 4 : 3;
        if (sheet != Sheet::quad) {
            DiskObject disk = DiskObject::plane(normal, dot(normal, middle));
            if (sheet == Sheet::disk) disk.center = middle, disk.radius = half;
            quads.push_back({middle, e, f, disk.radius});
            return add_object(scene, disk, material);
        }
        quads.push_back({middle - half * e - half * f, 2 * half * e, 2 * half * f});
        const Quad& q = quads.back();
        TrianglesObject square;
        square.vertices = {q.corner, q.corner + q.along, q.corner + q.along + q.across, q.corner + q.across};
        square.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_object(scene, square, material);
    }
    void cube(const dvec3& middle, double half, const Basis& basis, int material, bool as_mesh) {
        const double radius = half * std::sqrt(3.0);
        tolerance = as_mesh ? 512 : 20;
        if (as_mesh)
            add_object(scene, solid_mesh(PlatonicSolid::cube, middle, radius, basis.degrees()), material);
        else
            add_solid(scene, PlatonicSolid::cube, middle, radius, basis.degrees(), material);
    }
};

struct BallKind {
    const char* name;
    /// `u`: 2 u M of the precision.
    void (*build)(BallScene&, Random&, double u);
};

const BallKind kinds[] = {
    {"a glass ball", [](BallScene& s, Random& r, double) { s.ball(r.in_cube(0.3), r.between(0.05, 0.8)); }},
    {"on a quad",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         const double radius = r.between(0.05, 0.5);
         s.quad(at, n, r), s.ball(at + radius * n, radius), s.aims = {at};
     }},
    {"cut by a quad",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         const double radius = r.between(0.05, 0.5), h = radius * r.between(-0.99, 0.99);
         s.quad(at, n, r), s.ball(at + h * n, radius);
         for (int i = 0; i < 32; ++i)
             s.aims.push_back(at + std::sqrt(radius * radius - h * h) * normalized(cross(n, r.direction())));
     }},
    {"on an opaque quad",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction();
         const double radius = r.between(0.05, 0.3);
         s.opaque = true, s.quad(dvec3(0), n, r, 1.2), s.ball(radius * n, radius), s.aims = {dvec3(0)};
     }},
    {"cut by an opaque quad",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction();
         const double radius = r.between(0.05, 0.5), h = radius * r.between(-0.99, 0.99);
         s.opaque = true, s.quad(dvec3(0), n, r, 1.2), s.ball(h * n, radius);
         for (int i = 0; i < 32; ++i)
             s.aims.push_back(std::sqrt(radius * radius - h * h) * normalized(cross(n, r.direction())));
     }},
    {"touching",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         const double radius = r.between(0.05, 0.5), other = radius * std::pow(10, r.between(-1, 0));
         s.ball(at + radius * n, radius), s.ball(at - other * n, other, 1), s.aims = {at};
     }},
    {"three on a quad",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.1), e = normalized(cross(n, r.direction())), f = cross(n, e);
         constexpr double a = 0.4;
         s.quad(at, n, r);
         std::vector<dvec3> feet;
         for (int i = 0; i < 3; ++i) {
             const double phi = i * 2.0943951023931953;
             feet.push_back(at + (2 * a / std::sqrt(3.0)) * (std::cos(phi) * e + std::sin(phi) * f));
             s.ball(feet.back() + a * n, a, i);
         }
         s.aims = feet;
         for (size_t i = 0; i < 3; ++i) s.aims.push_back((feet[i] + feet[(i + 1) % 3]) * 0.5 + a * n);
     }},
    {"touching from inside",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         const double radius = r.between(0.1, 0.6), inner = radius * r.between(0.2, 0.95);
         s.ball(at + radius * n, radius), s.ball(at + inner * n, inner, 1), s.aims = {at};
     }},
    {"thin shells",
     [](BallScene& s, Random& r, double u) {
         const dvec3 at = r.in_cube(0.2);
         const double radius = r.between(0.1, 0.8);
         for (int i = 0; i < 3; ++i) s.ball(at + 4 * u * r.direction(), radius - i * 40 * u, i);
     }},
    {"coincident",
     [](BallScene& s, Random& r, double u) {
         const dvec3 at = r.in_cube(0.2);
         const double radius = r.between(0.1, 0.8);
         s.ball(at, 1.05 * radius), s.ball(at + u * r.direction(), radius, 2);
         s.ball(at + u * r.direction(), radius * (1 + u), 1);
     }},
    {"overlapping",
     [](BallScene& s, Random& r, double) {
         const dvec3 at = r.in_cube(0.2);
         const double radius = r.between(0.1, 0.5);
         for (int i = 0; i < 3; ++i) s.ball(at + radius * r.direction(), radius * r.between(0.6, 1.4), i);
     }},
    {"tiny on a quad",
     [](BallScene& s, Random& r, double u) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         s.size = u > 1e-10 ? 0x1p-13 : 1e-6;
         s.quad(at, n, r), s.ball(at + s.size * n, s.size), s.aims = {at}, s.around = {at + s.size * n};
     }},
    {"on a planet",
     [](BallScene& s, Random& r, double u) {
         const dvec3 n = r.direction();
         s.size = 16 * (u > 1e-10 ? 0x1p-13 : 1e-6);
         s.ball(dvec3(0), 1), s.ball((1 + s.size) * n, s.size, 1), s.aims = {n}, s.around = {(1 + s.size) * n};
     }},
    {"on a cube on a quad",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1), top = at + 0.5 * b.z;
         s.quad(at, b.z, r), s.cube(at + 0.25 * b.z, 0.25, b, 1, false), s.ball(top + 0.2 * b.z, 0.2), s.aims = {top};
     }},
    {"in a cube",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1);
         s.cube(at, 0.4, b, 0, false), s.ball(at, 0.4, 1);
         for (const dvec3& n : {b.x, b.y, b.z}) s.aims.push_back(at + 0.4 * n), s.aims.push_back(at - 0.4 * n);
     }},
    {"on a mesh",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1), top = at + 0.5 * b.z;
         s.cube(at + 0.25 * b.z, 0.25, b, 1, true), s.ball(top + 0.2 * b.z, 0.2), s.aims = {top};
     }},
};

/// Kinds without quads.
const BallKind flat_kinds[] = {
    {"two that cross",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), m = r.direction(), at = r.in_cube(0.2);
         s.quad(at, n, r), s.quad(at, m, r), s.ball(at + r.in_cube(0.3), r.between(0.05, 0.4));
         for (int i = -4; i <= 4; ++i) s.aims.push_back(at + 0.1 * i * normalized(cross(n, m)));
     }},
    {"a quad across",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), m = r.direction(), at = r.in_cube(0.2);
         const Sheet kind = s.sheet;
         s.quad(at, n, r), s.sheet = Sheet::quad, s.quad(at, m, r), s.sheet = kind;
         s.ball(at + r.in_cube(0.3), r.between(0.05, 0.4));
         for (int i = -4; i <= 4; ++i) s.aims.push_back(at + 0.1 * i * normalized(cross(n, m)));
     }},
    {"a quad and two in one",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), at = r.in_cube(0.2);
         const Sheet kind = s.sheet;
         s.quad(at, n, r), s.quad(at, -n, r), s.sheet = Sheet::quad, s.quad(at, n, r), s.sheet = kind;
         s.ball(at + r.in_cube(0.3), r.between(0.05, 0.4)), s.aims = {at};
     }},
    {"a cube on it",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1);
         s.quad(at, b.z, r), s.cube(at + 0.25 * b.z, 0.25, b, 1, false), s.ball(at + 0.3 * b.x, 0.05);
         for (const dvec3& d : {b.x, b.y, b.x + b.y}) s.aims.push_back(at + 0.25 * d), s.aims.push_back(at - 0.25 * d);
     }},
    {"a cube cut by it",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1), n = r.below(3) == 0 ? b.x : r.direction();
         s.quad(at, n, r), s.cube(at + r.in_cube(0.1), 0.25, b, 1, false), s.ball(at + 0.3 * b.x, 0.05);
         for (int i = 0; i < 16; ++i) s.aims.push_back(at + 0.25 * normalized(cross(n, r.direction())));
     }},
    {"a cube under two",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         const dvec3 at = r.in_cube(0.1);
         s.quad(at, b.z, r), s.quad(at + 0.25 * b.x, b.x, r), s.cube(at - 0.25 * b.z, 0.25, b, 1, false);
         s.ball(at + 0.3 * b.x, 0.05), s.tolerance = 128;  // starts are pushed off both where the ball touches
         for (int i = -2; i <= 2; ++i) s.aims.push_back(at + 0.25 * b.x + 0.1 * i * b.y);
     }},
};

/// Kinds of planes, with lines that start far away.
const BallKind far_kinds[] = {
    {"a ball on a plane",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction();
         s.quad(dvec3(0), n, r), s.ball(0.4 * n, 0.4), s.aims = {dvec3(0), 0.8 * n};
     }},
    {"two planes that cross",
     [](BallScene& s, Random& r, double) {
         const dvec3 n = r.direction(), m = r.direction(), at = r.in_cube(0.2), line = normalized(cross(n, m));
         s.quad(at, n, r), s.quad(at, m, r), s.ball(at + r.in_cube(0.3), r.between(0.05, 0.4));
         for (int i = 0; i < 16; ++i) s.aims.push_back(at + std::pow(10, r.between(-1, 3)) * line);
     }},
    {"a cube between planes",
     [](BallScene& s, Random& r, double) {
         const Basis b = Basis::random(r);
         s.quad(-0.25 * b.z, b.z, r), s.quad(0.25 * b.z, b.z, r), s.cube(dvec3(0), 0.25, b, 1, false);
         s.ball(0.6 * b.x, 0.1);
     }},
};

struct BallCounts {
    size_t lines = 0, shadows = 0;
    size_t missed = 0;  // a ball is entered unnoticed
    size_t stays = 0;   // a ball is left unnoticed
    size_t solid = 0;   // a cube is around a line that lies well outside it, or the other way round
    size_t passed = 0;  // a line goes through a quad
    size_t off = 0;     // a hit lies off its ball
    size_t again = 0;   // a line that leaves a sheet meets it
    size_t shaded = 0;  // a shadow ray's faces are miscounted

    size_t faults() const { return missed + stays + solid + passed + off + again + shaded; }
    void add(const BallCounts& o) {
        lines += o.lines, shadows += o.shadows, missed += o.missed, stays += o.stays, solid += o.solid;
        passed += o.passed, off += o.off, again += o.again, shaded += o.shaded;
    }
};

template <class Real, class Inner>
class CheckedBalls {
  public:
    using Media = InteriorList;
    using Scene = SceneView<Real>;

    CheckedBalls(const BallScene& ideal, const Inner& inner, BallCounts& counts)
        : scene(inner.scene), ideal_(ideal), inner_(inner), counts_(counts) {}

    const Scene& scene;

    template <class E>
    Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = inner_.template closest<E>(ray);
        check(ray, hit);
        return hit;
    }
    Hit<Real> closest(const Ray<Real>& ray) const { return inner_.closest(ray); }

    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        const auto arrives = inner_.template transmittance<E>(shadow);
        ++counts_.shadows;
        const ExactPoint from(along(shadow.ray.origin, begin_of(shadow.ray), shadow.ray.direction)),
            to(shadow.light->position);
        int certain = 0, possible = 0;
        const auto add = [&](int least, int most) { certain += least, possible += most; };
        for (uint32_t i = 0; i < scene.solids.size; ++i) {
            const Solid& solid = scene.solids[i];
            if (is_ball(solid)) {
                int least = 2, most = 0;
                for (const Exact grown : {-tolerance(), Exact(0), tolerance()}) {
                    const int faces = faces_of(i, from, to, grown, shadow.ray);
                    least = std::min(least, faces), most = std::max(most, faces);
                }
                add(least, most);
            } else {
                add(0, solid.kind == SolidKind::sheet ? 0 : 2);
            }
        }
        for (const Quad& quad : ideal_.quads) {
            const int crossed = crosses(quad, from, to);
            add(crossed == 1, crossed != 0);
        }
        const double halvings = -std::log2(double(largest_component(Vec3<Real>(arrives))));
        counts_.shaded += !ideal_.opaque && (halvings < certain - 0.01 || halvings > possible + 0.01);
        return arrives;
    }

    Exact depth(uint32_t index, const ExactPoint& p) const {
        const Solid& solid = scene.solids[index];
        if (is_ball(solid)) {
            const Ball<Real>& ball = scene.balls[solid.first_slab];
            return Exact(ball.radius) - exact_length(p - ExactPoint(ball.center));
        }
        Exact least = 1e30L;
        if (solid.kind == SolidKind::convex)
            for (uint32_t i = 0; i < solid.slab_count; ++i) {
                const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
                const Exact n = exact_dot(ExactPoint(slab.normal), p);
                least = std::min({least, n - Exact(slab.low), Exact(slab.high) - n});
            }
        else
            for (uint32_t slot = 0; slot < scene.clusters.size * cluster_lanes; ++slot) {
                const auto& cluster = scene.clusters[slot / cluster_lanes];
                if (slot % cluster_lanes >= cluster.count || cluster.solid != index) continue;
                Vec3<Real> corner[3];
                triangle_corners(scene, slot, corner);
                const ExactPoint n(outward_normal(scene, slot));
                least = std::min(least, exact_dot(n, ExactPoint(corner[0]) - p));
            }
        return least;
    }
    /// How far rounding may put a line off.
    Exact tolerance() const { return ideal_.tolerance * Exact(RealTraits<Real>::unit) * Exact(scene.extent); }

    Exact off_plane(const Quad& quad, const ExactPoint& p) const {
        return exact_dot(ExactPoint(normalized(cross(quad.along, quad.across))), p - ExactPoint(quad.corner));
    }

  private:
    /// The faces of a ball, grown, that a segment crosses.
    int faces_of(uint32_t index, const ExactPoint& from, const ExactPoint& to, Exact grown,
                 const Ray<Real>& ray) const {
        const Ball<Real>& ball = scene.balls[scene.solids[index].first_slab];
        const ExactPoint f = ExactPoint(ball.center) - from, way = to - from;
        const Exact radius = Exact(ball.radius) + grown, length = exact_length(way), b = exact_dot(f, way) / length;
        const Exact square = radius * radius - exact_dot(f - way * (b / length), f - way * (b / length));
        const Exact start = exact_length(f) - Exact(ball.radius);
        const bool starts_near = std::abs(start) < 2 * tolerance();
        const bool inside = starts_near ? ray.media.contains(index) : start < 0;
        const bool ends_inside = exact_length(to - ExactPoint(ball.center)) < radius;
        if (inside || ends_inside) return inside != ends_inside;
        if (starts_near && (ray.from_solid == index || grown <= 0)) return 0;
        return square > 0 && b > 0 && b < length ? 2 : 0;
    }

    /// 1 if a segment surely crosses a quad, 0 if surely not, else -1.
    int crosses(const Quad& quad, const ExactPoint& from, const ExactPoint& to) const {
        const Exact come_from = ideal_.afar ? 512 : 1;  // as lines that end here may have
        const Exact reach = std::max({come_from, exact_length(from) / 2, exact_length(to) / 2});
        const Exact a = off_plane(quad, from), b = off_plane(quad, to), slack = 3 * tolerance() * reach;
        if (ideal_.opaque ? std::abs(b) < slack : std::abs(a) < slack || std::abs(b) < slack) return -1;
        if (ideal_.opaque ? a < -slack || b > 0 : (a > 0) == (b > 0)) return 0;
        const Exact above =
            ideal_.opaque ? std::max(a, Exact(0)) : a;  // a start within rounding is where its line came from
        const ExactPoint place = from + (to - from) * (above / (above - b)), p = place - ExactPoint(quad.corner);
        const Exact flattest = std::abs(a - b) / exact_length(to - from);
        if (flattest < 16 * Exact(RealTraits<Real>::unit) && exact_length(place) > 0x1p11L) return -1;  // the horizon
        const ExactPoint e(quad.along), f(quad.across);
        const Exact u = exact_dot(p, e) / exact_dot(e, e), v = exact_dot(p, f) / exact_dot(f, f);
        const Exact inside = quad.radius > 0 ? Exact(quad.radius) - exact_length(p) : std::min({u, v, 1 - u, 1 - v});
        const Exact border = slack * exact_length(to - from) / std::abs(above - b);
        return inside > border ? 1 : inside < -border ? 0 : -1;
    }

    void check(const Ray<Real>& ray, const Hit<Real>& hit) const {
        ++counts_.lines;
        const ExactPoint o(ray.origin), d(ray.direction);
        const Exact begin = begin_of(ray), end = std::max(Exact(hit.found() ? hit.t : Real(8)), begin);
        const auto at = [&](Exact t) { return o + d * t; };
        for (uint32_t i = 0; i < scene.solids.size; ++i) {
            const Solid& solid = scene.solids[i];
            const bool listed = ray.media.contains(i);
            if (is_ball(solid)) {
                const ExactPoint f = ExactPoint(scene.balls[solid.first_slab].center) - o;
                const Exact middle = std::clamp(exact_dot(f, d) / exact_dot(d, d), begin, end);
                if (listed)
                    counts_.stays += -std::min(depth(i, at(begin)), depth(i, at(end))) > tolerance();
                else
                    counts_.missed += depth(i, at(middle)) > tolerance();
            } else if (solid.kind != SolidKind::sheet) {
                bool wrong = false;
                for (const double share : {0.01, 0.3, 0.5, 0.9, 0.99}) {
                    const Exact inside = depth(i, at(begin + (end - begin) * share));
                    wrong |= std::abs(inside) > 64 * tolerance() && (inside > 0) != listed;
                }
                counts_.solid += wrong;
            }
        }
        for (const Quad& quad : ideal_.quads) counts_.passed += crosses(quad, at(begin), at(end)) == 1;
        if (hit.found() && is_ball(scene.solids[key_solid(hit.key)]))
            counts_.off += std::abs(depth(key_solid(hit.key), at(hit.t))) > tolerance();
        const bool on_sheet = hit.found() && key_kind(hit.key) == CrossingKind::sheet;
        counts_.again += on_sheet && ray.after.key == 0 && key_solid(hit.key) == ray.from_solid;
    }

    const BallScene& ideal_;
    const Inner& inner_;
    BallCounts& counts_;
};

/// A vector of this length, which is drawn before its direction: compilers differ in the order of two draws in one
/// term.
dvec3 in_any_direction(Random& r, double length) {
    return length * r.direction();
}
dvec3 near(Random& r, double low, double high) {
    return in_any_direction(r, std::pow(10, r.between(low, high)));
}

/// Traces trees of lines that are aimed at contacts, at outlines, and anywhere.
template <class Real, class Inner>
void walk_balls(const BallScene& ideal, const SceneView<Real>& view, Random& random, BallCounts& counts) {
    const Inner inner{view};
    const CheckedBalls<Real, Inner> checked(ideal, inner, counts);
    const double fine = sizeof(Real) == sizeof(float) ? -9 : -17;
    for (int i = 0; i < 100; ++i) {
        const Ball<Real>& ball = view.balls[random.below(view.balls.size)];
        const dvec3 center(Vec3<double>(ball.center));
        const auto radius = double(ball.radius);
        Ray<Real> ray;
        const dvec3 o = !ideal.around.empty()  ? ideal.around[0] + ideal.size * near(random, 0.1, 2)
                        : random.below(3) == 0 ? center + in_any_direction(random, radius * random.unit())
                                               : in_any_direction(random, random.between(0.2, 1.5));
        ray.origin = Vec3<Real>(ideal.afar ? in_any_direction(random, std::pow(10, random.between(0.5, 3))) : o);
        const dvec3 from(Vec3<double>(ray.origin));
        bool is_clear = true;
        for (uint32_t s = 0; s < view.solids.size; ++s) {
            if (view.solids[s].kind == SolidKind::sheet) continue;
            const Exact depth = checked.depth(s, ExactPoint(ray.origin));
            is_clear &= std::abs(depth) > 64 * checked.tolerance();
            if (depth > 0) ray.media.add(s, 1);
        }
        const Exact reach = std::max(Exact(1), Exact(length(from)) / 2);
        for (const Quad& quad : ideal.quads)
            is_clear &= std::abs(checked.off_plane(quad, ExactPoint(ray.origin))) > 64 * reach * checked.tolerance();
        if (ideal.opaque) is_clear &= length(from) < 0.7 && checked.off_plane(ideal.quads[0], ExactPoint(from)) > 0;
        if (!is_clear) continue;
        const uint32_t choice = random.below(10);
        dvec3 target = center + in_any_direction(random, radius * 1.2 * random.unit());
        if (!ideal.aims.empty() && choice < 5) {
            target = ideal.aims[random.below(uint32_t(ideal.aims.size()))];
            target += radius * near(random, fine, -1);
        } else if (choice < 8) {
            target = center + normalized(cross(random.direction(), center - from)) * radius;
            target += radius * near(random, fine, -1);
        }
        ray.direction = Vec3<Real>(normalized(target - from));
        if (ideal.afar) start_near<Effects<all_effects>>(view, ray);
        EXPECT_EQ(trace_tree(view, checked, ray, 6), 0u);
    }
}

template <class Real>
class BallContacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(BallContacts, Reals);

/// Walks through scenes of a kind, and returns how many faults there are.
template <class Real>
size_t walk_kind(const BallKind& kind, Sheet sheet, bool afar = false) {
    Random random(7);
    BallCounts sum;
    for (int turn = 0; turn < 24; ++turn) {
        BallScene ideal;
        ideal.sheet = sheet;
        ideal.afar = afar;
        kind.build(ideal, random, 2 * double(RealTraits<Real>::unit));
        if (sheet != Sheet::quad && ideal.quads.empty()) return 0;
        for (int i = 0; i < 2; ++i) add_light(ideal.scene, random.direction() * (afar && i == 0 ? 350 : 3.5));
        const auto compiled = compile<Real>(ideal.scene, turn % 2 == 0);
        if (turn % 2 == 0)
            walk_balls<Real, test::Bvh<Real>>(ideal, compiled->view(), random, sum);
        else
            walk_balls<Real, test::Brute<Real>>(ideal, compiled->view(), random, sum);
    }
    std::printf(
        "%-6s %-6s %-22s lines %7zu shadows %7zu | missed %zu stays %zu solid %zu passed %zu off %zu again %zu "
        "shadow %zu\n",
        RealTraits<Real>::name, sheet_names[int(sheet)], kind.name, sum.lines, sum.shadows, sum.missed, sum.stays,
        sum.solid, sum.passed, sum.off, sum.again, sum.shaded);
    EXPECT_GT(sum.lines, 4000u) << kind.name;
    return sum.faults();
}

TYPED_TEST(BallContacts, HaveNoFaults) {
    size_t faults = 0;
    for (const BallKind& kind : kinds) faults += walk_kind<TypeParam>(kind, Sheet::quad);
    EXPECT_EQ(faults, 0u);
}

TYPED_TEST(BallContacts, OfDisksAndPlanesHaveNoFaults) {
    size_t faults = 0;
    for (const Sheet sheet : {Sheet::disk, Sheet::plane}) {
        for (const BallKind& kind : kinds) faults += walk_kind<TypeParam>(kind, sheet);
        for (const BallKind& kind : flat_kinds) faults += walk_kind<TypeParam>(kind, sheet);
    }
    EXPECT_EQ(faults, 0u);
}

TYPED_TEST(BallContacts, FromAfarHaveNoFaults) {
    size_t faults = 0;
    for (const BallKind& kind : far_kinds) faults += walk_kind<TypeParam>(kind, Sheet::plane, true);
    EXPECT_EQ(faults, 0u);
}

}  // namespace
}  // namespace cistula
