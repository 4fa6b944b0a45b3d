// Function parity, numbers: elementary functions and double-double.
#pragma once

#include "cistula/numerics/trigonometry.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

struct Exp2Case : OfDouble<1> {
    static constexpr const char* name = "exp2";
    CISTULA_HD static Input make(Draw& draw) {
        const uint32_t kind = draw.below(5);
        if (kind == 0) return {draw.centered(1100.0)};
        if (kind == 1) return {draw.scaled<double>(-70, -1)};
        if (kind == 2) return {0.5 * draw.between(-2200, 2200)};
        if (kind == 3) return {draw.near(0.5 * draw.between(1, 2200), 1)};
        return {draw.any<double>()};
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::exp2(in.x)); }
};

/// An argument of a logarithm: near 1, near sqrt(1/2) times powers of two, or anything.
CISTULA_HD inline double logarithm_input(Draw& draw) {
    switch (draw.below(5)) {
        case 0:
            return draw.any<double>();
        case 1:
            return draw.near(1.0, 1000);
        case 2: {
            const double power = two_to<double>(draw.between(-1022, 1022));
            return draw.near(0x1.6a09e667f3bcdp+0, 3) * power;
        }
        case 3:
            return draw.unit<double>();
        default:
            return magnitude(draw.scaled<double>(-1022, 1023));
    }
}
CISTULA_HD inline double positive_input(Draw& draw) {
    const double x = magnitude(logarithm_input(draw));
    return x > 0 && x < RealTraits<double>::infinity ? x : 0x1p-1074;
}

struct Log2Case : OfDouble<1> {
    static constexpr const char* name = "log2";
    CISTULA_HD static Input make(Draw& draw) { return {logarithm_input(draw)}; }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::log2(in.x)); }
};

struct Log2PairCase : OfDouble<2> {
    static constexpr const char* name = "log2_pair";
    CISTULA_HD static Input make(Draw& draw) { return {positive_input(draw)}; }
    CISTULA_HD static void run(const Input& in, Words& out) { out.pair(elementary::log2_pair(in.x)); }
};

struct PowCase : CaseOf<double, 1> {
    static constexpr const char* name = "pow";
    struct Input {
        double x, y;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        switch (draw.below(5)) {
            case 0:
                in.x = 4 * draw.unit<double>();
                in.y = draw.centered(40.0);
                break;
            case 1:  // near 1, to a great power
                in.x = draw.near(1.0, 100000);
                in.y = draw.scaled<double>(30, 60);
                break;
            case 2:  // exact results
                in.x = draw.between(0, 50);
                in.y = draw.between(-20, 40);
                break;
            case 3: {  // results at the ends of the range
                const int exponent = draw.between(1, 100);
                in.x = magnitude(draw.scaled<double>(exponent, exponent));
                const double ends[] = {-1080, -1075, -1074, -1022, 1023, 1024, 1025};
                const double end = ends[draw.below(7)];
                in.y = end / (exponent + draw.unit<double>());
                break;
            }
            default:
                in.x = draw.any<double>();
                in.y = draw.any<double>();
        }
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::pow(in.x, in.y)); }
};

/// An angle: near multiples of a quarter turn, near the limit between the two reductions, or huge.
CISTULA_HD inline double angle_input(Draw& draw) {
    switch (draw.below(6)) {
        case 0:
            return draw.centered(10.0);
        case 1: {
            const double angle = draw.between(-1000000, 1000000) * 0x1.921fb54442d18p+0;
            return draw.near(angle == 0 ? 0x1p-27 : angle, 3);
        }
        case 2:
            return draw.scaled<double>(-40, 40);
        case 3:
            return draw.scaled<double>(25, 1023);
        case 4:
            return draw.near(0x1p30, 3);
        default:
            return draw.any<double>();
    }
}

struct SinCase : OfDouble<1> {
    static constexpr const char* name = "sin";
    CISTULA_HD static Input make(Draw& draw) { return {angle_input(draw)}; }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::sin(in.x)); }
};
struct CosCase : OfDouble<1> {
    static constexpr const char* name = "cos";
    CISTULA_HD static Input make(Draw& draw) { return {angle_input(draw)}; }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::cos(in.x)); }
};
struct TanCase : OfDouble<1> {
    static constexpr const char* name = "tan";
    CISTULA_HD static Input make(Draw& draw) { return {angle_input(draw)}; }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::tan(in.x)); }
};

struct SrgbCase : OfDouble<2> {
    static constexpr const char* name = "srgb";
    CISTULA_HD static Input make(Draw& draw) {
        const uint32_t kind = draw.below(4);
        if (kind == 0) return {draw.unit<double>()};
        if (kind == 1) return {draw.between(0, 255) / 255.0};
        if (kind == 2) return {draw.near(draw.one_in(2) ? 0.04045 : 0.0031308, 3)};
        return {draw.any<double>()};
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.real(elementary::srgb_to_linear(in.x));
        out.real(elementary::linear_to_srgb(in.x));
    }
};

template <class Real>
struct PowerBySquaringCase : CaseOf<Real, 1> {
    static constexpr const char* name = "power_by_squaring";
    struct Input {
        Real x;
        int n;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.x = draw.one_in(2) ? draw.unit<Real>() : draw.any<Real>();
        in.n = draw.one_in(4) ? draw.between(0, 1024) : draw.between(0, 128);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(elementary::power_by_squaring(in.x, in.n)); }
};

struct DoubleDoubleCase : CaseOf<double, 14> {
    static constexpr const char* name = "double_double";
    struct Input {
        DoubleDouble a, b;
    };
    CISTULA_HD static DoubleDouble number(Draw& draw) {
        const double high = draw.one_in(2) ? draw.scaled<double>(-4, 4) : draw.any<double>();
        return draw.one_in(4) ? DoubleDouble(high) : fast_two_sum(high, high * 0x1p-53 * draw.centered(1.0));
    }
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.a = number(draw);
        in.b = number(draw);
        if (draw.one_in(8)) in.b = -in.a;                                               // cancels
        if (draw.one_in(8)) in.b = {in.a.high, stepped(in.a.low, draw.between(0, 2))};  // differs in its last bits
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.pair(in.a + in.b);
        out.pair(in.a - in.b);
        out.pair(in.a * in.b);
        out.pair(in.a / in.b);
        out.pair(up_sqrt(in.a));
        out.pair(two_sum(in.a.high, in.b.high));
        out.real(double(in.a));
        out.bits(in.a > in.b);
    }
};

}  // namespace cistula::parity
