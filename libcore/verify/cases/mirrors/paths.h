// Paths between mirrors: along lines that unfolded are straight, and inside closed solids.
#pragma once

#include "cistula/numerics/double_double.h"
#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"
#include "verify/setup.h"

namespace cistula::verify::mirrors {

// ---- axis-parallel mirrors: with the mirrors unfolded, the path is straight. Each coordinate after a length T is the
// triangle wave of o + T d; in d only signs change.

enum class Walls : uint32_t {
    cube_of_planes,
    cube_of_triangles,  // points: its lowest and its highest corner
    two_cubes,          // the upper face of the first and the lower one of the second
    two_sheets,         // points: the lowest corner of the lower, the highest of the upper one
};

/// A coordinate that is reflected between two walls.
struct Fold {
    DoubleDouble low, width;

    CISTULA_HD static Fold between(double low, double high) { return {DoubleDouble(low), two_sum(high, -low)}; }
    /// The reflected coordinate. At a multiple of the width both branches of the wave are equal, so it does not matter
    /// which one rounding selects.
    CISTULA_HD DoubleDouble operator()(const DoubleDouble& unfolded) const {
        const DoubleDouble z = unfolded - low;
        const double k = floor_of(z.high / width.high);
        const DoubleDouble rest = z - width * DoubleDouble(k);
        return low + (k - 2 * floor_of(k * 0.5) == 1 ? width - rest : rest);
    }
};

/// Deviation: distance of the next line's origin from the closed form, divided by the number of bounces.
struct FoldedPath {
    Walls walls;
    uint32_t bounces;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const bool cube = walls == Walls::cube_of_planes || walls == Walls::cube_of_triangles;
        Draw draw = setup.draw(i);
        Fold fold[3];
        for (int axis = 0; axis < 3; ++axis)
            if (cube || axis == 1) fold[axis] = Fold::between(wall(setup, axis, false), wall(setup, axis, true));
        Vec3<Real> origin, direction;
        // A direction that rounding to unit length does not change: mirroring then changes signs alone. Most are such.
        for (int attempt = 0; attempt < 64; ++attempt) {
            start(setup, draw, cube, fold, origin, direction);
            if (renormalized(direction) == direction) break;
        }
        Ray<Real> ray = ray_from(origin, direction);
        if (cube) ray = inside(ray, 0);
        const Vec3<double> o(origin);
        const double ulp = 2 * double(RealTraits<Real>::unit * setup.extent());
        DoubleDouble path(0);
        for (uint32_t n = 1; n <= bounces; ++n) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found() || !wall_kind(key_kind(hit.key))) {
                tally.measure(RealTraits<double>::infinity);
                return;
            }
            path = path + DoubleDouble(double(hit.t));
            const Surface<Real> s = surface_at<Real, Effects<0>>(setup.scene, ray, hit);
            const Vec3<Real> way = reflected(ray.direction, s.normal);
            double worst = 0;
            int turned = 0;
            bool same = true;
            for (int axis = 0; axis < 3; ++axis) {
                const DoubleDouble straight = DoubleDouble(o[axis]) + path * DoubleDouble(double(direction[axis]));
                const DoubleDouble there = cube || axis == 1 ? fold[axis](straight) : straight;
                worst = max_or_second(worst, magnitude(double(there - DoubleDouble(double(s.viewer_side[axis])))));
                turned += way[axis] == -ray.direction[axis] ? 1 : 0;
                same = same && magnitude(way[axis]) == magnitude(direction[axis]);
            }
            tally.measure(same && turned == 1 ? worst / (ulp * n) : RealTraits<double>::infinity);
            ray = leaving(s.viewer_side, way, hit, ray.media);
        }
    }

  private:
    CISTULA_HD bool wall_kind(CrossingKind kind) const {
        return kind == (walls == Walls::two_sheets  ? CrossingKind::sheet
                        : walls == Walls::two_cubes ? CrossingKind::enter
                                                    : CrossingKind::leave);
    }

    /// A wall's coordinate as stored in Real. NaN if the scene has no such wall; then nothing holds.
    template <class Real>
    CISTULA_HD double wall(const Setup<Real>& setup, int axis, bool upper) const {
        if (walls == Walls::cube_of_triangles || walls == Walls::two_sheets)
            return double(setup.point(upper ? 1 : 0)[axis]);
        const Solid& solid = setup.scene.solids[walls == Walls::two_cubes && upper ? 1 : 0];
        const bool high = (walls == Walls::two_cubes) != upper;
        for (uint32_t i = 0; i < solid.slab_count; ++i) {
            const Slab<Real>& slab = setup.scene.slabs[solid.first_slab + i];
            if (slab.normal[axis] == Real(1)) return double(high ? slab.high : slab.low);
            if (slab.normal[axis] == Real(-1)) return -double(high ? slab.low : slab.high);
        }
        return no_number<double>;
    }

    /// A random start. In a cube, no component of the direction is below about a third of the others' length; between
    /// two mirrors the line moves along them from one side of their center to the other.
    template <class Real>
    CISTULA_HD static void start(const Setup<Real>& setup, Draw& draw, bool cube, const Fold (&fold)[3],
                                 Vec3<Real>& origin, Vec3<Real>& direction) {
        Vec3<double> o, d;
        for (int axis = 0; axis < 3; ++axis) {
            const double sign = double(draw.sign());
            const double slope = draw.unit<double>();
            const double place = draw.centered<double>(0.5);
            if (cube) {
                d[axis] = sign * (0.5 + 0.5 * slope);
                o[axis] = place * fold[axis].width.high;
            } else if (axis == 1) {
                d[axis] = sign;
                o[axis] = fold[1].low.high + (0.5 + 0.5 * place) * fold[1].width.high;
            } else {
                d[axis] = 0.1 + 0.2 * slope;
                o[axis] = setup.factor * (0.1 * place - 0.35);
            }
        }
        origin = Vec3<Real>(o);
        direction = Vec3<Real>(normalized(d));
    }
};

