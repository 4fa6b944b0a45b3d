// Rays that belong to no frame: what each meets first, and the share of light that passes between two points. For host
// and device.
#pragma once

#include "cistula/transport/pixel.h"

namespace cistula {

/// A ray from `origin` in the unit direction `toward`, or the segment from `origin` to `toward`; in the scene's frame.
struct RayQuestion {
    Vec3<double> origin, toward;
};

/// The first crossing of a ray, in the scene's frame.
struct RayAnswer {
    double t = RealTraits<double>::infinity;  // from the question's origin; NaN: that is inside too many solids
    Vec3<double> point = Vec3<double>(0.0);
    Vec3<double> normal = Vec3<double>(0.0);
    Vec2<double> uv = Vec2<double>(0.0, 0.0);
    uint32_t solid = no_solid;
    uint32_t face = 0;
    uint32_t material = 0;
    CrossingKind crossing = CrossingKind::sheet;
};

inline constexpr double no_answer = __builtin_nan("");

/// The effects of queries: all but the textures' colors.
using QueryEffects = Effects<all_effects & ~effect_texture>;

/// Sets up a ray, all but the solids around its origin (camera_solids). `start`: how far from the question's origin it
/// starts. False if it comes from beyond the scene and meets nothing.
template <class Real, class Scene>
CISTULA_HD inline bool begin_ray(const Scene& scene, const RayQuestion& question, Ray<Real>& ray, double& start) {
    Vec3<double> origin = question.origin;
    ray = Ray<Real>();
    start = 0;
    if (is_far(origin, double(scene.extent)) && !begin_from_afar(scene, question.toward, origin, ray, start))
        return false;
    place(ray, origin, question.toward);
    return true;
}

/// Sets up a segment as a shadow ray, all but the solids around its start. A light of the scene on faces of solids is
/// that light where a segment ends on it, to within as much as it was moved onto them (docs/rules.md, 5); other
/// segments end on `nowhere`. False if there is nothing between the ends.
template <class Real, class Scene>
CISTULA_HD inline bool begin_segment(const Scene& scene, const RayQuestion& question, const Light<Real>& nowhere,
                                     ShadowRay<Real>& shadow) {
    const Vec3<double> way = question.toward - question.origin;
    const double distance = length(way);
    double start = 0;
    if (!(distance > 0) || !begin_ray(scene, {question.origin, way / distance}, shadow.ray, start)) return false;
    Light<Real> end = nowhere;
    end.position = Vec3<Real>(question.toward);
    shadow.light = &nowhere;
    const Real near = 4 * incidence<Real> * scene.extent;
    for (const Light<Real>& light : scene.lights)
        if (light.incident_count != 0 && length(light.position - end.position) <= near) {
            shadow.light = &light;
            end.position = light.position;
        }
    if (start >= distance && has_disks(scene)) {  // it ends before the sphere that its line enters
        shadow.ray.after.t = -1;
        place(shadow.ray, question.origin, way / distance);
        start = 0;
    }
    const LightAim<Real> aim = LightAim<Real>::of(end, shadow.ray.origin, Vec3<Real>(Real(0)));
    shadow.ray.direction = aim.direction;
    shadow.distance = aim.distance;
    return start < distance && aim.distance > Real(0);
}

/// What is known of a hit.
template <class Real, class Scene>
CISTULA_HD inline RayAnswer answer_of(const Scene& scene, const Ray<Real>& ray, double start, const Hit<Real>& hit) {
    RayAnswer answer;
    if (!hit.found()) return answer;
    const Surface<Real> s = surface_at<Real, QueryEffects>(scene, ray, hit);
    const Solid& solid = scene.solids[key_solid(hit.key)];
    answer.t = start + double(hit.t);
    answer.point = Vec3<double>(s.point);
    answer.normal = Vec3<double>(s.normal);
    if (scene.materials[s.material].texture >= 0) answer.uv = Vec2<double>(texture_uv(scene, hit, s.normal));
    answer.solid = key_solid(hit.key);
    answer.face = key_face(hit.key) - (solid.kind == SolidKind::convex ? 0 : solid.first_triangle);
    answer.material = s.material;
    answer.crossing = key_kind(hit.key);
    return answer;
}

/// The first crossing of a ray.
template <class Real, class Intersector>
CISTULA_HD inline RayAnswer answer_ray(const Intersector& intersector, const RayQuestion& question) {
    const auto& scene = intersector.scene;
    Ray<Real> ray;
    double start;
    RayAnswer answer;
    if (!begin_ray(scene, question, ray, start)) return answer;
    if (!camera_solids(scene, intersector, question.origin, ray.media)) {
        answer.t = no_answer;
        return answer;
    }
    return answer_of(scene, ray, start, intersector.closest(ray));
}

/// The share of light that passes along a segment, of which faces that rays pass unseen are to be taken out.
template <class Real, class Intersector, class Scene>
CISTULA_HD inline Vec3<double> seen_share(const Scene& scene, const Intersector& intersector,
                                          const ShadowRay<Real>& shadow, Vec3<Real> arrives) {
    if (scene.unseen_faces) gain_unseen_faces<QueryEffects>(scene, intersector, shadow, true, arrives);
    return Vec3<double>(arrives);
}

/// The share of light that passes along a segment; NaN where that starts inside too many solids.
template <class Real, class Intersector>
CISTULA_HD inline Vec3<double> answer_segment(const Intersector& intersector, const RayQuestion& question) {
    const auto& scene = intersector.scene;
    const Light<Real> nowhere{};
    ShadowRay<Real> shadow;
    if (!begin_segment(scene, question, nowhere, shadow)) return Vec3<double>(1.0);
    if (!camera_solids(scene, intersector, question.origin, shadow.ray.media)) return Vec3<double>(no_answer);
    return seen_share(scene, intersector, shadow, intersector.template transmittance<QueryEffects>(shadow));
}

}  // namespace cistula
