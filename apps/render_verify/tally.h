// The results of a case so far: sums and extremes only, so that they do not depend on the order of threads, tiles and
// devices.
#pragma once

#include "cistula/numerics/real.h"

namespace cistula::verify {

/// Encoding of a place in a case: number of the part in the upper bits, number of the ray in the lower 40.
inline constexpr int place_shift = 40;
inline constexpr uint64_t no_place = ~uint64_t(0);

struct Tally {
    uint64_t tried = 0;
    uint64_t failures = 0;
    uint64_t witnesses = 0;        // tries in which the hazard occurred; cases with needs_witness need some
    double worst = 0;              // the largest deviation; 1 if something failed
    uint64_t worst_at = no_place;  // the smallest place with that deviation
    uint64_t place = no_place;     // of the current ray; set by the framework

    CISTULA_HD void expect(bool holds) {
        ++tried;
        if (holds) return;
        ++failures;
        note(1, place);
    }
    /// Records a deviation >= 0. NaN counts as infinite.
    CISTULA_HD void measure(double deviation) {
        ++tried;
        note(deviation == deviation ? deviation : RealTraits<double>::infinity, place);
    }
    CISTULA_HD void witness(bool met) { witnesses += met ? 1 : 0; }

    CISTULA_HD void merge(const Tally& other) {
        tried += other.tried;
        failures += other.failures;
        witnesses += other.witnesses;
        note(other.worst, other.worst_at);
    }

  private:
    CISTULA_HD void note(double deviation, uint64_t at) {
        if (deviation > worst || (deviation == worst && deviation > 0 && at < worst_at))
            worst = deviation, worst_at = at;
    }
};

}  // namespace cistula::verify
