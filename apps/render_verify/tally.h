// What a case has found so far: sums and extremes only, so that threads, tiles and devices give one result in any
// order.
#pragma once

#include "cistula/numerics/real.h"

namespace cistula::verify {

/// Where in a case: the number of the part in the upper bits, that of the ray in the lower 40.
inline constexpr int place_shift = 40;
inline constexpr uint64_t no_place = ~uint64_t(0);

struct Tally {
    uint64_t tried = 0;
    uint64_t failures = 0;
    uint64_t witnesses = 0;        // tries that met the hazard in fact; cases that count them need some
    double worst = 0;              // the largest of what was measured; 1 where something failed
    uint64_t worst_at = no_place;  // the least place with that
    uint64_t place = no_place;     // of the ray in work; the framework sets it

    CISTULA_HD void expect(bool holds) {
        ++tried;
        if (holds) return;
        ++failures;
        note(1, place);
    }
    /// A deviation >= 0. What is not a number is infinite.
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
