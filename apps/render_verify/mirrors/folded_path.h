// Closed form of paths between axis-parallel mirrors: with the mirrors unfolded, the path is straight. Each coordinate
// after a length T is the triangle wave of o + T d; in d only signs change.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"
#include "cistula/numerics/double_double.h"
#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"

namespace cistula::verify::mirrors {

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

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
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
        return parity::no_number<double>;
    }

    /// A random start. In a cube, no component of the direction is below about a third of the others' length; between
    /// two mirrors the line moves along them from one side of their center to the other.
    template <class Real>
    CISTULA_HD static void start(const Setup<Real>& setup, Draw& draw, bool cube, const Fold (&fold)[3],
                                 Vec3<Real>& origin, Vec3<Real>& direction) {
        Vec3<double> o, d;
        for (int axis = 0; axis < 3; ++axis) {
            const double sign = double(draw.sign());
            const double slope = draw.unit<double>(), place = draw.centered<double>(0.5);
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

}  // namespace cistula::verify::mirrors
