#include "render/record/film_colors.h"

#include <algorithm>
#include <bit>

#include "cistula/numerics/elementary.h"
#include "cistula/numerics/fixed_sum.h"

namespace cistula {
namespace {

template <class Real = float>
Real resolved(const Film& film, int64_t sum) {
    return resolve<Real>(sum, film.fixed_shift, static_cast<uint32_t>(film.samples), film.radiance_exponent);
}

/// The least float that is not below `exact`, which must be >= 0.
float rounded_up_to_float(double exact) {
    const float nearest = static_cast<float>(exact);
    return static_cast<double>(nearest) >= exact ? nearest : bits_as<float>(bits_as<uint32_t>(nearest) + 1);
}

/// A pixel's error bound: the mean of its ledger, rounded up to a unit of the fixed sums and then to a float.
float ledger_bound(const Film& film, const PixelRecord& pixel, int c) {
    const uint64_t branches = static_cast<uint64_t>(pixel.pruned[c]) + static_cast<uint64_t>(pixel.cut[c]);
    const uint64_t total = branches + std::min(film.units_lost(pixel), ~branches);
    const uint64_t samples = static_cast<uint64_t>(film.samples);
    const uint64_t mean = total / samples + (total % samples != 0);
    const int width = static_cast<int>(std::bit_width(mean));
    const int dropped = width > 24 ? width - 24 : 0;
    const uint64_t kept = (mean >> dropped) + ((mean & ((uint64_t(1) << dropped) - 1)) != 0);
    const double exact =
        elementary::scaled(static_cast<double>(kept), dropped - film.fixed_shift + film.radiance_exponent);
    return rounded_up_to_float(exact);
}

}  // namespace

FilmColors::FilmColors(const Film& film, const OutputChannels& channels)
    : film_(film), transparent_(channels.transparent) {
    const ColorSpace& own = color_spaces().front();
    if (!channels.space || channels.space->id == own.id) return;
    converts_ = true;
    matrix_ = color_matrix(own, *channels.space);
}

float FilmColors::radiance(const int64_t (&sums)[3], int c) const {
    if (!converts_) return resolved(film_, sums[c]);
    double value = 0;
    for (int k = 0; k < 3; ++k) value += matrix_[k][c] * resolved<double>(film_, sums[k]);
    return static_cast<float>(value);
}

float FilmColors::reflectance(const float (&color)[3], int c) const {
    if (!converts_) return color[c];
    double value = 0;
    for (int k = 0; k < 3; ++k) value += matrix_[k][c] * static_cast<double>(color[k]);
    return static_cast<float>(value);
}

float FilmColors::error(const PixelRecord& pixel, int c) const {
    if (!converts_) return ledger_bound(film_, pixel, c);
    double value = 0;
    for (int k = 0; k < 3; ++k) value += magnitude(matrix_[k][c]) * static_cast<double>(ledger_bound(film_, pixel, k));
    return rounded_up_to_float(value * (1 + 0x1p-50));  // five roundings of double
}

}  // namespace cistula
