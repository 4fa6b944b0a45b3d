// Surfaces and materials of lanes, gathered from the scene by the numbers in the hits.
#pragma once

#include "cistula/lanes/lane_hit.h"
#include "cistula/shading/interface.h"
#include "cistula/shading/phong.h"
#include "cistula/shading/surface.h"

namespace cistula {

/// The part of Material that shading reads, for each lane.
template <class Real>
struct LaneMaterial {
    Vec3<Real> ambient, specular;
    Real diffuse, local, reflection, transmission;
    IndexOf<Real> integer_exponent;
    Vec3<Real> filter, tint;
    IndexOf<Real> fresnel;
    IndexOf<Real> number;  // of the material
    const Material<ScalarOf<Real>>* all;

    /// Sets the lanes where `who` holds.
    template <class E>
    CISTULA_INLINE void take(const MaskOf<Real>& who, const Material<ScalarOf<Real>>& from) {
        assign_where(who, ambient, spread<Real>(from.ambient));
        if constexpr (E::has(effect_specular)) {
            assign_where(who, specular, spread<Real>(from.specular));
            assign_where(who, integer_exponent, IndexOf<Real>(from.integer_exponent));
        }
        if constexpr (E::has(effect_diffuse)) assign_where(who, diffuse, Real(from.diffuse));
        assign_where(who, local, Real(from.local));
        assign_where(who, reflection, Real(from.reflection));
        if constexpr (E::has(effect_transmission)) assign_where(who, filter, spread<Real>(from.filter));
        if constexpr (E::has(effect_refraction)) {
            assign_where(who, transmission, Real(from.transmission));
            assign_where(who, tint, spread<Real>(from.tint));
            assign_where(who, fresnel, IndexOf<Real>(int(from.fresnel)));
        }
    }
};

template <class T, int n>
struct Surface<Lanes<T, n>> {
    using Real = Lanes<T, n>;
    Vec3<Real> point, normal, viewer_side, color;
    LaneMedia<Real> viewer_media;  // around viewer_side
    LaneMaterial<Real> material;
};
template <class Scene, class T, int n>
CISTULA_INLINE const LaneMaterial<Lanes<T, n>>& material_of(const Scene&, const Surface<Lanes<T, n>>& s) {
    return s.material;
}

template <class T, int n>
CISTULA_INLINE Lanes<T, n> highlight(const LaneMaterial<Lanes<T, n>>& material, Lanes<T, n> cosine) {
    using Real = Lanes<T, n>;
    const MaskOf<Real> shines = cosine > Real(0);
    Real result = select(material.integer_exponent == 0, Real(1), Real(0));
    if (!any(shines)) return result;
    const Real base = min_or_second(cosine, Real(1));
    for_each_value(shines, material.integer_exponent, [&](uint32_t exponent, const MaskOf<Real>& who) {
        if (int32_t(exponent) >= 0) {
            assign_where(who, result, elementary::power_by_squaring(base, int(exponent)));
        } else {
            for_each_lane(who, [&](int lane) {
                const Material<T>& own = material.all[material.number[lane]];
                result.set(lane, T(fractional_power(double(base[lane]), double(own.exponent))));
            });
        }
    });
    return result;
}

/// The index of refraction around each ray.
template <class Scene, class T, int n>
CISTULA_INLINE Lanes<double, n> index_of(const Scene& scene, const LaneMedia<Lanes<T, n>>& media) {
    Lanes<double, n> index(1.0);
    const IndexOf<Lanes<T, n>> transparent = media.transparent(scene);
    for_each_value(transparent != 0, transparent, [&](uint32_t set, const auto& who) {
        const Solid& medium = scene.solids[InteriorSet{set}.highest()];
        assign_where(widened(who), index, Lanes<double, n>(scene.materials[medium.material].index));
    });
    return index;
}

template <class T, int n>
CISTULA_INLINE void take_opaque_index(const LaneMaterial<Lanes<T, n>>& m, const MaskOf<Lanes<T, n>>& who,
                                      Lanes<double, n>& beyond) {
    for_each_value(who, m.number, [&](uint32_t number, const MaskOf<Lanes<T, n>>& same) {
        const Material<T>& own = m.all[number];
        if (own.transparency == Transparency::opaque) assign_where(widened(same), beyond, Lanes<double, n>(own.index));
    });
}

/// Whether closed solids are opaque.
template <class Real, class T, int n>
CISTULA_INLINE auto is_opaque(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return (Lanes<T, n>(int(scene.transparent)) & Lanes<T, n>(1) << (solid & 31)) == T(0);
}
template <class Real, class T, int n>
CISTULA_INLINE auto is_clear(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return entries_of(scene.clear_solids, solid) != T(0);
}
template <class Real, class T, int n>
CISTULA_INLINE auto transmits(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return entries_of(scene.transmitting, solid) != T(0);
}

/// The origins of rays that leave from points on a triangle, on its outside or its inside (Apex::from).
template <class T, int n, class Scene>
CISTULA_INLINE Vec3<Lanes<T, n>> off_triangle(const Scene& scene, uint32_t slot, const MaskOf<Lanes<T, n>>& outside,
                                              const Vec3<Lanes<T, n>>& point) {
    using Real = Lanes<T, n>;
    const auto start = [&](const Apex<T>& apex) {
        return along(point, Real(apex.share), spread<Real>(apex.place) - point);
    };
    const auto& apex = scene.sides[slot].apex;
    return select(outside, start(apex[1]), start(apex[0]));
}

/// Finds the surfaces of hits in the lanes of `who`; others hold arbitrary numbers, but the first material.
template <class E, class T, int n, class Media, class Scene>
CISTULA_INLINE void surfaces_at(const Scene& scene, const Ray<Lanes<T, n>, Media>& ray, const Hit<Lanes<T, n>>& hit,
                                const MaskOf<Lanes<T, n>>& who, Surface<Lanes<T, n>>& s) {
    using Real = Lanes<T, n>;
    using Index = IndexOf<Real>;
    const Index solids = key_solid(hit.key), faces = key_face(hit.key);
    s.point = s.viewer_side = along(ray.origin, hit.t, ray.direction);
    s.viewer_media = ray.media;
    s.material.all = scene.materials.data;
    s.material.number = s.material.integer_exponent = 0;  // read in all lanes
    Index slab = 0;
    MaskOf<Real> convex = false;
    for_each_value(who, solids, [&](uint32_t index, const MaskOf<Real>& same) {
        const Solid& solid = scene.solids[index];
        const Material<T>& material = scene.materials[solid.material];
        s.material.template take<E>(same, material);
        assign_where(same, s.material.number, Index(int(solid.material)));
        assign_where(same, s.color, spread<Real>(material.color));
        if (is_convex<E>(solid)) {
            convex |= same;
            assign_where(same, slab, Index(int(solid.first_slab)) + (faces >> 1));
        }
    });
    if (any(convex)) {
        LaneVectors<Real> normals;
        LaneArray<Index> slabs(slab);
        for (int lane = 0; lane < n; ++lane) normals.set(lane, scene.slabs[uint32_t(slabs.of[lane])].normal);
        const Vec3<Real> normal = normals.all();
        const MaskOf<Real> high = (faces & 1) != 0, outward = (high & hit.enters) | !(high | hit.enters);
        assign_where(convex, s.normal, select(outward, normal, -normal));
    }
    if constexpr (E::triangles) {
        for_each_value(who & !convex, hit.slot, [&](uint32_t slot, const MaskOf<Real>& same) {
            Vec3<T> corner[3];
            triangle_corners(scene, slot, corner);
            const Vec3<Real> first = spread<Real>(corner[0]);
            const Vec3<Real> point = along(along(first, hit.u, spread<Real>(corner[1] - corner[0])), hit.v,
                                           spread<Real>(corner[2] - corner[0]));
            const Vec3<Real> normal = spread<Real>(scene.sides[slot].normal);
            assign_where(same, s.normal, select(hit.enters, normal, -normal));
            assign_where(same, s.point, point);
            assign_where(same, s.viewer_side, off_triangle(scene, slot, hit.enters, point));
        });
    }
    if constexpr (E::has(effect_texture)) {
        for_each_value(who, s.material.number, [&](uint32_t number, const MaskOf<Real>& same) {
            const int32_t texture = scene.materials[number].texture;
            if (texture < 0) return;
            LaneVectors<Real> colors(s.color);
            for_each_lane(same & !convex, [&](int lane) {
                Hit<T> one;
                one.key = KeyFormat<Real>::of_lane(hit.key, lane);
                one.u = hit.u[lane];
                one.v = hit.v[lane];
                colors.set(lane,
                           colors[lane] * texture_at(scene, scene.textures[uint32_t(texture)], texture_uv(scene, one)));
            });
            s.color = colors.all();
        });
    }
}

/// The origins of rays that are refracted into the other side of their faces.
template <class E, class T, int n, class Scene>
CISTULA_INLINE Vec3<Lanes<T, n>> far_side(const Scene& scene, const Hit<Lanes<T, n>>& hit,
                                          const MaskOf<Lanes<T, n>>& who, const Vec3<Lanes<T, n>>& point) {
    using Real = Lanes<T, n>;
    Vec3<Real> start = point;
    if constexpr (E::triangles)
        for_each_value(who, key_solid(hit.key), [&](uint32_t index, const MaskOf<Real>& same) {
            if (is_convex<E>(scene.solids[index])) return;
            for_each_value(same, hit.slot, [&](uint32_t slot, const MaskOf<Real>& there) {
                assign_where(there, start, off_triangle(scene, slot, !hit.enters, point));
            });
        });
    return start;
}

}  // namespace cistula
