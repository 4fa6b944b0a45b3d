#include "render/record/film_picture.h"

#include <Imath/half.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "base/default_rounding.h"
#include "base/fnv128.h"
#include "render/record/film_channel.h"
#include "scene/description/light_group.h"

namespace cistula {
namespace {

void check(const Film& film) {
    if (film.samples < 1 || film.rect.width < 1 || film.rect.height < 1 ||
        film.pixels.size() != static_cast<size_t>(film.rect.width) * static_cast<size_t>(film.rect.height))
        throw std::invalid_argument("a film has samples, and as many pixels as its rectangle");
}

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
    if (is_dwa(channels.compression)) attributes["cistula:dwaLevel"] = static_cast<double>(channels.dwa_level);
    if (channels.transparent) attributes["cistula:background"] = std::string("transparent");
    if (channels.z && channels.z_far != OutputChannels().z_far)
        attributes["cistula:zFar"] = static_cast<double>(channels.z_far);
    return attributes;
}

/// The film's own channels, in the order of the file.
std::vector<LayeredPicture::Channel> pixel_channels(const Film& film, const OutputChannels& channels,
                                                    const std::shared_ptr<const FilmColors>& colors) {
    const bool half = channels.half;
    const FilmPixels& pixels = film.pixels;
    const auto coverage = [&film](size_t pixel) {
        return static_cast<float>(static_cast<double>(film.pixels.radiance(pixel).hits) / film.samples);
    };
    std::vector<LayeredPicture::Channel> to;
    const char* const rgb[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        to.push_back(film_channel(rgb[c], half, [&pixels, colors, c](size_t pixel) {
            const PixelRadiance& of = pixels.radiance(pixel);
            int64_t sums[3];
            for (int k = 0; k < 3; ++k) sums[k] = of.radiance[k] - colors->left_out(pixel, k);
            return colors->radiance(sums, c);
        }));
    if (channels.transparent)
        to.push_back(film_channel("A", half, coverage));
    else
        to.push_back(film_channel("A", half, [](size_t) { return 1.0f; }));
    if (channels.coverage) to.push_back(film_channel("coverage", half, coverage));
    for (int c = 0; c < 3 && channels.error; ++c)
        to.push_back(film_channel(std::string("error.") + rgb[c], half, [&pixels, colors, c, half](size_t pixel) {
            const float bound = colors->error(pixels[pixel], c);
            return half ? rounded_up_to_half(bound) : bound;
        }));
    const auto add = [&](const char* name, bool wanted, auto value) {
        if (wanted)
            to.push_back(film_channel(name, false, [value](size_t pixel) { return static_cast<float>(value(pixel)); }));
    };
    add("id", channels.id, [&pixels](size_t pixel) { return pixels.sight(pixel).id; });
    add("samples", channels.samples, [&pixels](size_t pixel) { return pixels.radiance(pixel).samples; });
    add("cost", channels.cost, [&pixels](size_t pixel) { return pixels.sight(pixel).rays; });
    add("Z", channels.z, [&pixels, far = channels.z_far](size_t pixel) {
        const float z = pixels.sight(pixel).z;
        return std::isinf(z) ? far : z;
    });
    const char* const axes[] = {"N.X", "N.Y", "N.Z"};
    for (int c = 0; c < 3 && channels.normal; ++c)
        to.push_back(film_channel(axes[c], half, [&pixels, c](size_t pixel) { return pixels.sight(pixel).normal[c]; }));
    return to;
}

}  // namespace

LayeredPicture channels_of(const Film& film, const OutputChannels& channels, std::atomic<uint64_t>* clamped) {
    check(film);
    const KeptParts wanted = parts_for(channels);
    const KeptParts kept = film.pixels.parts();
    if (wanted.losses > kept.losses || wanted.sights > kept.sights)
        throw std::invalid_argument("a film keeps the parts of its pixels that its channels are made of");
    LayeredPicture picture;
    picture.width = film.rect.width;
    picture.height = film.rect.height;
    picture.x = film.rect.x;
    picture.y = film.rect.y;
    picture.display_width = film.full_width;
    picture.display_height = film.full_height;
    picture.attributes = attributes_of(channels);
    if (channels.light)
        picture.attributes[light_layer_count] =
            static_cast<int>(std::size(common_light_layer_names) + film.layers.names->light_groups.size());
    for (const auto& [name, text] : cryptomatte_attributes(film, channels)) picture.attributes[name] = text;
    picture.compression = channels.compression;
    picture.dwa_level = channels.dwa_level;
    const auto colors = std::make_shared<const FilmColors>(film, channels);
    picture.channels = pixel_channels(film, channels, colors);
    for (auto& more : {layer_channels(film, channels, colors), cryptomatte_channels(film, channels)})
        picture.channels.insert(picture.channels.end(), more.begin(), more.end());
    for (LayeredPicture::Channel& channel : picture.channels)
        if (channel.half)
            channel.write = [write = std::move(channel.write), clamped](size_t first, size_t last, float* to) {
                write(first, last, to);
                const uint64_t over = clamp_to_half(to, to + (last - first));
                if (clamped && over != 0) *clamped += over;
            };
    set_container_flag(picture);
    return picture;
}

LayeredPicture to_layers(const Film& film, const OutputChannels& channels, uint64_t* clamped) {
    std::atomic<uint64_t> over{0};
    LayeredPicture picture = channels_of(film, channels, &over);
    for (LayeredPicture::Channel& channel : picture.channels) channel.values.resize(film.pixels.size());
    // All channels of one block of pixels before the next block, while its pixels are still in a cache.
    constexpr size_t block = 1024;
    tbb::parallel_for(size_t{0}, (film.pixels.size() + block - 1) / block, [&](size_t number) {
        const DefaultRounding rounding;
        const size_t first = number * block;
        const size_t last = std::min(first + block, film.pixels.size());
        for (LayeredPicture::Channel& channel : picture.channels)
            channel.write(first, last, channel.values.data() + first);
    });
    for (LayeredPicture::Channel& channel : picture.channels) channel.write = {};
    if (clamped) *clamped += over;
    return picture;
}

void set_container_flag(LayeredPicture& picture) {
    picture.attributes.erase("acesImageContainerFlag");
    const auto id = picture.attributes.find("colorInteropID");
    const bool is_color = std::all_of(picture.channels.begin(), picture.channels.end(), [](const auto& channel) {
        return channel.half && channel.name.size() == 1 && std::string("RGBA").find(channel.name) != std::string::npos;
    });
    if (is_color && id != picture.attributes.end() && std::get<std::string>(id->second) == "lin_ap0_scene" &&
        picture.compression == Compression::none)
        picture.attributes["acesImageContainerFlag"] = 1;
}

LayerRequest layers_for(const OutputChannels& channels) {
    LayerRequest request;
    for (const bool wanted : channels.path) request.path |= wanted;
    request.light = channels.light;
    request.first_hit =
        channels.position || channels.uv || channels.albedo || channels.depth_ray || channels.material_id;
    request.objects = channels.object_mattes || channels.material_mattes || channels.light_mattes;
    return request;
}

KeptParts parts_for(const OutputChannels& channels) {
    return {channels.error, channels.error || channels.id || channels.cost || channels.z || channels.normal};
}

ColorPicture to_color(const Film& film, bool transparent) {
    check(film);
    OutputChannels channels;
    channels.transparent = transparent;
    const FilmColors colors(film, channels);
    ColorPicture picture;
    picture.width = static_cast<uint32_t>(film.rect.width);
    picture.height = static_cast<uint32_t>(film.rect.height);
    picture.texels.reserve(film.pixels.size());
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelRadiance& pixel = film.pixels.radiance(i);
        int64_t sums[3];
        for (int c = 0; c < 3; ++c) sums[c] = pixel.radiance[c] - colors.left_out(i, c);
        picture.texels.emplace_back(colors.radiance(sums, 0), colors.radiance(sums, 1), colors.radiance(sums, 2));
        if (!transparent) continue;
        picture.alpha.push_back(static_cast<float>(pixel.hits) / static_cast<float>(film.samples));
        if (pixel.hits > 0) picture.texels.back() /= picture.alpha.back();
    }
    return picture;
}

std::string film_hash(const Film& film) {
    Fnv128 hash;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelRadiance& pixel = film.pixels.radiance(i);
        for (const int64_t value : pixel.radiance) hash.add(value);
        hash.add(pixel.hits);
        hash.add(uint32_t{pixel.samples});
    }
    return hash.hex();
}

}  // namespace cistula
