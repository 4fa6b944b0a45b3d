// The golden images: their settings, and how tests render and compare them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_difference.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/description/camera_path.h"
#include "scene/description/description.h"
#include "scene/readers/read_scene.h"
#include "verify/reference_renderers.h"

namespace cistula::golden {

/// Largest size in pixels; smaller films keep theirs.
inline constexpr int width = 320, height = 180;

/// The names of all scenes in a folder and its subfolders, sorted: "benchmark" for benchmark.json, "hard/slivers" for
/// hard/slivers.json.
inline std::vector<std::string> scene_names(const std::filesystem::path& scenes) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes))
        if (entry.path().extension() == ".json")
            names.push_back(entry.path().lexically_relative(scenes).replace_extension().generic_string());
    std::sort(names.begin(), names.end());
    return names;
}

inline FrameSettings settings_for(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(std::min(width, scene.film.width), std::min(height, scene.film.height));
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

inline OutputChannels channels() {
    OutputChannels channels;
    channels.error = channels.id = channels.z = channels.normal = channels.coverage = true;
    return channels;
}

inline Film render_with(Renderer& renderer, const SceneDescription& description, const FrameSettings& settings) {
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(description.camera, 0), settings, film, progress);
    return film;
}

template <class Real>
Film render_embree(const SceneDescription& description, const EmbreeOptions& options = {}) {
    const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(description), options);
    return render_with(*renderer, description, settings_for(description));
}

/// The largest difference of two pictures of one size, and its pixel: the first by name of the channel and place.
struct Difference {
    double worst = 0;
    std::string channel;
    int x = 0, y = 0;
    size_t differing = 0;
};

inline Difference compare(const LayeredPicture& a, const LayeredPicture& b) {
    Difference result;
    auto channels = a.channels;
    std::sort(channels.begin(), channels.end(), [](const auto& x, const auto& y) { return x.name < y.name; });
    for (const auto& channel : channels) {
        const auto other =
            std::find_if(b.channels.begin(), b.channels.end(), [&](const auto& c) { return c.name == channel.name; });
        if (other == b.channels.end() || other->values.size() != channel.values.size()) {
            result.differing += channel.values.size();
            continue;
        }
        for (size_t i = 0; i < channel.values.size(); ++i) {
            const float x = channel.values[i], y = other->values[i];
            if (bits_as<uint32_t>(x) == bits_as<uint32_t>(y)) continue;
            ++result.differing;
            const double difference = x > y ? double(x) - y : double(y) - x;
            if (difference > result.worst)
                result = {difference, channel.name, int(i) % a.width, int(i) / a.width, result.differing};
        }
    }
    return result;
}

}  // namespace cistula::golden
