#include <algorithm>
#include <cstring>
#include <iterator>

#include "render/record/film_channel.h"
#include "scene/description/light_group.h"

namespace cistula {
namespace {

constexpr const char* rgb[] = {"R", "G", "B"};

/// The channels of a layer whose sums begin at word `place` of each pixel. `background`: the layer of the background,
/// from which a transparent one leaves out what samples that meet nothing add.
void add_sums(std::vector<LayeredPicture::Channel>& to, const Film& film, const OutputChannels& channels,
              const std::shared_ptr<const FilmColors>& colors, const std::string& name, int place, bool background) {
    const auto sums = [&film, colors, place, background](size_t pixel, int c) {
        const int64_t* words = film.layers.of(pixel) + place;
        int64_t own[3];
        for (int k = 0; k < 3; ++k) own[k] = words[k] - (background ? colors->left_out(pixel, k) : 0);
        return colors->radiance(own, c);
    };
    for (int c = 0; c < 3; ++c)
        to.push_back(
            film_channel(name + '.' + rgb[c], channels.half, [sums, c](size_t pixel) { return sums(pixel, c); }));
}

/// A channel of what a pixel's middle sample met first.
template <class Value>
LayeredPicture::Channel first_hit_channel(const Film& film, std::string name, bool half, Value value) {
    return film_channel(std::move(name), half, [&film, value](size_t pixel) {
        FirstHit hit;
        std::memcpy(&hit, film.layers.of(pixel) + film.layers.plan.first_hit, sizeof hit);
        return value(hit);
    });
}

}  // namespace

std::vector<LayeredPicture::Channel> layer_channels(const Film& film, const OutputChannels& channels,
                                                    std::shared_ptr<const FilmColors> colors) {
    std::vector<LayeredPicture::Channel> to;
    const FilmLayers& layers = film.layers;
    for (int layer = 0; layer < path_layer_count; ++layer)
        if (channels.path[layer])
            add_sums(to, film, channels, colors, path_layer_names[layer], layers.plan.path + 3 * layer,
                     layer == static_cast<int>(PathLayer::background));
    if (channels.light) {
        int place = layers.plan.light;
        const auto add = [&](std::string_view name) {
            const std::vector<std::string>& wanted = channels.light_layers;
            const bool background = place == layers.plan.light + 3 * static_cast<int>(LightLayer::environment);
            if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end())
                add_sums(to, film, channels, colors, std::string(light_layer_prefix).append(name), place, background);
            place += 3;
        };
        static_assert(std::size(common_light_layer_names) == common_light_layers);
        for (const std::string_view name : common_light_layer_names) add(name);
        for (const std::string& group : layers.names->light_groups) add(group);
    }
    const char axes[] = "XYZ";
    for (int c = 0; c < 3 && channels.position; ++c)
        to.push_back(first_hit_channel(film, std::string("P.") + axes[c], false, [&layers, c](const FirstHit& hit) {
            return hit.object == 0 ? 0.0f : static_cast<float>(layers.center[c] + hit.position[c] * layers.unit_length);
        }));
    for (int c = 0; c < 2 && channels.uv; ++c)
        to.push_back(
            first_hit_channel(film, c == 0 ? "uv.U" : "uv.V", false, [c](const FirstHit& hit) { return hit.uv[c]; }));
    for (int c = 0; c < 3 && channels.albedo; ++c)
        to.push_back(
            first_hit_channel(film, std::string("albedo.") + rgb[c], channels.half,
                              [colors, c](const FirstHit& hit) { return colors->reflectance(hit.albedo, c); }));
    if (channels.depth_ray)
        to.push_back(first_hit_channel(film, "depth_ray", false, [far = channels.z_far](const FirstHit& hit) {
            return hit.object == 0 ? far : hit.distance;
        }));
    if (channels.material_id)
        to.push_back(first_hit_channel(film, "material_id", false,
                                       [](const FirstHit& hit) { return static_cast<float>(hit.material); }));
    return to;
}

}  // namespace cistula
