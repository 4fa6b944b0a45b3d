// The result of one pixel: integer sums, which do not depend on the order of work, and the data of its first hit.
#pragma once

#include <cstddef>

#include "cistula/numerics/real.h"

namespace cistula {

/// Errors found while rendering; any bit set in a film fails the render with a message.
enum RenderFlag : uint32_t {
    flag_not_finite = 1u << 0,          // a radiance was infinite or NaN
    flag_media_overflow = 1u << 1,      // more nested solids than an interior list holds
    flag_stack_overflow = 1u << 2,      // a ray tree needed more pending branches than the branch stack holds
    flag_too_many_crossings = 1u << 3,  // a straight ray crossed more faces than the limit
    flag_objects_overflow = 1u << 4,    // a pixel shows more objects than its table holds (layers.h)
};

/// Whether a film with these flags is no image, whatever is done with it.
CISTULA_INLINE bool is_unreliable(uint32_t flags) {
    return (flags & ~uint32_t(flag_objects_overflow)) != 0;
}

/// Ray counts of one pixel. 32 bits suffice: 2^32 rays would take hours.
struct PixelRays {
    uint32_t primary = 0;
    uint32_t reflected = 0;
    uint32_t transmitted = 0;
    uint32_t shadow = 0;

    CISTULA_INLINE void add(const PixelRays& o) {
        primary += o.primary;
        reflected += o.reflected;
        transmitted += o.transmitted;
        shadow += o.shadow;
    }
    CISTULA_INLINE uint32_t total() const { return primary + reflected + transmitted + shadow; }
    CISTULA_INLINE void add_shadow(bool) { ++shadow; }
};

/// Per-pixel working data of a render; a device keeps it in shared memory to save registers.
struct PixelWork {
    PixelRays rays;
    uint32_t flags = 0;  // RenderFlag bits
    double start = 0,
           facing = 0;  // of the sample under way: from the camera to its ray's origin; cosine to the view axis
};

struct RayCounts {
    uint64_t primary = 0;
    uint64_t reflected = 0;
    uint64_t transmitted = 0;
    uint64_t shadow = 0;

    CISTULA_INLINE void add(const RayCounts& o) {
        primary += o.primary;
        reflected += o.reflected;
        transmitted += o.transmitted;
        shadow += o.shadow;
    }
    CISTULA_INLINE void add(const PixelRays& o) {
        primary += o.primary;
        reflected += o.reflected;
        transmitted += o.transmitted;
        shadow += o.shadow;
    }
    CISTULA_INLINE uint64_t total() const { return primary + reflected + transmitted + shadow; }
};

struct Plus {
    template <class T>
    CISTULA_INLINE void operator()(T& to, T value) const {
        to += value;
    }
};

/// A pixel's radiance over its samples, what every film keeps: value = sum / 2^shift / samples * 2^radiance_exponent.
struct PixelRadiance {
    int64_t radiance[3];
    uint32_t hits;          // samples whose primary ray hit anything (visible lights included)
    uint32_t samples : 29;  // samples that were rendered
    uint32_t unmet : 1;     // adaptive sampling wanted more samples than `most`
    uint32_t checked : 1;   // adaptive sampling took all samples, to check whether those that it wanted sufficed
    uint32_t off : 1;       // they did not: their estimate missed the mean of all by more than the target
};

/// What truncation took from a pixel, in units of the sums.
struct PixelLosses {
    int64_t pruned[3];  // upper bound on what the cutoff took away
    int64_t cut[3];     // upper bound on what the depth limit took away
};

/// What a pixel shows, and how many rays it took.
struct PixelSight {
    int32_t id;  // under the sample nearest the pixel's center: 1 + solid, or 1 + number of solids + visible light;
                 // 0: none
    float z;     // that sample's distance along the view axis in scene units; infinity: none
    float normal[3];  // that sample's unit normal, toward the viewer, in world axes; 0: none
    uint32_t rays;    // rays of all kinds
};

/// All that is found of a pixel. Films keep the parts that are asked for.
struct PixelRecord : PixelRadiance, PixelLosses, PixelSight {
    /// Adds the sums to those of another record by add(to, value), but not the counts of rays and samples.
    template <class Add>
    CISTULA_INLINE void give(PixelRadiance& to, PixelLosses& losses, const Add& add) const {
        for (int c = 0; c < 3; ++c) {
            add(to.radiance[c], radiance[c]);
            add(losses.pruned[c], pruned[c]);
            add(losses.cut[c], cut[c]);
        }
        add(to.hits, hits);
    }

    /// Adds the record of other samples of the same pixel.
    CISTULA_INLINE void add(const PixelRecord& o) {
        o.give(*this, *this, Plus());
        rays += o.rays;
        samples += o.samples;
        if (o.id == 0) return;
        id = o.id;
        z = o.z;
        for (int c = 0; c < 3; ++c) normal[c] = o.normal[c];
    }
};
static_assert(sizeof(PixelRecord) == sizeof(PixelRadiance) + sizeof(PixelLosses) + sizeof(PixelSight), "no padding");

/// Where the parts of records are kept, one array each; null: they are not.
struct PixelPlanes {
    PixelRadiance* radiance = nullptr;
    PixelLosses* losses = nullptr;
    PixelSight* sights = nullptr;

    CISTULA_INLINE void put(size_t pixel, const PixelRecord& record) const {
        radiance[pixel] = record;
        if (losses != nullptr) losses[pixel] = record;
        if (sights != nullptr) sights[pixel] = record;
    }
};

/// Sum and largest of up to 2^32 numbers below 2^64. The sum, of the numbers' lower and upper halves, is exact.
struct Total {
    unsigned long long low = 0;
    unsigned long long high = 0;
    unsigned long long most = 0;

    CISTULA_INLINE void add(uint64_t value, uint64_t times = 1) {
        low += (value & 0xffffffffu) * times;
        high += (value >> 32) * times;
        if (times > 0) most = max_or_second<unsigned long long>(value, most);
    }
    CISTULA_INLINE void add(const Total& o) {
        low += o.low;
        high += o.high;
        most = max_or_second(o.most, most);
    }
    double sum() const { return double(high) * 0x1p32 + double(low); }
};

/// Totals over the pixels of a frame, in units of the sums.
struct PixelTotals {
    Total radiance[3], pruned[3], cut[3];
    Total units;  // of what whole units may have taken from each channel (units_lost)

    /// Adds so many pixels of a record that lost so many whole units.
    CISTULA_INLINE void add(const PixelRecord& pixel, uint64_t units_lost, uint64_t times = 1) {
        for (int c = 0; c < 3; ++c) {
            radiance[c].add(uint64_t(pixel.radiance[c]), times);
            pruned[c].add(uint64_t(pixel.pruned[c]), times);
            cut[c].add(uint64_t(pixel.cut[c]), times);
        }
        units.add(units_lost, times);
    }
    CISTULA_INLINE void add(const PixelTotals& o) {
        for (int c = 0; c < 3; ++c) {
            radiance[c].add(o.radiance[c]);
            pruned[c].add(o.pruned[c]);
            cut[c].add(o.cut[c]);
        }
        units.add(o.units);
    }
};

}  // namespace cistula
