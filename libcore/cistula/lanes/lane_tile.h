// Rendering of a tile's pixels in lanes: primary rays and the branches of their trees, as many at once as a register
// holds (docs/wide.md).
#pragma once

#include "cistula/lanes/lane_absorption.h"
#include "cistula/lanes/lane_branch.h"
#include "cistula/lanes/lane_first_seen.h"
#include "cistula/lanes/lane_hash.h"
#include "cistula/lanes/lane_lights.h"
#include "cistula/lanes/lane_single.h"
#include "cistula/lanes/lane_surface.h"
#include "cistula/lanes/layered_lane_sums.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Counts rays for the film and for their pixels.
template <class Real>
struct LaneRays {
    RayCounts counts;
    LaneSums<Real>& sums;

    CISTULA_INLINE void add_shadow(const MaskOf<Real>& active) { counts.shadow += count(active); }
    CISTULA_INLINE uint64_t count(const MaskOf<Real>& active) {
        sums.count(active);
        return uint64_t(__builtin_popcount(active.bits()));
    }
};

/// A tile of samples to render. E: the effects that are compiled in. `by_sample`: each sample is rendered by itself, as
/// frames with a cutoff or a target error need it.
template <class Real, class E, bool by_sample = false>
class LaneTile {
  public:
    using T = ScalarOf<Real>;
    using Intersector = std::conditional_t<by_sample, HashingLanes<Real>, LaneIntersector<Real>>;
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Entry = BranchOf<Real, E, Media>;
    using Mask = MaskOf<Real>;
    using First = LaneFirstSeen<Real, E::has(fills_layers)>;
    static constexpr int lanes = LaneTraits<Real>::lanes;

    LaneTile(const Scene& scene, const FrameView& frame)
        : scene_(scene), frame_(frame), adaptive_(frame.lattice.target != 0), gradual_(shades_gradually(scene)) {}

    /// Adds samples to those to be rendered. Layers are filled by effects with fills_layers.
    void add(const LanePixel& pixel) {
        begin_pixel(*pixel.record);
        pixels_.push_back(pixel);
        pixels_.back().left = pixel.threshold.left(frame_.tree);
    }

    /// Renders what was added, unless stopped(), and adds the counts.
    template <class Stopped>
    void render(const Stopped& stopped, RayCounts& counts, uint32_t& flags) {
        LanePathHash<Real> hash;
        const Intersector intersector = intersector_with(hash);
        SumsOf<Real, E> sums(frame_.tree, scene_, pixels_.data(), flags);
        if constexpr (E::has(fills_layers)) sums.divide(frame_.layers, scene_.light_groups);
        rows_.assign(pixels_.size(), SumRow{});
        sums.collect(rows_.data());
        LaneRays<Real> rays{RayCounts(), sums};
        RayTree<Real, E, Intersector, LaneQueues<Entry>, LaneRays<Real>> tree(scene_, intersector, frame_.tree.depth,
                                                                              sums, rays, queues_);
        next_ = 0;
        next_sample_ = 0;
        Entry branch, kept;  // those that are followed, and as they were before
        First first{scene_, frame_, flags, {}, {}};
        for (uint32_t turns = 1;; ++turns) {
            if (turns % turns_between_stops == 0 && stopped()) return clear();
            Mask active = false;
            if (queues_.has_full() || next_ == pixels_.size()) {
                active = queues_.pop(branch);
                if (!any(active)) break;
                sums.begin(branch);
                if constexpr (by_sample) active = of_kept_samples(branch, active);
                active = sums.afford(branch.weight, active);
                if (!any(active)) continue;
                (branch.mirrored ? rays.counts.reflected : rays.counts.transmitted) += rays.count(active);
            } else {
                branch.begin();
                active = take_primaries(branch, first, flags);
                sums.begin(branch);
                if (!any(active)) continue;
                sums.count(active);
            }
            if constexpr (by_sample) hash.begin(largest_component(branch.weight) >= least_weight(), adaptive_);
            find_start_plane<OnlyEffects<E>>(scene_, branch.ray);
            if (branch.depth != 0) start_near<OnlyEffects<E>>(scene_, branch.ray);
            if constexpr (!E::has(effect_insides)) branch.ray.media = Media();
            if (scene_.may_stray()) kept = branch;
            const Mask single = tree.follow(branch, active, first);
            sums.end(active);
            if constexpr (by_sample) add_to_samples(branch, hash, sums.rays(), active, single);
            if (any(single)) trace_singly(kept, single, first, stopped, rays.counts, flags);
        }
        for (size_t i = 0; i < pixels_.size(); ++i) {
            for (int c = 0; c < 3; ++c) pixels_[i].record->radiance[c] += rows_[i].of[c];
            pixels_[i].rays += uint32_t(rows_[i].of[3]);
        }
        for (LanePixel& pixel : pixels_) {
            pixel.record->rays = pixel.rays;
            pixel.record->samples = uint32_t(pixel.count);
            rays.counts.primary += uint64_t(pixel.count);
        }
        if constexpr (by_sample) rays.counts = end_samples();
        counts.add(rays.counts);
        clear();
    }