// ---- closed solids: paths are reflected, and sometimes aimed at difficult places

/// How a line starts on a face.
enum class Start : uint32_t {
    as_rendered,
    on_face,  // the face itself is excluded; there is no other state
};

inline constexpr uint32_t path_length = 100;

/// Paths aimed at corners, edges and faces. Numbers: a point inside, and the radius around it that is inside, too.
struct BouncesInside {
    Start start;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const SceneView<Real>& scene = setup.scene;
        const bool convex = scene.solids[0].kind == SolidKind::convex;
        Draw draw = setup.draw(i);
        Ray<Real> ray;
        bool afresh = true;
        for (uint32_t n = 0; n < path_length; ++n) {
            const bool bounced = !afresh;
            if (afresh) ray = anew(setup, draw);
            afresh = true;
            const Hit<Real> hit = intersector.closest(ray);
            bool good = hit.found() && key_kind(hit.key) == CrossingKind::leave &&
                        !(ray.from_solid == 0 && key_face(hit.key) == ray.from_face);
            // By parity the start is inside, exactly: on a mesh without any memory of the face that it left.
            if (good && n % 16 == 15 && start == Start::as_rendered) {
                Ray<Real> line = ray;
                if (!convex) line.from_solid = no_solid;
                const Crossings crossings = cross_all(intersector, line);
                good = crossings.in_order && crossings.leaves == crossings.enters + 1;
            }
            if (good) {
                const Surface<Real> s = surface_at<Real, Effects<0>>(scene, ray, hit);
                good = !convex || within_box(scene, s.point);
                Vec3<Real> way = reflected(ray.direction, s.normal);
                const bool aim = draw.one_in(4);
                const Vec3<Real> target = setup.any_point(draw);
                const Vec3<Real> aimed_at = normalized(target - s.viewer_side);
                if (aim && dot(aimed_at, s.normal) > Real(0)) way = aimed_at;
                ray = leaving(start == Start::as_rendered ? s.viewer_side : s.point, way, hit, ray.media);
                if (start != Start::as_rendered) ray.after = {Real(0), 0};
                afresh = !good;
            }
            // In meshes, the way to the first face is tested by FirstLines.
            if (bounced || convex) tally.expect(good);
        }
    }

    /// A line that starts inside, on no face.
    template <class Real>
    CISTULA_HD static Ray<Real> anew(const Setup<Real>& setup, Draw& draw) {
        const Vec3<double> middle = setup.vector(0);
        const Vec3<Real> origin(middle + in_ball(draw) * setup.numbers[3]);
        const Vec3<Real> target = setup.any_point(draw), any(on_sphere(draw));
        return inside(ray_from(origin, draw.one_in(2) ? any : normalized(target - origin)), 0);
    }

  private:
    /// Whether a point is at most as far outside as the trees' boxes allow for: 64 u M (docs/rules.md, 1).
    template <class Real>
    CISTULA_HD static bool within_box(const SceneView<Real>& scene, const Vec3<Real>& point) {
        const Vec3<double> p(point);
        const double most = 64 * double(RealTraits<Real>::unit * scene.extent);
        bool within = true;
        for (uint32_t k = 0; k < scene.solids[0].slab_count; ++k) {
            const Slab<Real>& slab = scene.slabs[scene.solids[0].first_slab + k];
            const double at = dot(Vec3<double>(slab.normal), p);
            within = within && at <= double(slab.high) + most && at >= double(slab.low) - most;
        }
        return within;
    }
};

