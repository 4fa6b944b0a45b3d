#include "scene/film/film_picture.h"

#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "cistula/numerics/elementary.h"
#include "cistula/numerics/fixed_sum.h"
#include "scene/base/fnv128.h"

namespace cistula {
namespace {

void check(const Film& film) {
    if (film.samples < 1 || film.rect.width < 1 || film.rect.height < 1 ||
        film.pixels.size() != static_cast<size_t>(film.rect.width) * static_cast<size_t>(film.rect.height))
        throw std::invalid_argument("a film has samples, and as many pixels as its rectangle");
}

template <class Real = float>
Real radiance(const Film& film, int64_t sum) {
    return resolve<Real>(sum, film.fixed_shift, static_cast<uint32_t>(film.samples), film.radiance_exponent);
}

/// The sum of a pixel's samples that hit something, in integers: each of the others added the same.
int64_t sum_of_hits(const Film& film, const PixelRecord& pixel, int c) {
    return pixel.radiance[c] - (film.samples - static_cast<int64_t>(pixel.hits)) * film.background[c];
}

/// The least float that is not below `exact`, which must be >= 0.
float rounded_up_to_float(double exact) {
    const float nearest = static_cast<float>(exact);
    return static_cast<double>(nearest) >= exact ? nearest : bits_as<float>(bits_as<uint32_t>(nearest) + 1);
}

/// A pixel's error bound: the mean of its ledger, rounded up to a unit of the fixed sums and then to a float.
float ledger_bound(const Film& film, const PixelRecord& pixel, int c) {
    const uint64_t total = static_cast<uint64_t>(pixel.pruned[c]) + static_cast<uint64_t>(pixel.cut[c]);
    const uint64_t samples = static_cast<uint64_t>(film.samples);
    const uint64_t mean = total / samples + (total % samples != 0);
    const int width = static_cast<int>(std::bit_width(mean));
    const int dropped = width > 24 ? width - 24 : 0;
    const uint64_t kept = (mean >> dropped) + ((mean & ((uint64_t(1) << dropped) - 1)) != 0);
    const double exact =
        elementary::scaled(static_cast<double>(kept), dropped - film.fixed_shift + film.radiance_exponent);
    return rounded_up_to_float(exact);
}

/// What a file's R, G and B are of the radiance: the color space, and whether the background counts.
class Colors {
  public:
    Colors(const Film& film, const OutputChannels& channels) : film_(film), transparent_(channels.transparent) {
        const ColorSpace& own = color_spaces().front();
        if (!channels.space || channels.space->id == own.id) return;
        converts_ = true;
        matrix_ = color_matrix(own, *channels.space);
    }

    float radiance(const PixelRecord& pixel, int c) const {
        if (!converts_) return cistula::radiance(film_, sum(pixel, c));
        double value = 0;
        for (int k = 0; k < 3; ++k) value += matrix_[k][c] * cistula::radiance<double>(film_, sum(pixel, k));
        return static_cast<float>(value);
    }

    /// A bound on the error of radiance() from the ledger.
    float error(const PixelRecord& pixel, int c) const {
        if (!converts_) return ledger_bound(film_, pixel, c);
        double value = 0;
        for (int k = 0; k < 3; ++k)
            value += magnitude(matrix_[k][c]) * static_cast<double>(ledger_bound(film_, pixel, k));
        return rounded_up_to_float(value * (1 + 0x1p-50));  // five roundings of double
    }

  private:
    int64_t sum(const PixelRecord& pixel, int c) const {
        return transparent_ ? sum_of_hits(film_, pixel, c) : pixel.radiance[c];
    }

