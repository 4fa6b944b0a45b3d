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
    IndexOf<Real> texture;
    IndexOf<Real> number;  // of the material
    const Material<ScalarOf<Real>>* all;

    /// Takes every part by take(part, its table, its value in a material).
    template <class E, class Take>
    CISTULA_INLINE void take_all(const Take& take, const ShadingTables<ScalarOf<Real>>& tables,
                                 const Material<ScalarOf<Real>>& from) {
        take(ambient, tables.ambient, from.ambient);
        if constexpr (E::has(effect_specular)) {
            take(specular, tables.specular, from.specular);
            take(integer_exponent, tables.integer_exponent, from.integer_exponent);
        }
        if constexpr (E::has(effect_diffuse)) take(diffuse, tables.diffuse, from.diffuse);
        take(local, tables.local, from.local);
        take(reflection, tables.reflection, from.reflection);
        if constexpr (E::has(effect_transmission)) take(filter, tables.filter, from.filter);
        if constexpr (E::has(effect_refraction)) {
            take(transmission, tables.transmission, from.transmission);
            take(tint, tables.tint, from.tint);
            take(fresnel, tables.fresnel, int(from.fresnel));
        }
        if constexpr (E::has(effect_texture)) take(texture, tables.texture, from.texture);
    }
};

template <class T, int n>
struct Surface<Lanes<T, n>> {
    using Real = Lanes<T, n>;
    Vec3<Real> point, normal, viewer_side, color;
    Vec3<Real> shading, mirrored;
    MaskOf<Real> smooth = false;
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
    for_each_value(shines, material.integer_exponent, [&](uint32_t exponent, const MaskOf<Real>& active) {
        if (int32_t(exponent) >= 0) {
            assign_where(active, result, elementary::power_by_squaring(base, int(exponent)));
        } else {
            for_each_lane(active, [&](int lane) {
                const Material<T>& own = material.all[material.number[lane]];
                result.set(lane, T(fractional_power(double(base[lane]), double(own.exponent))));
            });
        }
    });
    return result;
}

/// Where solids are of a set; no solid is.
template <class T, int n>
CISTULA_INLINE typename Lanes<T, n>::Mask among(const SolidSet& set, const Lanes<T, n>& solid) {
    if (!set.any) return false;
    if (set.each.size <= 31) return ((Lanes<T, n>(1) << (solid & 31)) & Lanes<T, n>(T(set.bits))) != 0;
    return entries_of(set.each, solid) != T(0);
}

/// The index of refraction around each ray.
template <class Scene, class T, int n>
CISTULA_INLINE Lanes<double, n> index_of(const Scene& scene, const LaneMedia<Lanes<T, n>>& media) {
    using Index = IndexOf<Lanes<T, n>>;
    Lanes<double, n> index(1.0);
    const Index medium = media.medium(scene);
    if (!scene.indices.empty() && scene.solids.size <= 31) {
        const auto is_inside = medium != Index(int(no_solid));
        for (const SolidsOfIndex& one : scene.indices)
            assign_where(widened(is_inside & among(one.solids, medium)), index, Lanes<double, n>(one.index));
        return index;
    }
    for_each_value(medium != Index(int(no_solid)), medium, [&](uint32_t solid, const auto& active) {
        assign_where(widened(active), index, Lanes<double, n>(scene.materials[scene.solids[solid].material].index));
    });
    return index;
}

template <class Scene, class T, int n>
CISTULA_INLINE void take_opaque_index(const Scene& scene, const LaneMaterial<Lanes<T, n>>& m,
                                      const MaskOf<Lanes<T, n>>& active, Lanes<double, n>& beyond) {
    if (!scene.has_opaque_fresnel) return;
    for_each_value(active, m.number, [&](uint32_t number, const MaskOf<Lanes<T, n>>& same) {
        const Material<T>& own = m.all[number];
        if (own.transparency == Transparency::opaque) assign_where(widened(same), beyond, Lanes<double, n>(own.index));
    });
}

