// The channels that files are made of, whose values are made as they are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/record/film_colors.h"

namespace cistula {

/// A channel by value(pixel's number).
template <class Value>
LayeredPicture::Channel film_channel(std::string name, bool half, Value value) {
    return {std::move(name), half, {}, [value = std::move(value)](size_t first, size_t last, float* to) {
                for (size_t pixel = first; pixel != last; ++pixel) *to++ = value(pixel);
            }};
}

/// The channels of the film's layers: divisions of the radiance, and what the middle samples met first. `film` must
/// outlive them.
std::vector<LayeredPicture::Channel> layer_channels(const Film& film, const OutputChannels& channels,
                                                    std::shared_ptr<const FilmColors> colors);

/// The channels of Cryptomatte's layers (Friedman and Jones 2015; specification 1.2.0): six ranks of id and coverage.
std::vector<LayeredPicture::Channel> cryptomatte_channels(const Film& film, const OutputChannels& channels);

/// The header attributes that tell names by ids.
std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(const Film& film,
                                                                        const OutputChannels& channels);

/// MurmurHash3_x86_32 with seed 0 (Appleby, public domain).
uint32_t murmur3(std::string_view text);

/// The id of a name as Cryptomatte 1.2.0 stores it: the hash's bits as a float; an exponent of all zeros or all ones,
/// which stands for no normal number, gets its lowest bit flipped.
float cryptomatte_id(std::string_view name);

}  // namespace cistula