    const Film& film_;
    bool transparent_, converts_ = false;
    glm::dmat3 matrix_{1.0};
};

/// The smallest half that is not below `value`, which must be >= 0.
float rounded_up_to_half(float value) {
    half nearest(value);
    if (static_cast<float>(nearest) < value) nearest.setBits(static_cast<uint16_t>(nearest.bits() + 1));
    return static_cast<float>(nearest);
}

/// Brings values to the largest half at most. Returns how many were over it.
uint64_t clamp_to_half(float* begin, const float* end) {
    uint64_t count = 0;
    for (float* value = begin; value != end; ++value) {
        count += *value > largest_half;
        *value = std::min(*value, largest_half);
    }
    return count;
}

/// What headers say of channels: the color space, and what is not the default.
decltype(LayeredPicture::attributes) attributes_of(const OutputChannels& channels) {
    const ColorSpace& space = channels.space ? *channels.space : color_spaces().front();
    std::vector<float> chromaticities;
    for (const auto* xy : {space.red, space.green, space.blue, space.white})
        for (int i = 0; i < 2; ++i) chromaticities.push_back(static_cast<float>(xy[i]));
    decltype(LayeredPicture::attributes) attributes = {{"chromaticities", chromaticities},
                                                       {"colorInteropID", std::string(space.id)}};
    if (space.id == "lin_ap0_scene" && channels.half && channels.compression == Compression::none)
        attributes["acesImageContainerFlag"] = 1;
    if (channels.transparent) attributes["cistula:background"] = std::string("transparent");
    if (channels.z && channels.z_far != OutputChannels().z_far)
        attributes["cistula:zFar"] = static_cast<double>(channels.z_far);
    return attributes;
}

}  // namespace

LayeredPicture to_layers(const Film& film, const OutputChannels& channels, uint64_t* clamped) {
    check(film);
    LayeredPicture picture;
    picture.width = film.rect.width;
    picture.height = film.rect.height;
    picture.x = film.rect.x;
    picture.y = film.rect.y;
    picture.display_width = film.full_width;
    picture.display_height = film.full_height;
    picture.attributes = attributes_of(channels);
    picture.compression = channels.compression;
    picture.dwa_level = channels.dwa_level;
    const bool half = channels.half;
    const auto add = [&](const char* name, bool as_half) { picture.channels.push_back({name, as_half, {}}); };
    for (const char* name : {"R", "G", "B", "A"}) add(name, half);
    if (channels.coverage) add("coverage", half);
    for (const char* name : {"error.R", "error.G", "error.B"})
        if (channels.error) add(name, half);
    if (channels.id) add("id", false);
    if (channels.samples) add("samples", false);
    if (channels.cost) add("cost", false);
    if (channels.z) add("Z", false);
    for (const char* name : {"N.X", "N.Y", "N.Z"})
        if (channels.normal) add(name, half);
    for (LayeredPicture::Channel& channel : picture.channels) channel.values.resize(film.pixels.size());

    // All channels of one block of pixels before the next block, while its pixels are still in a cache.
    constexpr size_t block = 1024;
    uint64_t over = 0;
    const Colors colors(film, channels);
    const auto coverage = [&film](const PixelRecord& pixel) {
        return static_cast<float>(static_cast<double>(pixel.hits) / film.samples);
    };
    for (size_t begin = 0; begin < film.pixels.size(); begin += block) {
        const PixelRecord* first = film.pixels.data() + begin;
        const PixelRecord* last = first + std::min(block, film.pixels.size() - begin);
        size_t next = 0;
        const auto fill = [&](const auto& value) {
            LayeredPicture::Channel& channel = picture.channels[next++];
            float *start = channel.values.data() + begin, *to = start;
            for (const PixelRecord* pixel = first; pixel != last; ++pixel) *to++ = value(*pixel);
            if (channel.half) over += clamp_to_half(start, to);
        };
        for (int c = 0; c < 3; ++c) fill([&colors, c](const PixelRecord& pixel) { return colors.radiance(pixel, c); });
        if (channels.transparent)
            fill(coverage);
        else
            fill([](const PixelRecord&) { return 1.0f; });
        if (channels.coverage) fill(coverage);
        for (int c = 0; c < 3 && channels.error; ++c)
            fill([&colors, c, half](const PixelRecord& pixel) {
                const float bound = colors.error(pixel, c);
                return half ? rounded_up_to_half(bound) : bound;
            });
        if (channels.id) fill([](const PixelRecord& pixel) { return static_cast<float>(pixel.id); });
        if (channels.samples) fill([](const PixelRecord& pixel) { return static_cast<float>(pixel.samples); });
        if (channels.cost) fill([](const PixelRecord& pixel) { return static_cast<float>(pixel.rays); });
        if (channels.z)
            fill([&channels](const PixelRecord& pixel) { return std::isinf(pixel.z) ? channels.z_far : pixel.z; });
        for (int c = 0; c < 3 && channels.normal; ++c) fill([c](const PixelRecord& pixel) { return pixel.normal[c]; });
    }
    if (clamped) *clamped += over;
    return picture;
}

ColorPicture to_color(const Film& film) {
    check(film);
    ColorPicture picture;
    picture.width = static_cast<uint32_t>(film.rect.width);
    picture.height = static_cast<uint32_t>(film.rect.height);
    picture.texels.reserve(film.pixels.size());
    for (const PixelRecord& pixel : film.pixels)
        picture.texels.emplace_back(radiance(film, pixel.radiance[0]), radiance(film, pixel.radiance[1]),
                                    radiance(film, pixel.radiance[2]));
    return picture;
}

std::string film_hash(const Film& film) {
    Fnv128 hash;
    for (const PixelRecord& pixel : film.pixels) {
        for (const int64_t value : pixel.radiance) hash.add(value);
        for (const int64_t value : pixel.pruned) hash.add(value);
        for (const int64_t value : pixel.cut) hash.add(value);
        hash.add(pixel.hits);
        hash.add(pixel.rays);
        hash.add(pixel.id);
        hash.add(pixel.z);
        for (const float value : pixel.normal) hash.add(value);
    }
    return hash.hex();
}

}  // namespace cistula
