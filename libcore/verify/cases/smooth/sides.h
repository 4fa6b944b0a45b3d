// Rays on smooth faces: on which side of them mirrored and bent ones go.
#pragma once

#include "cistula/shading/interface.h"
#include "verify/setup.h"

namespace cistula::verify::smooth {

/// A ray that meets a smooth mesh from outside or from inside, as flat over the face as rounding tells apart: its
/// mirrored ray stays on its side, its bent one does not, and their shares are Fresnel's.
struct Sides {
    /// Whether the normals between corners are taken as they are, as a negative control.
    bool raw;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        using All = Effects<all_effects>;
        Draw draw = setup.draw(i);
        const Vec3<Real> origin(on_sphere(draw) * 3.0 * setup.factor);
        Ray<Real> ray =
            ray_from(origin, Vec3<Real>(normalized(on_sphere(draw) * 0.6 * setup.factor - Vec3<double>(origin))));
        Hit<Real> hit = intersector.closest(ray);
        if (!hit.found()) return;
        hit.enters = draw.below(2) == 0;
        const Vec3<double> face(normal_at<All>(setup.scene, ray, hit));
        Vec3<double> beside = on_sphere(draw);
        beside = normalized(beside - dot(beside, face) * face);
        const double flat = elementary::power_of_two(-int(draw.below(sizeof(Real) == 4 ? 30 : 60)));
        ray.direction = Vec3<Real>(normalized(beside - face * (flat * (0.5 + draw.unit<double>()))));
        Surface<Real> s = surface_at<Real, All>(setup.scene, ray, hit);
        if (!s.smooth) return;
        if (raw) {
            s.shading = normalized(normal_between(corner_normals(setup.scene, hit.slot), hit));
            s.mirrored = reflected(ray.direction, s.shading);
        }
        InteriorList inside;
        inside.add(0, 1);
        const InteriorList before = hit.enters ? InteriorList() : inside;
        const InteriorList beyond = hit.enters ? inside : InteriorList();
        const InterfaceSplit<Real> split =
            split_at<Real, All>(setup.scene, setup.scene.materials[s.material], ray.direction, s.shading, before,
                                beyond, false, s.normal, s.smooth);
        const Real share = split.reflection + split.filter.x;
        const Real unit = RealTraits<Real>::unit;
        tally.expect(dot(s.mirrored, s.normal) > Real(0) &&
                     magnitude(dot(s.mirrored, s.mirrored) - Real(1)) < 16 * unit &&
                     dot(ray.direction, s.shading) < Real(0) && split.bends &&
                     (split.total || dot(split.through, s.normal) < Real(0)) && split.reflection >= Real(0) &&
                     split.filter.x >= Real(0) && magnitude(share - Real(1)) <= 4 * unit);
        tally.witness(split.total);
    }
};

}  // namespace cistula::verify::smooth
