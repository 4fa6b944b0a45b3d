// An approximate intersector over Embree's own triangles, where floats decide the hits. For previews, and to measure
// what exact intersection costs. It uses the state of a ray where a comparison suffices: a ray does not hit the face
// that it leaves, and enters a solid only from outside and leaves it only from inside. It does nothing else about
// rounding: rays may slip through an edge or hit both faces there.
#pragma once

#include "backend_embree/embree/embree_intersector.h"
#include "backend_embree/native/native_triangles.h"

namespace cistula {

/// Whether a hit lies at the ray's origin: on the face that it leaves, on the same flat sheet, on the outside of the
/// same convex solid, or, for triangles, within the rounding of Embree's floats of any face. (Convex solids have no
/// such margin: near an edge, a ray inside would miss the adjacent face.)
template <class Real>
bool leaves_behind(const SceneView<Real>& scene, const Ray<Real>& ray, const NativeTriangle& triangle, Real t) {
    if (ray.from_solid == no_solid) return false;
    const Solid& solid = scene.solids[triangle.solid];
    const bool convex = solid.kind == SolidKind::convex;
    if (!convex && t <= Real(incidence<float>) * scene.extent) return true;
    if (ray.from_solid != triangle.solid) return false;
    return ray.from_face == triangle.face || solid.flat != 0 || (convex && !ray.media.contains(triangle.solid));
}

/// The context of a closest-hit query; `context` must stay first.
template <class Real>
struct NativeClosest {
    EmbreeContext context;
    const SceneView<Real>& scene;
    const Ray<Real>& ray;
    Hit<Real> best;

    /// Takes a hit that Embree found if it is the ray's next so far.
    bool take(const NativeTriangle& triangle, const RTCHit& hit, Real t, bool enters) {
        if (leaves_behind(scene, ray, triangle, t)) return false;
        const SolidKind solid = scene.solids[triangle.solid].kind;
        CrossingKind kind = enters ? CrossingKind::enter : CrossingKind::leave;
        if (solid == SolidKind::sheet)
            kind = CrossingKind::sheet;
        else if ((solid == SolidKind::convex || ray.by_side()) && enters == ray.media.contains(triangle.solid))
            return false;
        const uint64_t key = make_key(kind, triangle.solid, triangle.face);
        if (!ray.after.before(t, key) || !best.improves(t, key)) return false;
        best.take(true, t, key, Real(hit.u), Real(hit.v), triangle.slot, enters);
        return true;
    }
};

/// The context of a shadow query, which gets all hits before the light in any order.
template <class Real>
struct NativeShadow {
    EmbreeContext context;
    const SceneView<Real>& scene;
    const ShadowRay<Real>& shadow;
    bool (*visit)(NativeShadow&, const NativeTriangle&, Real t, bool enters);  // tells whether all light is blocked
};
template <class Real, class E>
struct SummedNativeShadow : NativeShadow<Real> {
    using NativeShadow<Real>::scene, NativeShadow<Real>::shadow;
    ShadowSum<E> sum{};

    void add(const NativeTriangle& triangle, Real t, bool enters) {
        const Ray<Real>& ray = shadow.ray;
        if (!(t < shadow.distance) || leaves_behind(scene, ray, triangle, t)) return;
        if (lies_on(scene, *shadow.light, triangle.solid, triangle.face)) return;
        const Solid& solid = scene.solids[triangle.solid];
        if (solid.kind == SolidKind::convex && enters && ray.media.contains(triangle.solid)) return;
        const Material<Real>& material = scene.materials[solid.material];
        sum.cross(material);
        if constexpr (E::has(effect_absorption))
            if (solid.kind != SolidKind::sheet)
                sum.absorb_rest(material, shadow.distance, t, enters ? 1 : -1, scene.extent);
    }

    /// Adds the absorption of solids that contain the ray's origin.
    void start() {
        if constexpr (E::has(effect_absorption))
            shadow.ray.media.for_each([&](uint32_t index, int count) {
                for (int n = 0; n != count; n += count > 0 ? 1 : -1)
                    sum.absorb_rest(scene.materials[scene.solids[index].material], shadow.distance, Real(0),
                                    count > 0 ? 1 : -1, scene.extent);
            });
    }
};

template <class Real>
struct NativeIntersector {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const SceneView<Real>& scene;
    RTCScene tree;

    template <class = Effects<all_effects>>  // no effect changes the closest hit
    Hit<Real> closest(const Ray<Real>& ray) const {
        NativeClosest<Real> query{{}, scene, ray, {}};
        if (!is_finite(ray)) return query.best;
        embree_init(query.context);
        traverse_closest(tree, query.context, ray);
        return query.best;
    }

    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if (!is_finite(shadow.ray)) return Throughput<Real, E>(Real(0));
        using Query = SummedNativeShadow<Real, E>;
        Query query{{{}, scene, shadow, [](NativeShadow<Real>& q, const NativeTriangle& triangle, Real t, bool enters) {
                         auto& own = static_cast<Query&>(q);
                         own.add(triangle, t, enters);
                         return own.sum.is_blocked();
                     }}};
        embree_init(query.context);
        query.start();
        traverse_shadow(tree, query.context, shadow);
        return query.sum.template transmittance<Real>(scene);
    }

    /// The RTCFilterFunctionN of rtcIntersect1: a refused hit does not end the search.
    static void on_intersect(const RTCFilterFunctionNArguments* arguments) {
        if (!arguments->valid[0]) return;
        auto& query = *reinterpret_cast<NativeClosest<Real>*>(arguments->context);
        const Found found(arguments);
        if (!query.take(found.triangle, found.hit, found.t, found.enters())) arguments->valid[0] = 0;
    }

    /// The RTCFilterFunctionN of rtcOccluded1. It sums all hits, so it reports an occlusion only once every channel is
    /// blocked.
    static void on_occluded(const RTCFilterFunctionNArguments* arguments) {
        if (!arguments->valid[0]) return;
        auto& query = *reinterpret_cast<NativeShadow<Real>*>(arguments->context);
        const Found found(arguments);
        if (!query.visit(query, found.triangle, found.t, found.enters())) arguments->valid[0] = 0;
    }

  private:
    struct Found {
        const RTCRay& ray;
        const RTCHit& hit;
        const NativeTriangle& triangle;
        Real t;

        explicit Found(const RTCFilterFunctionNArguments* arguments)
            : ray(*reinterpret_cast<const RTCRay*>(arguments->ray)),
              hit(*reinterpret_cast<const RTCHit*>(arguments->hit)),
              triangle(static_cast<const NativeTriangle*>(arguments->geometryUserPtr)[hit.primID]),
              t(Real(ray.tfar)) {}
        bool enters() const { return hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z < 0.0f; }
    };
};

}  // namespace cistula