  private:
    void clear() {
        pixels_.clear();
        queues_.clear();
    }

    /// What a sample may still lose, for branches that are traced by themselves.
    static TreeLimit<T, E::has(keeps_budget)> limit_of(const FrameView& frame, const LanePixel& pixel) {
        if constexpr (E::has(keeps_budget))
            return {pixel.threshold.of_branches(frame.tree), pixel.left};
        else
            return TreeLimit<T, false>(frame.tree);
    }

    /// Traces branches by themselves, and adds the counts.
    template <class Stopped>
    CISTULA_NOINLINE void trace_singly(const Entry& branch, const Mask& active, const First& first,
                                       const Stopped& stopped, RayCounts& counts, uint32_t& flags) {
        using All = Effects<all_effects | (E::mask & (keeps_budget | fills_layers))>;
        using Stack = StoppableStack<BranchStack<Branch<T>>, StopQuestion>;
        const SingleIntersector<T> intersector{scene_};
        for_each_lane(active, [&](int lane) {
            LanePixel& pixel = pixels_[size_t(branch.pixel[lane] & (Entry::by_mirror - 1))];
            SumsOf<T, All> sums(frame_.tree, scene_, *pixel.record, flags, limit_of(frame_, pixel));
            if constexpr (E::has(fills_layers)) {
                sums.divide(frame_.layers, pixel.layers, scene_.light_groups);
                if (branch.depth > 0) sums.enter((branch.pixel[lane] & Entry::by_mirror) != 0);
            }
            PixelRays rays;
            Branch<T> one = single_branch(branch, lane);
            const SingleFirstSeen<Real, First> seen{scene_, first, lane};
            typename Stack::Storage storage;
            Stack stack(storage, StopQuestion::by(stopped));
            if constexpr (by_sample) {
                PathHash hash;
                SampleStack<Stack, T> counted(stack, pixel, hash, T(frame_.lattice.significant), adaptive_);
                counted.begin(one);
                const HashingIntersector<SingleIntersector<T>> hashing{intersector, hash, gradual_};
                trace_single<All>(scene_, hashing, frame_.tree.depth, one, sums, rays, counted, seen);
                pixel.left = sums.left();
                pixel.path_hash += hash.value;
                pixel.reflected += rays.reflected;
                pixel.shadow += rays.shadow;
            } else {
                trace_single<All>(scene_, intersector, frame_.tree.depth, one, sums, rays, stack, seen);
            }
            counts.add(rays);
            pixel.rays += rays.total();
        });
    }

    CISTULA_INLINE Intersector intersector_with(LanePathHash<Real>& hash) const {
        if constexpr (by_sample)
            return {{scene_}, hash, gradual_};
        else
            return {scene_};
    }

    /// The least weight of branches that count in path hashes.
    CISTULA_INLINE Real least_weight() const { return Real(T(frame_.lattice.significant)); }

    /// Counts branches for their samples, and returns those of samples that are not given up.
    CISTULA_INLINE Mask of_kept_samples(const Entry& branch, const Mask& active) {
        uint32_t kept = 0;
        for_each_lane(active, [&](int lane) {
            LanePixel& pixel = pixels_[branch.pixel[lane]];
            ++pixel.branches;
            kept |= uint32_t(pixel.left >= 0 && !pixel.is_too_large(adaptive_)) << lane;
        });
        return Mask::of_bits(kept);
    }

