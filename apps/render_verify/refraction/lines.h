// The straight lines of a light path, as the ray tree follows them, recorded by an intersector that notes its queries.
// For scenes in which every face transmits all light or, beyond the critical angle, reflects all.
#pragma once

#include "apps/render_verify/crossings.h"
#include "cistula/transport/ray_tree.h"

namespace cistula::verify::refraction {

template <class Real>
struct Lines {
    static constexpr int capacity = 12;

    Vec3<Real> origin[capacity], direction[capacity];
    double index[capacity];     // of the medium in which the line starts
    Hit<Real> first[capacity];  // the first hit, shaded or not
    InteriorList media[capacity];
    int count = 0;
    uint32_t flags = 0;  // RenderFlag bits
    bool cut = false;    // the path is longer than `capacity`

    CISTULA_HD bool whole() const { return flags == 0 && !cut; }
};

template <class Real, class Intersector>
struct Watched {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const Scene& scene;
    const Intersector& inner;
    Lines<Real>& lines;

    template <class E = Effects<all_effects>>
    CISTULA_HD Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = inner.closest(ray);
        const int last = lines.count - 1;
        const bool asked_before =
            last >= 0 && ray.origin == lines.origin[last] && ray.direction == lines.direction[last];
        if (!ray.fresh() || asked_before || lines.count == Lines<Real>::capacity) return hit;
        lines.origin[lines.count] = ray.origin;
        lines.direction[lines.count] = ray.direction;
        lines.index[lines.count] = index_of(scene, ray.media);
        lines.first[lines.count] = hit;
        lines.media[lines.count] = ray.media;
        ++lines.count;
        return hit;
    }
    template <class E>
    CISTULA_HD Throughput<Real, E> transmittance(const ShadowRay<Real>&) const {
        return Throughput<Real, E>(Real(0));
    }
};

/// An observer of the ray tree that records nothing.
struct Unnoted {
    template <class Hit, class Normal>
    CISTULA_HD void surface(const Hit&, const Normal&) const {}
};

/// Follows the ray's tree. Not inlined: every case calls it, and a tree is much code.
template <class Real, class Intersector>
CISTULA_NOINLINE void trace(const Setup<Real>& setup, const Intersector& intersector, const Ray<Real>& ray,
                            Lines<Real>& lines) {
    using Glass =
        Effects<effect_reflection | effect_transmission | effect_refraction | effect_insides | effect_contacts>;
    using Stack = StackOf<Real, Glass, InteriorList>;
    using Tree = RayTree<Real, Glass, Watched<Real, Intersector>, Stack>;
    TreeSettings settings;
    settings.depth = Lines<Real>::capacity;
    settings.fixed_scale = 0x1p62;
    settings.fixed_unit = 0x1p-62;
    PixelRecord record = PixelRecord();
    const struct {
        Vec3<Real> bound = Vec3<Real>(Real(1));
        Real largest_bound = Real(1);
    } any_scene;
    PixelSums<Real> sums(settings, any_scene, record, lines.flags);
    PixelRays rays;
    typename Stack::Storage storage;
    Stack stack(storage);
    lines.count = 0;
    const Watched<Real, Intersector> watched{setup.scene, intersector, lines};
    Tree(setup.scene, watched, settings.depth, sums, rays, stack).trace(ray, Unnoted());
    lines.cut = record.cut[0] != 0;
}

/// A material that transmits all light.
inline MaterialDescription glass(double index) {
    MaterialDescription material;
    material.transmission = 1;
    material.index = index;
    return material;
}

}  // namespace cistula::verify::refraction
