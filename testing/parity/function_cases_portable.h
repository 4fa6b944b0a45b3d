// Function parity, portable.h: functions with device instructions of their own.
#pragma once

#include "testing/parity/function_case.h"

namespace cistula::parity {

/// The range in which reciprocal() is correctly rounded: magnitudes from 2^-120 to 2^120, inclusive.
inline constexpr int reciprocal_range = 120;

template <class Real>
struct ReciprocalCase : CaseOf<Real, 1> {
    static constexpr const char* name = "reciprocal";
    struct Input {
        Real x;
    };
    CISTULA_HD static Real size(Draw& draw) {
        constexpr int last = reciprocal_range;
        const uint32_t kind = draw.below(4);
        if (kind == 0) return magnitude(draw.scaled<Real>(-2, 1));
        if (kind == 1)
            return draw.near(two_to<Real>(draw.between(1 - last, last - 1)),
                             8);  // around powers of two, where quotients are hardest to round
        if (kind == 2)
            return draw.one_in(2) ? stepped(two_to<Real>(-last), draw.between(0, 3))
                                  : stepped(two_to<Real>(last), draw.between(-3, 0));  // ends of the range
        return magnitude(draw.scaled<Real>(-last, last - 1));
    }
    CISTULA_HD static Input make(Draw& draw) {
        const Real x = size(draw);
        return {draw.one_in(2) ? -x : x};
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(reciprocal(in.x)); }
};

/// Case: min_no_nan() and max_no_nan() of numbers that are not NaN and not both zero.
template <class Real>
struct LesserGreaterCase : CaseOf<Real, 2> {
    static constexpr const char* name = "lesser_greater";
    struct Input {
        Real a, b;
    };
    CISTULA_HD static Real number(Draw& draw) {
        const Real x = draw.any<Real>();
        return x == x ? x : Real(draw.between(-2, 2));
    }
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.a = number(draw);
        in.b = number(draw);
        const int steps = draw.between(-1, 1);
        const bool finite = in.a - in.a == Real(0), zero = in.a == Real(0);
        switch (draw.below(4)) {
            case 0:  // equal, or neighbors
                if (finite && !zero) in.b = stepped(in.a, steps);
                break;
            case 1:
                in.b = -in.a;
                break;
            default:
                break;
        }
        if (in.a == Real(0) && in.b == Real(0)) in.b = two_to<Real>(draw.between(-Layout<Real>::bias, 1));
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.real(min_no_nan(in.a, in.b));
        out.real(max_no_nan(in.a, in.b));
    }
};

}  // namespace cistula::parity
