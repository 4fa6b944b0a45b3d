#include "verify/ready_part.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "backend_embree/embree/embree_intersector.h"
#include "base/default_rounding.h"
#include "cistula/traversal/brute.h"

namespace cistula::verify {
namespace {

/// The reference intersector: every primitive's exact test, without any culling.
template <class Real>
struct PlainIntersector {
    const SceneView<Real>& scene;

    Hit<Real> closest(const Ray<Real>& ray) const {
        Hit<Real> best;
        if (!is_finite(ray)) return best;
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        for (uint32_t p = 0; p < scene.convex.size + scene.clusters.size; ++p)
            closest_primitive(scene, p, ray, triangle_ray, best);
        closest_disk<AllEffects>(scene, true, ray, best);
        return best;
    }
};

/// Rays that a thread takes at once: few of those that go through large scenes.
tbb::blocked_range<uint64_t> blocks(uint64_t count) {
    return {0, count, std::clamp<uint64_t>(count / 64, 1, 64)};
}

}  // namespace

template <class Real>
ReadyPart<Real>::ReadyPart(const Part& part, uint64_t number, const Options& options, StopSignal stop)
    : part_(part),
      options_(options),
      stop_(stop),
      compiled_(compile_scene<Real>(part.scene, stop)),
      numbers_(part.numbers) {
    if constexpr (sizeof(Real) == sizeof(float)) {
        if (part.edit_float) part.edit_float(*compiled_);
    } else {
        if (part.edit_double) part.edit_double(*compiled_);
    }
    build_primitive_tree(*compiled_);
    const PartFrame frame{compiled_->center, std::ldexp(1.0, compiled_->scale)};
    for (const glm::dvec3& p : part.points) points_.push_back(frame.point(p));  // as Frame::point
    if (part.frame_numbers) part.frame_numbers(frame, numbers_);
    setup_.scene = compiled_->view();
    setup_.points = {points_.data(), uint32_t(points_.size())};
    setup_.numbers = {numbers_.data(), uint32_t(numbers_.size())};
    setup_.factor = frame.factor;
    setup_.seed = number + 0x9e3779b97f4a7c15u * options.seed;
}

template <class Real>
std::string ReadyPart<Real>::missing_warning() const {
    for (const std::string& text : part_.warnings) {
        const auto& all = compiled_->warnings;
        if (std::none_of(all.begin(), all.end(), [&](const auto& w) { return w.find(text) != std::string::npos; }))
            return fmt::format("{}: no warning \"{}\"", part_.label, text);
    }
    return "";
}

template <class Real>
uint64_t ReadyPart<Real>::plain_count() const {
    const uint64_t primitives = setup_.scene.convex.size + setup_.scene.clusters.size;
    const uint64_t tests = options_.quick ? 10'000'000 : 500'000'000;
    const uint64_t least_rays = 64;
    return std::min(part_.count, std::max(tests / std::max<uint64_t>(primitives, 1), least_rays));
}

template <class Real>
const LanePath<Real>& ReadyPart<Real>::lanes() {
    if (!lanes_) lanes_ = std::make_unique<LanePath<Real>>(setup_.scene, options_.lanes);
    return *lanes_;
}

template <class Real>
void ReadyPart<Real>::with_intersector(IntersectorKind by,
                                       const std::function<void(const CalledIntersector<Real>&)>& body) {
    const auto call = [&](const auto& intersector) { body(CalledIntersector<Real>(intersector)); };
    const SceneView<Real>& scene = setup_.scene;
    switch (by) {
        case IntersectorKind::embree:
            if (!embree_) embree_ = std::make_unique<EmbreeTree<Real>>(scene, EmbreeOptions());
            return call(EmbreeIntersector<Real>{scene, embree_->scene()});
        case IntersectorKind::lanes:
            return call(lanes());
        case IntersectorKind::bvh:
            return call(BvhIntersector<Real>{scene});
        case IntersectorKind::plain:
            return call(PlainIntersector<Real>{scene});
        default:
            return call(BruteIntersector<Real>{scene});
    }
}

template <class Real>
Tally ReadyPart<Real>::tally(IntersectorKind by, const RayMethods<Real>& methods, uint64_t place, uint64_t count) {
    const std::byte* functor = part_.functor.data();
#if CISTULA_HAS_CUDA
    if (by == IntersectorKind::cuda) return tally_on_device(methods.device, functor, setup_, place, count);
#endif
    Tally all;
    with_intersector(by, [&](const CalledIntersector<Real>& intersector) {
        all = tbb::parallel_reduce(
            blocks(count), Tally(),
            [&](const auto& range, Tally tally) {
                const DefaultRounding rounding;
                if (stop_.is_given()) return tally;
                methods.tally(functor, setup_, intersector, range.begin(), range.end(), place, tally);
                return tally;
            },
            [](Tally a, const Tally& b) {
                a.merge(b);
                return a;
            });
    });
    return all;
}

template <class Real>
std::vector<uint64_t> ReadyPart<Real>::words(IntersectorKind by, const RayMethods<Real>& methods, uint64_t count) {
    const std::byte* functor = part_.functor.data();
#if CISTULA_HAS_CUDA
    if (by == IntersectorKind::cuda) return words_on_device(methods.device, functor, setup_, count);
#endif
    std::vector<uint64_t> words(count);
    with_intersector(by, [&](const CalledIntersector<Real>& intersector) {
        tbb::parallel_for(blocks(count), [&](const auto& range) {
            const DefaultRounding rounding;
            if (stop_.is_given()) return;
            methods.words(functor, setup_, intersector, range.begin(), range.end(), words.data());
        });
    });
    return words;
}

template class ReadyPart<float>;
template class ReadyPart<double>;

}  // namespace cistula::verify
