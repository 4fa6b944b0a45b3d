// The intersector of lanes, as cases call it.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "backend_embree/lanes/lane_renderer.h"
#include "cistula/lanes/lane_hit.h"
#include "scene/compile/lane_scene.h"
#include "verify/called_intersector.h"

namespace cistula::verify {

/// A scene for lanes, with the functions that trace it. A case asks for one ray; the other lanes hold those that its
/// thread asked for before, whose answers must not change. Rays that a frame traces by themselves (lane_single.h) are
/// traced so.
template <class Real>
class LanePath {
  public:
    /// The scene must outlive this, and have a tree. `most_lanes`: 0 for any number.
    LanePath(const SceneView<Real>& scene, int most_lanes)
        : scene_(scene),
          in_lanes_(lane_scene(scene)),
          functions_(in_lanes_ ? tile_functions(in_lanes_->scene(), most_lanes) : nullptr) {
        if (!fits()) return;
        const Span<uint32_t>& numbers = in_lanes_->scene().numbers;
        places_.resize(numbers.size);
        for (uint32_t i = 0; i < numbers.size; ++i) places_[numbers[i]] = i;
    }

    /// Whether frames of the scene are traced in lanes.
    bool fits() const { return functions_ != nullptr; }

    Hit<Real> closest(const Ray<Real>& ray) const {
        if (is_traced_alone(ray)) return BvhIntersector<Real>{scene_}.closest(ray);
        Hit<Real> hit =
            answer(recent_hits_.local(), numbered(ray), [&](const Ray<Real>* rays, int count, Hit<Real>* hits) {
                functions_->closest(&in_lanes_->scene(), rays, count, hits);
            });
        if (hit.found()) hit.key = renumbered(hit.key, in_lanes_->scene().numbers.data);
        return hit;
    }

    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if (is_traced_alone(shadow.ray)) return BvhIntersector<Real>{scene_}.template transmittance<E>(shadow);
        auto& recent = recent_shares_.local();
        if (recent.count > 0 && recent.questions[0].light != shadow.light) recent = {};  // one light at a time
        const ShadowRay<Real> asked{numbered(shadow.ray), shadow.distance, shadow.light};
        const Vec3<Real> shares =
            answer(recent, asked, [&](const ShadowRay<Real>* shadows, int count, Vec3<Real>* arrive) {
                functions_->transmittance(&in_lanes_->scene(), shadows, count, arrive);
            });
        if constexpr (std::is_same_v<Throughput<Real, E>, Real>)
            return shares.x;
        else
            return shares;
    }

  private:
    static constexpr int most = 16;

    bool is_traced_alone(const Ray<Real>& ray) const {
        return !InteriorSet::holds(ray.media, in_lanes_->scene().named) || BallSides::at_start(scene_, ray).bits != 0;
    }

    /// The last questions and their answers, in the order of lanes.
    template <class Question, class Answer>
    struct Recent {
        std::array<Question, most> questions;
        std::array<Answer, most> answers;
        int count = 0;
        int next = 0;
    };

    template <class Question, class Answer, class Trace>
    Answer answer(Recent<Question, Answer>& recent, const Question& question, const Trace& trace) const {
        const int lane = recent.next;
        recent.questions[size_t(lane)] = question;
        recent.count = std::max(recent.count, lane + 1);
        recent.next = (lane + 1) % functions_->lanes;
        std::array<Answer, most> found;
        trace(recent.questions.data(), recent.count, found.data());
        for (size_t i = 0; i < size_t(recent.count); ++i)
            if (i != size_t(lane) && is_unit(recent.questions[i]) && !is_same(found[i], recent.answers[i]))
                throw std::logic_error("a ray's result depends on the rays in other lanes");
        return recent.answers[size_t(lane)] = found[size_t(lane)];
    }
    static bool is_same(const Hit<Real>& a, const Hit<Real>& b) {
        if (!a.found() || !b.found()) return a.found() == b.found();
        return a.t == b.t && a.key == b.key && a.u == b.u && a.v == b.v && a.slot == b.slot && a.enters == b.enters;
    }
    static bool is_same(const Vec3<Real>& a, const Vec3<Real>& b) { return a == b; }

    /// Whether a ray's direction is unit, as every direction in a frame is. What another misses by its bounding spheres
    /// depends on the order of tests, on every intersector.
    static bool is_unit(const Ray<Real>& ray) {
        return magnitude(dot(ray.direction, ray.direction) - Real(1)) <= 64 * RealTraits<Real>::unit;
    }
    static bool is_unit(const ShadowRay<Real>& shadow) { return is_unit(shadow.ray); }

    /// A ray with the numbers of solids in lanes.
    Ray<Real> numbered(Ray<Real> ray) const {
        if (ray.from_solid != no_solid) ray.from_solid = places_[ray.from_solid];
        if (ray.after.key != 0) ray.after.key = renumbered(ray.after.key, places_.data());
        for (uint32_t i = 0; i < ray.media.size; ++i) {
            uint32_t& entry = ray.media.entries[i];
            entry = places_[InteriorList::solid_of(entry)] << 8 | (entry & 0xffu);
        }
        return ray;
    }

    const SceneView<Real>& scene_;
    const std::unique_ptr<const OwnedLaneScene<Real>> in_lanes_;
    const TileFunctions* const functions_;
    std::vector<uint32_t> places_;  // in lanes, of the scene's solids
    mutable tbb::enumerable_thread_specific<Recent<Ray<Real>, Hit<Real>>> recent_hits_;
    mutable tbb::enumerable_thread_specific<Recent<ShadowRay<Real>, Vec3<Real>>> recent_shares_;
};

}  // namespace cistula::verify
