// Function parity, integer sums: fixed-point radiance, transmittance, absorption.
#pragma once

#include "cistula/numerics/fixed_sum.h"
#include "cistula/numerics/transmittance.h"
#include "testing/parity/function_cases_elementary.h"

namespace cistula::parity {

/// A number of samples of any size.
CISTULA_HD inline uint32_t samples_input(Draw& draw) {
    const uint32_t kind = draw.below(3);
    if (kind == 0) return uint32_t(draw.between(1, 256));
    if (kind == 1) return uint32_t(1) << draw.below(32);
    return uint32_t(draw.shifted(32, 63)) | 1u;
}

template <class Real>
struct ToFixedCase : CaseOf<Real, 5> {
    static constexpr const char* name = "to_fixed";
    struct Input {
        Real x;
        uint32_t samples;
    };
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
struct ResolveCase : CaseOf<Real, 3> {
    static constexpr const char* name = "resolve";
    struct Input {
        int64_t sum;
        uint32_t samples;
        int shift, radiance_exponent;
    };
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

struct LossCase : OfDouble<1> {
    static constexpr const char* name = "loss_of";
    CISTULA_HD static Input make(Draw& draw) {
        double x = positive_input(draw);
        if (x > 1) x = 1 / x;
        return {x > 0 ? x : 1};
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.bits(loss_of(in.x)); }
};

template <class Real>
struct TransmittanceCase : CaseOf<Real, 1> {
    static constexpr const char* name = "share_of";
    struct Input {
        uint64_t loss;
    };
    CISTULA_HD static Input make(Draw& draw) {
        constexpr int last = Layout<Real>::bias - 1;  // the greatest loss with a transmittance above 0
        const uint64_t near = uint64_t(int64_t(draw.between(-3, 3)));
        const uint32_t kind = draw.below(6);
        if (kind == 0) return {draw.bits()};
        if (kind == 1) return {draw.shifted(0, 63)};
        if (kind == 2) return {(uint64_t(draw.one_in(8) ? 0 : draw.between(0, last + 10)) << 52) + near};
        if (kind == 3) return {(uint64_t(2 * draw.between(0, last) + 1) << 51) + near};
        if (kind == 4) return {(uint64_t(last) << 52) + uint64_t(int64_t(draw.between(-99, 99)))};
        return {draw.bits() >> (sizeof(Real) == sizeof(float) ? 5 : 2)};
    }
    CISTULA_HD static void run(const Input& in, Words& out) { out.real(transmittance_of<Real>(in.loss)); }
};

struct AbsorptionCase : OfDouble<2> {
    static constexpr const char* name = "absorption_loss";
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

struct PathSumCase : CaseOf<double, 2> {
    static constexpr const char* name = "path_sum";
    static constexpr int terms = 4;
    struct Input {
        int sign[terms];
        double sigma[terms], length[terms], farthest;
    };
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
