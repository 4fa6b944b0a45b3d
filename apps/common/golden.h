// Render settings of the golden images, for tests and render-compare.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/description/camera_path.h"
#include "scene/description/description.h"

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

}  // namespace cistula::golden