    /// Adds the hashes of branches and the counts of their rays to their samples. `rays`: each branch and its shadow
    /// rays. `single`: those that are to be traced by themselves, of which nothing was done.
    CISTULA_INLINE void add_to_samples(const Entry& branch, const LanePathHash<Real>& hash, const IndexOf<Real>& rays,
                                       const Mask& active, const Mask& single) {
        for_each_lane(active & !single,
                      [&](int lane) { pixels_[branch.pixel[lane]].path_hash += uint32_t(hash.value[lane]); });
        for_each_lane(active, [&](int lane) {
            LanePixel& pixel = pixels_[branch.pixel[lane]];
            pixel.reflected += branch.mirrored;
            pixel.shadow += uint32_t(rays[lane]) - 1;
        });
    }

    /// Completes samples, and returns the counts of those whose thresholds hold.
    RayCounts end_samples() const {
        RayCounts counts;
        for (const LanePixel& pixel : pixels_) {
            LaneSample& sample = *pixel.sample;
            sample.threshold = pixel.threshold;
            sample.path_hash = pixel.path_hash;
            const bool is_too_large = pixel.is_too_large(adaptive_);
            sample.holds = pixel.left >= 0 && !is_too_large;
            if (is_too_large)
                sample.threshold.grow();
            else if (pixel.left < 0)
                sample.threshold.shrink();
            if (sample.holds)
                counts.add(
                    PixelRays{1, pixel.reflected, pixel.rays - 1 - pixel.reflected - pixel.shadow, pixel.shadow});
        }
        return counts;
    }

    /// The solids of an interior list, which has the scene's own numbers.
    InteriorSet interior_set(const InteriorList& list) const {
        InteriorList own;
        list.for_each([&](uint32_t solid, int count) { own.add(scene_.places[solid], count); });
        return InteriorSet::of(own, scene_.named);
    }

    /// The next sample of what was added, and its pixel's number.
    GridSample take_sample(size_t& number) {
        number = next_;
        const LanePixel& pixel = pixels_[next_];
        GridSample sample = grid_sample(pixel.first + next_sample_, frame_.supersample);
        if (by_sample && adaptive_) sample.middle = true;  // each has an id, a depth and a normal
        if (++next_sample_ == pixel.count) {
            next_sample_ = 0;
            ++next_;
        }
        return sample;
    }

    /// Sets the next primary rays, and returns where they are. Those that miss the scene are done here.
    Mask take_primaries(Entry& branch, First& first, uint32_t& flags) {
        LaneVectors<Real> origins, directions;
        LaneArray<IndexOf<Real>> media, numbers;
        LaneArray<Real> after(Real(-1));
        int count = 0;
        first.middle = 0;
        while (count < lanes && next_ < pixels_.size()) {
            size_t number;
            const GridSample sample = take_sample(number);
            LanePixel& pixel = pixels_[number];
            const Vec3<double> direction = sample_direction(frame_, pixel.x, pixel.y, sample);
            Ray<T> ray;
            double start;
            if (!primary_ray(scene_, frame_, direction, ray, start)) {
                SumsOf<T, E> sums(frame_.tree, scene_, *pixel.record, flags);
                if constexpr (E::has(fills_layers)) sums.divide(frame_.layers, pixel.layers, scene_.light_groups);
                sums.add(background_radiance<OnlyEffects<E>>(scene_, Vec3<T>(direction)), LightSource::background);
                ++pixel.rays;
                continue;
            }
            origins.set(count, ray.origin);
            directions.set(count, ray.direction);
            after.of[count] = ray.after.t;
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
        branch.ray.after.t = after.all();
        branch.ray.media = {media.all(), scene_.named};
        branch.pixel = numbers.all();
        return Mask::first(count);
    }

    const Scene& scene_;
    const FrameView& frame_;
    const bool adaptive_, gradual_;
    std::vector<LanePixel> pixels_;
    std::vector<SumRow> rows_;  // of pixels_
    LaneQueues<Entry> queues_;
    size_t next_ = 0;      // of pixels_
    int next_sample_ = 0;  // of its samples
};

}  // namespace cistula
