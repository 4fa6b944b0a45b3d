// The intersector of the CPU backend: Embree traverses its tree over user geometry with a float ray, and libcore's
// primitive tests decide in Real.
#pragma once

#include "backend_embree/embree/embree_api.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

/// The context of a closest-hit query, which Embree passes to the callbacks. `context` must stay first.
template <class Real>
struct ClosestQuery {
    EmbreeContext context;
    const SceneView<Real>* scene;
    const Ray<Real>* ray;
    TriangleRay<Real> triangle_ray;
    Hit<Real> best;
};

/// The context of a shadow query. `visit` adds one primitive to the sum and tells whether no light is left.
template <class Real>
struct ShadowQuery {
    EmbreeContext context;
    const SceneView<Real>* scene;
    const ShadowRay<Real>* shadow;
    TriangleRay<Real> triangle_ray;
    bool (*visit)(ShadowQuery&, uint32_t primitive);
};
/// ShadowQuery for the effects compiled into the caller.
template <class Real, class E>
struct SummedShadowQuery : ShadowQuery<Real> {
    ShadowSum<E> sum;
};

template <class Real>
void set_ray(RTCRay& out, const Ray<Real>& ray, float near_t, float far_t) {
    out.org_x = float(ray.origin.x);
    out.org_y = float(ray.origin.y);
    out.org_z = float(ray.origin.z);
    out.dir_x = float(ray.direction.x);
    out.dir_y = float(ray.direction.y);
    out.dir_z = float(ray.direction.z);
    out.tnear = near_t;
    out.tfar = far_t;
    out.time = 0.0f;
    out.mask = ~0u;
    out.id = 0;
    out.flags = 0;
}

/// Traverses the tree: on_intersect is called for primitives that the ray may meet after ray.after, up to far_t.
template <class Real>
void traverse_closest(RTCScene tree, EmbreeContext& context, const Ray<Real>& ray, float far_t) {
    RTCRayHit rayhit;
    set_ray(rayhit.ray, ray, tree_near(ray.after.t), far_t);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(tree, context, rayhit);
}

/// Traverses the tree: on_occluded is called for primitives that may lie before the light.
template <class Real>
void traverse_shadow(RTCScene tree, EmbreeContext& context, const ShadowRay<Real>& shadow) {
    RTCRay ray;
    set_ray(ray, shadow.ray, 0.0f, tree_far(shadow.distance));
    embree_occluded(tree, context, ray);
}

template <class Real>
struct EmbreeIntersector {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const SceneView<Real>& scene;
    RTCScene tree;

    template <class = Effects<all_effects>>  // no effect changes the closest hit
    Hit<Real> closest(const Ray<Real>& ray) const {
        ClosestQuery<Real> query;
        query.best = Hit<Real>();
        if (!is_finite(ray) || closest_enclosed(scene, ray, query.best)) return query.best;
        embree_init(query.context);
        query.scene = &scene;
        query.ray = &ray;
        query.triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        closest_disk<Effects<all_effects>>(scene, true, ray, query.best);
        traverse_closest(tree, query.context, ray, tree_far(query.best.t));
        return query.best;
    }

    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if (!is_finite(shadow.ray)) return Throughput<Real, E>(Real(0));
        using Query = SummedShadowQuery<Real, E>;
        Query query;
        embree_init(query.context);
        query.scene = &scene;
        query.shadow = &shadow;
        query.triangle_ray = TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction);
        query.visit = [](ShadowQuery<Real>& q, uint32_t primitive) {
            ShadowSum<E>& sum = static_cast<Query&>(q).sum;
            shadow_primitive<Real, E>(*q.scene, primitive, *q.shadow, q.triangle_ray, sum);
            return sum.is_blocked();
        };
        shadow_start<Real, E>(scene, shadow, query.sum);
        traverse_shadow(tree, query.context, shadow);
        return query.sum.template transmittance<Real>(scene);
    }

    /// The RTCIntersectFunctionN of the only user geometry.
    static void on_intersect(const RTCIntersectFunctionNArguments* arguments) {
        if (!arguments->valid[0]) return;
        auto& query = *reinterpret_cast<ClosestQuery<Real>*>(arguments->context);
        const uint64_t before = query.best.key;
        closest_primitive(*query.scene, arguments->primID, *query.ray, query.triangle_ray, query.best);
        if (query.best.key == before) return;
        auto* rayhit = reinterpret_cast<RTCRayHit*>(arguments->rayhit);
        rayhit->ray.tfar = tree_far(query.best.t);
        rayhit->hit.geomID = arguments->geomID;
    }

    /// The RTCOccludedFunctionN of the only user geometry. It sums all crossings, so it reports an occlusion only once
    /// every channel is blocked.
    static void on_occluded(const RTCOccludedFunctionNArguments* arguments) {
        if (!arguments->valid[0]) return;
        auto& query = *reinterpret_cast<ShadowQuery<Real>*>(arguments->context);
        if (query.visit(query, arguments->primID))
            reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -RealTraits<float>::infinity;
    }
};

}  // namespace cistula
