// Function parity, integer sums: fixed-point radiance, transmittance, absorption.
#pragma once

#include "cistula/numerics/fixed_sum.h"
#include "cistula/numerics/transmittance.h"
#include "testing/parity/function_cases_elementary.h"

namespace cistula::parity {

/// A number of samples of any size.
CISTULA_HD inline uint32_t samples_input(Draw& draw) {
    switch (draw.below(3)) {
        case 0:
            return uint32_t(draw.between(1, 256));
        case 1:
            return uint32_t(1) << draw.below(32);
        default:
            return uint32_t(draw.shifted(32, 63)) | 1u;
    }
}

template <class Real>
struct ToFixedCase {
    static constexpr const char* name = "to_fixed";
    using Number = Real;
    struct Input {
        Real x;
        uint32_t samples;
    };
    static constexpr int words = 5;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.samples = samples_input(draw);
        switch (draw.below(5)) {
            case 0:
                in.x = draw.unit<Real>();
                break;
            case 1:
                in.x = magnitude(draw.scaled<Real>(-70, -1));
                break;
            case 2:
                in.x = draw.near(Real(1), 3);
                break;
            case 3: {  // whole numbers of steps, and beside them
                const double steps = draw.between(0, 1000) * elementary::power_of_two(-fixed_shift(in.samples));
                in.x = steps > 0 ? draw.near(Real(steps), 2) : Real(0);
                break;
            }
            default:
                in.x = draw.any<Real>();
        }
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const int shift = fixed_shift(in.samples);
        const double scale = fixed_scale(shift);
        int64_t down = -1, up = -1;  // a refused value leaves these unchanged
        const bool down_fits = to_fixed(in.x, scale, down), up_fits = to_fixed_up(in.x, scale, up);
        out.bits(down_fits);
        out.bits(uint64_t(down));
        out.bits(up_fits);
        out.bits(uint64_t(up));
        out.bits(uint64_t(shift));
    }
};

template <class Real>
struct ResolveCase {
    static constexpr const char* name = "resolve";
    using Number = Real;
    struct Input {
        int64_t sum;
        uint32_t samples;
        int shift, radiance_exponent;
    };
    static constexpr int words = 3;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.samples = samples_input(draw);
        in.shift = fixed_shift(in.samples);
        in.sum = int64_t(draw.shifted(1, 63));
        if (draw.one_in(3)) {  // halves
            const int64_t whole = int64_t(draw.shifted(34, 63));
            in.sum = whole * in.samples + in.samples / 2;
        }
        in.radiance_exponent = draw.one_in(2) ? draw.between(-1900, 1900) : draw.between(-8, 8);
        if (draw.one_in(4)) {  // the largest and the smallest numbers
            const int end = draw.sign() * Layout<Real>::bias;
            in.radiance_exponent = end + draw.between(-70, 70);
        }
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const int64_t mean = mean_of(in.sum, in.samples);
        out.bits(uint64_t(mean));
        out.real(resolve_mean<Real>(mean, in.shift, in.radiance_exponent));
        out.real(resolve<Real>(in.sum, in.shift, in.samples, in.radiance_exponent));
    }
};

struct LossCase {
    static constexpr const char* name = "loss_of";
    using Number = double;
    using Input = OneDouble;
    static constexpr int words = 1;
    CISTULA_HD static Input make(Draw& draw) {
        double x = positive_input(draw);
        if (x > 1) x = 1 / x;
        return {x > 0 ? x : 1};
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.bits(loss_of(in.x)); }
};

template <class Real>
struct TransmittanceCase {
    static constexpr const char* name = "share_of";
    using Number = Real;
    struct Input {
        uint64_t loss;
    };
    static constexpr int words = 1;
    CISTULA_HD static Input make(Draw& draw) {
        constexpr int last = Layout<Real>::bias - 1;  // the greatest loss with a transmittance above 0
        const uint64_t near = uint64_t(int64_t(draw.between(-3, 3)));
        switch (draw.below(6)) {
            case 0:
                return {draw.bits()};
            case 1:
                return {draw.shifted(0, 63)};
            case 2:
                return {(uint64_t(draw.one_in(8) ? 0 : draw.between(0, last + 10)) << 52) + near};
            case 3:
                return {(uint64_t(2 * draw.between(0, last) + 1) << 51) + near};
            case 4:
                return {(uint64_t(last) << 52) + uint64_t(int64_t(draw.between(-99, 99)))};
            default:
                return {draw.bits() >> (sizeof(Real) == sizeof(float) ? 5 : 2)};
        }
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(transmittance_of<Real>(in.loss)); }
};

struct AbsorptionCase {
    static constexpr const char* name = "absorption_loss";
    using Number = double;
    using Input = OneDouble;
    static constexpr int words = 2;
    CISTULA_HD static Input make(Draw& draw) {
        switch (draw.below(5)) {
            case 0:
                return {draw.unit<double>() * 10};
            case 1:
                return {draw.near(0x1.62e42fefa39efp+11, 100)};  // 4096 ln 2, where it saturates
            case 2:
                return {draw.scaled<double>(-60, 32)};
            case 3:
                return {draw.near(draw.one_in(2) ? 0x1p30 : -0x1p30, 3)};
            default:
                return {draw.any<double>()};
        }
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.bits(absorption_loss(in.x));
        out.bits(uint64_t(absorption_fixed(in.x)));
    }
};

struct PathSumCase {
    static constexpr const char* name = "path_sum";
    using Number = double;
    static constexpr int terms = 4;
    struct Input {
        int sign[terms];
        double sigma[terms], length[terms], farthest;
    };
    static constexpr int words = 2;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.farthest = 4 + 4 * draw.unit<double>();
        for (int i = 0; i < terms; ++i) {
            in.sign[i] = draw.one_in(2) ? 1 : -1;
            in.sigma[i] = draw.one_in(4) ? magnitude(draw.any<double>()) : magnitude(draw.scaled<double>(-10, 10));
            in.length[i] = draw.one_in(4) ? draw.any<double>() : 8 * draw.unit<double>();
        }
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        PathSum path;
        for (int i = 0; i < terms; ++i) path.add(in.sign[i], in.sigma[i], in.length[i], in.farthest);
        out.bits(path.sum);
        out.bits(path.loss());
    }
};

}  // namespace cistula::parity
