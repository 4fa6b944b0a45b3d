// Answers to questions about rays (ray_query.h) on the host: many at once, or one after the other, by all threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>

#include "backend_embree/lanes/tile_functions.h"
#include "base/default_rounding.h"
#include "cistula/lanes/lane_contact.h"
#include "cistula/lanes/lane_scene.h"
#include "cistula/transport/ray_query.h"

namespace cistula {

/// Calls answer(i) for each i < count.
template <class Answer>
void answer_each(size_t count, const Answer& answer) {
    constexpr size_t together = 64;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, together), [&](const auto& range) {
        const DefaultRounding rounding;
        for (size_t i = range.begin(); i != range.end(); ++i) answer(i);
    });
}

/// Answers by an intersector alone, as a device's kernel does.
template <class Real, class Intersector>
struct SingleQueries {
    const Intersector& intersector;

    void rays(std::span<const RayQuestion> questions, std::span<RayAnswer> answers) const {
        answer_each(questions.size(), [&](size_t i) { answers[i] = answer_ray<Real>(intersector, questions[i]); });
    }
    void segments(std::span<const RayQuestion> questions, std::span<Vec3<double>> shares) const {
        answer_each(questions.size(), [&](size_t i) { shares[i] = answer_segment<Real>(intersector, questions[i]); });
    }
};

/// Answers in lanes, but to rays that they cannot hold.
template <class Real>
struct LaneQueries {
    const LaneScene<Real>& scene;
    const TileFunctions& functions;
    const SingleIntersector<Real> single{scene};

    void rays(std::span<const RayQuestion> questions, std::span<RayAnswer> answers) const {
        for_each_group(questions, [&](size_t first, size_t last, Around& around) {
            Ray<Real> rays[most];
            double starts[most];
            size_t of[most];
            Hit<Real> hits[most];
            int count = 0;
            for (size_t i = first; i < last; ++i) {
                answers[i] = RayAnswer();
                if (!begin_ray(scene, questions[i], rays[count], starts[count])) continue;
                if (around.find(questions[i].origin, rays[count].media))
                    of[count++] = i;
                else
                    answers[i].t = no_answer;
            }
            if (count == 0) return;
            if (std::all_of(rays, rays + count, [&](const Ray<Real>& ray) { return fits(ray); }))
                functions.closest(&scene, rays, count, hits);
            else
                for (int k = 0; k < count; ++k) hits[k] = single.closest(rays[k]);
            for (int k = 0; k < count; ++k) {
                RayAnswer& answer = answers[of[k]] = answer_of(view(), rays[k], starts[k], hits[k]);
                if (hits[k].found()) answer.solid = scene.numbers[answer.solid];
            }
        });
    }

    void segments(std::span<const RayQuestion> questions, std::span<Vec3<double>> shares) const {
        for_each_group(questions, [&](size_t first, size_t last, Around& around) {
            const Light<Real> nowhere{};
            ShadowRay<Real> shadows[most];
            size_t of[most];
            Vec3<Real> found[most];
            int count = 0;
            for (size_t i = first; i < last; ++i) {
                shares[i] = Vec3<double>(1.0);
                if (!begin_segment(scene, questions[i], nowhere, shadows[count])) continue;
                if (around.find(questions[i].origin, shadows[count].ray.media))
                    of[count++] = i;
                else
                    shares[i] = Vec3<double>(no_answer);
            }
            if (count == 0) return;
            const auto fits_with_others = [&](const ShadowRay<Real>& shadow) {
                return shadow.light == shadows[0].light && fits(shadow.ray);
            };
            if (std::all_of(shadows, shadows + count, fits_with_others))
                functions.transmittance(&scene, shadows, count, found);
            else
                for (int k = 0; k < count; ++k) found[k] = single.template transmittance<QueryEffects>(shadows[k]);
            for (int k = 0; k < count; ++k) shares[of[k]] = seen_share(view(), single, shadows[k], found[k]);
        });
    }

  private:
    static constexpr int most = 16;  // lanes

    /// The solids around the origin that was asked for last: rays often start in one place.
    struct Around {
        const LaneQueries& queries;
        Vec3<double> origin = Vec3<double>(no_answer);
        InteriorList media = {};
        bool all = false;  // whether the list holds them all

        bool find(const Vec3<double>& of, InteriorList& to) {
            if (of != origin) all = camera_solids(queries.view(), queries.single, origin = of, media);
            to = media;
            return all;
        }
    };

    /// Calls answer(first, last, around) for groups of no more questions than there are lanes.
    template <class Answer>
    void for_each_group(std::span<const RayQuestion> questions, const Answer& answer) const {
        constexpr size_t together = 256;
        const size_t lanes = size_t(functions.lanes);
        tbb::parallel_for(tbb::blocked_range<size_t>(0, questions.size(), together), [&](const auto& range) {
            const DefaultRounding rounding;
            Around around{*this};
            for (size_t first = range.begin(); first < range.end(); first += lanes)
                answer(first, std::min(first + lanes, range.end()), around);
        });
    }

    const SceneView<Real>& view() const { return scene; }
    bool fits(const Ray<Real>& ray) const { return InteriorSet::holds(ray.media, scene.named); }
};

}  // namespace cistula