/// Whether closed solids are opaque.
template <class Real, class T, int n>
CISTULA_INLINE auto is_opaque(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return !among(scene.transparent, solid);
}
template <class Real, class T, int n>
CISTULA_INLINE auto is_clear(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return among(scene.clear, solid);
}
template <class Real, class T, int n>
CISTULA_INLINE auto transmits(const LaneScene<Real>& scene, const Lanes<T, n>& solid) {
    return among(scene.transmitting, solid);
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

/// texture_uv(), where `active` holds; else 0. `balls`, `disks`: where such are hit.
template <class T, int n, class Scene>
CISTULA_INLINE Vec2<Lanes<T, n>> texture_uv(const Scene& scene, const Hit<Lanes<T, n>>& hit,
                                            const Vec3<Lanes<T, n>>& normal, const MaskOf<Lanes<T, n>>& balls,
                                            const MaskOf<Lanes<T, n>>& disks, const MaskOf<Lanes<T, n>>& active) {
    using Real = Lanes<T, n>;
    const MaskOf<Real> own = active & disks;
    Vec2<Real> uv(select(own, hit.u, Real(0)), select(own, hit.v, Real(0)));
    for_each_lane(active & balls, [&](int lane) {
        const Vec2<T> one = texture_uv(scene, lane_of(hit, lane), lane_of(normal, lane));
        for (int k = 0; k < 2; ++k) uv[k].set(lane, one[k]);
    });
    for_each_value(active & !balls & !disks, hit.slot, [&](uint32_t slot, const MaskOf<Real>& same) {
        const auto& cluster = scene.clusters[slot / cluster_lanes];
        const Solid& solid = scene.solids[cluster.solid];
        const Vec2<T>* of =
            scene.uvs.data + solid.first_uv + 3 * (cluster.triangle[slot % cluster_lanes] - solid.first_triangle);
        for (int k = 0; k < 2; ++k)
            assign_where(same, uv[k],
                         Real(of[0][k]) * (Real(1) - hit.u - hit.v) + Real(of[1][k]) * hit.u + Real(of[2][k]) * hit.v);
    });
    return uv;
}

/// repeated() in lanes.
template <class T, int n>
CISTULA_INLINE IndexOf<Lanes<T, n>> repeated(const Lanes<T, n>& i, uint32_t size) {
    using Real = Lanes<T, n>;
    const Real sizes(static_cast<T>(size)), last(static_cast<T>(size - 1));
    if (all(magnitude(i) < Real(T(0x1p23)))) return whole_of(clamped(i - floor_of(i / sizes) * sizes, Real(0), last));
    LaneArray<Real> all(i);
    LaneArray<IndexOf<Real>> rests;
    for (int lane = 0; lane < n; ++lane) rests.of[lane] = int32_t(any_remainder(all.of[lane], size));
    return rests.all();
}
/// Texels in lanes.
template <class Real>
requires in_lanes<Real> CISTULA_INLINE Vec3<Real> texel_at(const Vec3<float>* texels, const Texture& texture,
                                                           const IndexOf<Real>& column, const IndexOf<Real>& row) {
    return vectors_at<3>(&texels->x, row * IndexOf<Real>(int(texture.width)) + column);
}

/// Finds the surfaces of hits in the lanes of `active`; others hold arbitrary numbers, but the first material.
template <class E, class T, int n, class Media, class Scene>
CISTULA_INLINE void surfaces_at(const Scene& scene, const Ray<Lanes<T, n>, Media>& ray, const Hit<Lanes<T, n>>& hit,
                                const MaskOf<Lanes<T, n>>& active, Surface<Lanes<T, n>>& s) {
    using Real = Lanes<T, n>;
    using Index = IndexOf<Real>;
    const Index solids = key_solid(hit.key);
    const Index faces = key_face(hit.key);
    s.point = s.viewer_side = along(ray.origin, hit.t, ray.direction);
    s.viewer_media = ray.media;
    s.material.all = scene.materials.data;
    s.material.number = s.material.integer_exponent = 0;  // read in all lanes
    Index first_slab = 0;
    Index form = form_triangles;
    if (scene.solids.size <= native::table_entries<sizeof(T)>) {
        s.material.number = looked_up(scene.tables.material, solids);
        if constexpr (E::solids) {
            form = looked_up(scene.tables.form, solids);
            first_slab = looked_up(scene.tables.first_slab, solids);
        }
    } else {
        LaneArray<Index> place(masked(active, solids)), material, forms, slabs;
        for (int lane = 0; lane < n; ++lane) {
            const SolidShading& own = scene.shading[uint32_t(place.of[lane])];
            material.of[lane] = own.material;
            forms.of[lane] = own.form;
            slabs.of[lane] = own.first_slab;
        }
        s.material.number = masked(active, material.all());
        form = forms.all();
        first_slab = slabs.all();
    }
    const auto take_all = [&](const Material<T>& material, const auto& take) {
        s.material.template take_all<E>(take, scene.tables, material);
        take(s.color, scene.tables.color, material.color);
    };
    if (scene.materials.size <= native::table_entries<sizeof(T)>)
        take_all(scene.materials[0],
                 [&](auto& to, const auto& table, const auto&) { to = looked_up(table, s.material.number); });
    else
        for_each_value(active, s.material.number, [&](uint32_t number, const MaskOf<Real>& same) {
            take_all(scene.materials[number], [&]<class To>(To& to, const auto&, const auto& value) {
                if constexpr (std::is_same_v<To, Vec3<Real>>)
                    assign_where(same, to, spread<Real>(value));
                else
                    assign_where(same, to, To(value));
            });
        });
    const MaskOf<Real> convex = active & (form == Index(form_slabs));
    if (any(convex)) {
        const Vec3<Real> normal = vectors_at<sizeof(Slab<T>) / sizeof(T)>(&scene.slabs.data->normal.x,
                                                                          masked(convex, first_slab + (faces >> 1)));
        const MaskOf<Real> high = (faces & 1) != 0;
        const MaskOf<Real> outward = (high & hit.enters) | !(high | hit.enters);
        assign_where(convex, s.normal, select(outward, normal, -normal));
    }
    MaskOf<Real> balls = false;
    if constexpr (E::has(effect_spheres)) balls = active & (form == Index(form_ball));
    if (any(balls)) {
        constexpr int stride = sizeof(Ball<T>) / sizeof(T);
        const Index places = masked(balls, first_slab);
        const Vec3<Real> center = vectors_at<stride>(&scene.balls.data->center.x, places);
        const Real radius = vectors_at<stride>(&scene.balls.data->center.y, places).z;  // it follows the center
        const Vec3<Real> normal = ball_normal(center, ray, hit.t);
        assign_where(balls, s.normal, select(hit.enters, normal, -normal));
        assign_where(balls, s.point, along(center, radius, normal));
        assign_where(balls, s.viewer_side, s.point);
    }
    MaskOf<Real> disks = false;
    if constexpr (E::has(effect_planes)) disks = active & (form == Index(form_disk));
    for_each_value(disks, first_slab, [&](uint32_t disk, const MaskOf<Real>& same) {
        const Vec3<Real> normal = spread<Real>(scene.shared_planes[scene.disks[disk].plane].normal);
        assign_where(same, s.normal, select(hit.enters, normal, -normal));
    });
    if constexpr (E::triangles) {
        for_each_value(active & !convex & !balls & !disks, hit.slot, [&](uint32_t slot, const MaskOf<Real>& same) {
            Vec3<T> corner[3];
            triangle_corners(scene, slot, corner);
            const Vec3<Real> first = spread<Real>(corner[0]);
            const Vec3<Real> point = along(along(first, hit.u, spread<Real>(corner[1] - corner[0])), hit.v,
                                           spread<Real>(corner[2] - corner[0]));
            const Vec3<Real> normal = spread<Real>(scene.sides[slot].normal);
            const Vec3<Real> toward = select(hit.enters, normal, -normal);
            assign_where(same, s.normal, toward);
            assign_where(same, s.point, point);
            if (E::has(effect_spheres) && is_sheet_near_ball(scene.solids[scene.clusters[slot / cluster_lanes].solid]))
                assign_where(same, s.viewer_side, off_sheet(scene.extent, ray, hit.t, toward));
            else
                assign_where(same, s.viewer_side, off_triangle(scene, slot, hit.enters, point));
            if constexpr (E::has(effect_smooth))
                if (const Vec3<T>* normals = corner_normals(scene, slot)) {
                    assign_where(same, s.shading, normal_between(normals, hit));
                    s.smooth |= same;
                }
        });
    }
    if (E::has(effect_smooth) && any(s.smooth)) {
        Vec3<Real> shading = normalized(s.shading);
        bend_normal(ray.direction, s.normal, shading, s.mirrored);
        s.shading = select(s.smooth, shading, s.normal);
    } else {
        s.shading = s.normal;
    }
    if constexpr (E::has(effect_texture)) {
        const MaskOf<Real> textured = active & !convex & (s.material.texture >= Index(0));
        for_each_value(textured, s.material.texture, [&](uint32_t texture, const MaskOf<Real>& same) {
            const Vec2<Real> uv = texture_uv(scene, hit, s.normal, balls, disks, same);
            assign_where(same, s.color, s.color * texture_at(scene, scene.textures[texture], uv));
        });
    }
}

/// The origins of rays that are refracted into the other side of their faces.
template <class E, class T, int n, class Scene>
CISTULA_INLINE Vec3<Lanes<T, n>> far_side(const Scene& scene, const Hit<Lanes<T, n>>& hit,
                                          const MaskOf<Lanes<T, n>>& active, const Vec3<Lanes<T, n>>& point) {
    using Real = Lanes<T, n>;
    Vec3<Real> start = point;
    if constexpr (E::triangles)
        for_each_value(active, key_solid(hit.key), [&](uint32_t index, const MaskOf<Real>& same) {
            if (is_convex<E>(scene.solids[index])) return;
            for_each_value(same, hit.slot, [&](uint32_t slot, const MaskOf<Real>& there) {
                assign_where(there, start, off_triangle(scene, slot, !hit.enters, point));
            });
        });
    return start;
}

}  // namespace cistula
