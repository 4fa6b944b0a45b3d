// The form of a case of the function parity check, and its results as words that can be compared.
#pragma once

#include "cistula/numerics/double_double.h"
#include "verify/draw.h"

namespace cistula::parity {

using namespace verify;  // draws

/// Collects the bits of a case's results. All NaNs count as equal: IEEE 754 leaves their sign and payload open, x86 and
/// NVIDIA differ in them, and no image contains one.
class Words {
  public:
    CISTULA_HD explicit Words(uint64_t* out) : out_(out) {}

    CISTULA_HD void bits(uint64_t word) { out_[count_++] = word; }
    template <class Real>
    CISTULA_HD void real(Real x) {
        bits(x == x ? uint64_t(bits_as<typename Layout<Real>::Bits>(x)) : 0x7ff8000000000000u);
    }
    /// Adds a value whose zero may have either sign, such as a maximum over several; callers do not see the sign.
    template <class Real>
    CISTULA_HD void unsigned_zero(Real x) {
        real(x == Real(0) ? Real(0) : x);
    }
    template <class Real>
    CISTULA_HD void vec(const Vec3<Real>& v) {
        for (int k = 0; k < 3; ++k) real(v[k]);
    }
    CISTULA_HD void pair(const DoubleDouble& a) {
        real(a.high);
        real(a.low);
    }
    CISTULA_HD int count() const { return count_; }

  private:
    uint64_t* out_;
    int count_ = 0;
};

inline constexpr int most_words = 16;

/// What every case has, beside a `name`, `Input`, make(Draw&) and run(Input, Words&).
template <class Real, int count>
struct CaseOf {
    using Number = Real;                 // float or double
    static constexpr int words = count;  // of its results
};
struct OneDouble {
    double x;
};
template <int count>
struct OfDouble : CaseOf<double, count> {
    using Input = OneDouble;
};

/// Runs one input of a case.
template <class Case>
CISTULA_HD inline void run_case(uint64_t index, uint64_t seed, uint64_t* out) {
    Draw draw(index, seed);
    const typename Case::Input input = Case::make(draw);
    Words words(out);
    Case::run(input, words);
}

template <class... Cases>
struct CaseList {};

}  // namespace cistula::parity
