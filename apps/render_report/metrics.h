// Errors of an image against a reference, in double precision from the films' integers, without rounding to float.
#pragma once

#include <array>
#include <vector>

#include "record_json.h"
#include "render/record/film.h"

namespace cistula::report {

/// The mean radiance of every pixel in the scene's units; row-major.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::array<double, 3>> pixels;
};

/// Statistics of a film's bound on truncation errors, over pixels and channels, in the scene's units of radiance.
struct Remainder {
    double mean = 0, rms = 0, max = 0;
};

/// Errors of a picture against a reference, over all channels of all pixels unless said otherwise.
struct Metrics {
    double max = 0, rmse = 0;
    double p999 = 0;               // 99.9 % of the pixels differ by at most this in any channel
    double relative_mse = 0;       // mean of (a - b)^2 / (b^2 + relative_epsilon), b the reference
    double peak = 1;               // the reference's largest value, at least 1
    double over_half_code = 0;     // share of the pixels that differ by more than 0.5/255 in some channel
    int worst_x = 0, worst_y = 0;  // pixel with the largest error, from the top left
    std::array<double, 3> worst_here{}, worst_reference{};  // the two values there

    /// Peak signal-to-noise ratio, 20 log10(peak / rmse), in dB; infinity if nothing differs.
    double psnr() const;
};

inline constexpr double relative_epsilon = 0.01;
inline constexpr double half_code = 0.5 / 255;

Picture resolve_picture(const Film& film);
Remainder remainder_of(const Film& film);

/// The metrics of two pictures of equal size.
Metrics compare_with(const Picture& picture, const Picture& reference);

/// Share of pixels that differ by more than `error` in some channel. The pictures must have equal size.
double share_over(double error, const Picture& picture, const Picture& reference);

void to_json(Json& json, const Metrics& metrics);
void from_json(const Json& json, Metrics& metrics);
CISTULA_RECORD_FIELDS(Remainder, mean, rms, max)

}  // namespace cistula::report