/// The usual epsilon method of other renderers: the nearest plane of a convex solid that the line leaves more than
/// 2^-16 M ahead.
template <class Real>
struct EpsilonIntersector {
    const SceneView<Real>& scene;

    CISTULA_HD Hit<Real> closest(const Ray<Real>& ray) const {
        Hit<Real> best;
        for (uint32_t k = 0; k < scene.solids[0].slab_count; ++k) {
            const Slab<Real>& slab = scene.slabs[scene.solids[0].first_slab + k];
            const Real slope = dot(slab.normal, ray.direction);
            const bool high = slope > Real(0);
            const Real t = ((high ? slab.high : slab.low) - dot(slab.normal, ray.origin)) / slope;
            if (t > Real(0x1p-16) * scene.extent && t < best.t)
                best = {t, make_key(CrossingKind::leave, 0, 2 * k + (high ? 1 : 0)), Real(0), Real(0), 0, false};
        }
        return best;
    }
};
struct BouncesByEpsilon {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        BouncesInside{Start::on_face}(setup, EpsilonIntersector<Real>{setup.scene}, i, tally);
    }
};

/// Lines that start inside a mesh on no face, as the camera's do and those that go straight on.
struct FirstLines {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Hit<Real> hit = intersector.closest(BouncesInside::anew(setup, draw));
        tally.expect(hit.found() && key_kind(hit.key) == CrossingKind::leave);
    }
};

/// Lengths of directions that are reflected again and again. Numbers: as for BouncesInside.
struct Lengths {
    bool renormalize;

    static constexpr double most = 1.76;  // ulps
    static constexpr uint32_t reflections = 1000;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> origin(setup.vector(0) + in_ball(draw) * setup.numbers[3]);
        Ray<Real> ray = inside(ray_from(origin, Vec3<Real>(on_sphere(draw))), 0);
        for (uint32_t n = 0; n < reflections; ++n) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) {
                tally.measure(RealTraits<double>::infinity);
                return;
            }
            const Surface<Real> s = surface_at<Real, Effects<0>>(setup.scene, ray, hit);
            Vec3<Real> way = reflected(ray.direction, s.normal);
            if (!renormalize) way = along(ray.direction, Real(-2) * dot(ray.direction, s.normal), s.normal);
            const double ulps = off_unit(Vec3<double>(way)) / (2 * double(RealTraits<Real>::unit));
            if (renormalize)
                tally.measure(ulps);
            else
                tally.expect(ulps <= most);
            ray = leaving(s.viewer_side, way, hit, ray.media);
        }
    }

  private:
    /// ||d| - 1|, up to its square.
    CISTULA_HD static double off_unit(const Vec3<double>& d) {
        const DoubleDouble square = two_product(d.x, d.x) + two_product(d.y, d.y) + two_product(d.z, d.z);
        return 0.5 * magnitude(double(square - DoubleDouble(1)));
    }
};

}  // namespace cistula::verify::mirrors
