// The ray benchmark on the host: traces every ray again and compares the device's results bit for bit.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cstring>

#include "testing/parity/ray_work.h"

namespace cistula::bench {

/// The result of comparing one kind of ray.
struct RayTally {
    uint64_t rays = 0, hits = 0;  // of the host; for shadow rays, hits are those that are blocked
    uint64_t differing = 0;       // rays or results
    uint32_t first_differing = ~uint32_t{0};

    void add(uint32_t index, bool exists, bool hit, bool same) {
        rays += exists;
        hits += hit;
        differing += !same;
        if (!same) first_differing = std::min(first_differing, index);
    }
    void add(const RayTally& other) {
        rays += other.rays;
        hits += other.hits;
        differing += other.differing;
        first_differing = std::min(first_differing, other.first_differing);
    }
};

struct RayTallies {
    RayTally primary, bounced, shadow;

    void add(const RayTallies& other) {
        primary.add(other.primary);
        bounced.add(other.bounced);
        shadow.add(other.shadow);
    }
};

template <class Stored>
bool same_bits(const Stored& a, const Stored& b) {
    return std::memcmp(&a, &b, Stored::used_bytes) == 0;
}

template <class Real>
void compare_ray(const SceneView<Real>& scene, const FrameView& frame, uint32_t index, const RayArrays<Real>& theirs,
                 size_t at, RayTallies& tallies) {
    const StoredRay<Real> primary = primary_ray_of<Real>(scene, frame, index);
    const StoredHit<Real> hit = closest_hit_of(scene, primary);
    StoredRay<Real> bounced, shadow;
    further_rays_of(scene, primary, hit, index, bounced, shadow);
    const StoredHit<Real> bounced_hit = closest_hit_of(scene, bounced);
    const uint8_t light = light_of(scene, shadow);
    tallies.primary.add(index, primary.exists(), hit.key != no_key,
                        same_bits(primary, theirs.primary[at]) && same_bits(hit, theirs.primary_hits[at]));
    tallies.bounced.add(index, bounced.exists(), bounced_hit.key != no_key,
                        same_bits(bounced, theirs.bounced[at]) && same_bits(bounced_hit, theirs.bounced_hits[at]));
    tallies.shadow.add(index, shadow.exists(), light == light_is_stopped,
                       same_bits(shadow, theirs.shadow[at]) && light == theirs.light[at]);
}

/// Compares rays [first, first + count) with `theirs`, which begins at 0.
template <class Real>
RayTallies compare_rays(const SceneView<Real>& scene, const FrameView& frame, uint32_t first, uint32_t count,
                        const RayArrays<Real>& theirs) {
    return tbb::parallel_reduce(
        tbb::blocked_range<uint32_t>(0, count, 512), RayTallies(),
        [&](const tbb::blocked_range<uint32_t>& range, RayTallies tallies) {
            _mm_setcsr(0x1f80);  // rounds to nearest, flushes nothing
            for (uint32_t i = range.begin(); i != range.end(); ++i)
                compare_ray(scene, frame, first + i, theirs, i, tallies);
            return tallies;
        },
        [](RayTallies a, const RayTallies& b) {
            a.add(b);
            return a;
        });
}

}  // namespace cistula::bench
