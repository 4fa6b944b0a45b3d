// Rendering of a tile's pixels in lanes: primary rays and the branches of their trees, as many at once as a register
// holds (docs/wide.md).
#pragma once

#include "cistula/lanes/lane_absorption.h"
#include "cistula/lanes/lane_branch.h"
#include "cistula/lanes/lane_intersector.h"
#include "cistula/lanes/lane_lights.h"
#include "cistula/lanes/lane_sums.h"
#include "cistula/lanes/lane_surface.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Counts rays for the film and for their pixels.
template <class Real>
struct LaneRays {
    RayCounts counts;
    LaneSums<Real>& sums;

    CISTULA_INLINE void add_shadow(const MaskOf<Real>& who) { counts.shadow += count(who); }
    CISTULA_INLINE uint64_t count(const MaskOf<Real>& who) {
        sums.count(who);
        return uint64_t(__builtin_popcount(who.bits()));
    }
};

/// What the primary rays in a register meet first.
template <class Real>
struct LaneFirstSeen {
    static constexpr int lanes = LaneTraits<Real>::lanes;
    using T = ScalarOf<Real>;

    const LaneScene<T>& scene;
    const FrameView& frame;
    LanePixel* of[lanes];
    PixelWork work[lanes];  // start and facing of samples in the middle of their pixels
    uint32_t middle = 0;    // the lanes of these

    CISTULA_INLINE void surface(const Hit<Real>& hit, const Surface<Real>& s, const MaskOf<Real>& who) const {
        for_each_lane(who, [&](int lane) {
            Hit<T> one;
            one.t = hit.t[lane];
            one.key = make_key(CrossingKind::enter, scene.numbers[uint32_t(key_solid(hit.key)[lane])], 0);
            Surface<T> met;
            met.normal = lane_of(s.normal, lane);
            seen(lane).surface(one, met);
        });
    }
    template <class Media>
    CISTULA_INLINE void light(const LaneScene<T>&, const VisibleLightHit<Real>& hit, const Ray<Real, Media>& ray,
                              const MaskOf<Real>& who) const {
        for_each_lane(who, [&](int lane) {
            seen(lane).light(scene, VisibleLightHit<T>{hit.t[lane], uint32_t(hit.light[lane])}, lane_of(ray, lane));
        });
    }

  private:
    CISTULA_INLINE FirstSeen<T> seen(int lane) const {
        return {frame, work[lane], *of[lane]->record, (middle >> lane & 1u) != 0};
    }
};

/// The pixels of a tile. E: the effects that are compiled in.
template <class Real, class E>
class LaneTile {
  public:
    using T = ScalarOf<Real>;
    using Intersector = LaneIntersector<Real>;
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Entry = BranchOf<Real, E, Media>;
    using Mask = MaskOf<Real>;
    static constexpr int lanes = LaneTraits<Real>::lanes;

    LaneTile(const Scene& scene, const FrameView& frame) : scene_(scene), frame_(frame) {}

    /// Adds a pixel of the frame to those to be rendered.
    void add(int x, int y, PixelRecord& record) {
        begin_pixel(record);
        places_.push_back({x, y});
        pixels_.push_back({&record, 0});
    }

    /// Renders the pixels that were added, unless stopped(), and adds the counts.
    template <class Stopped>
    void render(const Stopped& stopped, RayCounts& counts, uint32_t& flags) {
        const Intersector intersector{scene_};
        LaneSums<Real> sums(frame_.tree, scene_, pixels_.data(), flags);
        LaneRays<Real> rays{RayCounts(), sums};
        RayTree<Real, E, Intersector, LaneQueues<Entry>, LaneRays<Real>> tree(scene_, intersector, frame_.tree.depth,
                                                                              sums, rays, queues_);
        next_ = 0;
        for (uint32_t turns = 1;; ++turns) {
            if (turns % turns_between_stops == 0 && stopped()) return queues_.clear();
            Entry branch;
            Mask who = false;
            LaneFirstSeen<Real> first{scene_, frame_, {}, {}};
            if (queues_.has_full() || next_ == samples()) {
                who = queues_.pop(branch);
                if (!any(who)) break;
                sums.begin(branch.pixel);
                who = sums.afford(branch.weight, who);
                if (!any(who)) continue;
                (branch.mirrored ? rays.counts.reflected : rays.counts.transmitted) += rays.count(who);
            } else {
                branch = Entry();
                who = take_primaries(branch, first, flags);
                sums.begin(branch.pixel);
                if (!any(who)) continue;
                sums.count(who);
            }
            find_start_plane<E>(scene_, branch.ray);
            if constexpr (!E::has(effect_insides)) branch.ray.media = Media();
            tree.follow(branch, who, first);
            sums.end(who);
        }
        rays.counts.primary = samples();
        counts.add(rays.counts);
        for (LanePixel& pixel : pixels_) {
            pixel.record->rays = pixel.rays;
            pixel.record->samples = uint32_t(per_pixel());
        }
        places_.clear();
        pixels_.clear();
    }

  private:
    struct Place {
        int x, y;
    };

    size_t per_pixel() const { return size_t(frame_.supersample) * size_t(frame_.supersample); }
    size_t samples() const { return pixels_.size() * per_pixel(); }

    /// The solids of an interior list, which has the scene's own numbers.
    InteriorSet interior_set(const InteriorList& list) const {
        InteriorSet set;
        for (uint32_t i = 0; !list.empty() && i < scene_.convex.size; ++i)
            set.bits |= uint32_t(list.contains(scene_.numbers[i])) << i;
        return set;
    }

    /// Sets the next primary rays, and returns where they are. Those that miss the scene are done here.
    Mask take_primaries(Entry& branch, LaneFirstSeen<Real>& first, uint32_t& flags) {
        LaneVectors<Real> origins, directions;
        LaneArray<IndexOf<Real>> media, numbers;
        int count = 0;
        for (; count < lanes && next_ < samples(); ++next_) {
            const size_t number = next_ / per_pixel();
            LanePixel& pixel = pixels_[number];
            const GridSample sample = grid_sample(int(next_ % per_pixel()), frame_.supersample);
            const Vec3<double> direction = sample_direction(frame_, places_[number].x, places_[number].y, sample);
            Ray<T> ray;
            double start;
            if (!primary_ray(scene_, frame_, direction, ray, start)) {
                PixelSums<T>(frame_.tree, scene_, *pixel.record, flags).add(scene_.background);
                ++pixel.rays;
                continue;
            }
            origins.set(count, ray.origin);
            directions.set(count, ray.direction);
            media.of[count] = int32_t(interior_set(ray.media).bits);
            numbers.of[count] = int32_t(number);
            first.of[count] = &pixel;
            if (sample.middle) {
                first.middle |= 1u << count;
                first.work[count].start = start;
                first.work[count].facing = dot(direction, frame_.camera.forward);
            }
            ++count;
        }
        for (int lane = count; lane < lanes; ++lane) {
            origins.set(lane, Vec3<T>(T(0)));
            directions.set(lane, Vec3<T>(T(0)));
            media.of[lane] = 0;
            numbers.of[lane] = 0;
        }
        branch.ray.origin = origins.all();
        branch.ray.direction = directions.all();
        branch.ray.media.bits = media.all();
        branch.pixel = numbers.all();
        return Mask::first(count);
    }

    const Scene& scene_;
    const FrameView& frame_;
    std::vector<Place> places_;
    std::vector<LanePixel> pixels_;
    LaneQueues<Entry> queues_;
    size_t next_ = 0;  // sample, pixel by pixel
};

}  // namespace cistula
