// The command line of `render`, read and checked as far as it can be without the scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/common/film_options.h"
#include "apps/common/picture_size.h"
#include "scene/film/film_picture.h"
#include "scene/film/renderer.h"

namespace cistula {

struct PixelPlace {
    int x = 0, y = 0;  // from the top left of the full frame
};

enum class Action { render, explain, measure, pixel, print_help, print_version, print_template, list_devices };

struct RenderOptions : FilmOptions {
    Action action = Action::render;
    std::string scene;        // "-": standard input
    std::string output;       // as given; empty: see default_output
    std::string preview;      // as given; empty: none
    std::vector<int> frames;  // empty: none given
    DeviceChoice devices;     // of the CUDA backend
    std::optional<PictureSize> resolution;
    std::optional<PixelRect> crop;
    PixelPlace pixel;  // with Action::pixel
    std::string json;  // with Action::pixel: a file, "-" or empty
    std::optional<int> supersample, depth;
    std::optional<double> cutoff, target_error;
    std::optional<int> max_samples;  // with a target error
    bool all_effects = false;        // --effects all
    int threads = 0;                 // 0: all
};

inline constexpr int largest_supersample = 64;  // k

/// Throws Error (usage); the message names the option, what is wrong and what would be right.
RenderOptions parse_options(int argc, const char* const* argv);

/// What --help prints: the options, examples, exit codes.
std::string help_text();

/// "X,Y". Throws Error (usage).
PixelPlace parse_pixel(std::string_view text);

/// "error,id,samples,cost,Z,N", any of them. Throws Error (usage) with the nearest name for an unknown one.
OutputChannels parse_layers(std::string_view text);

/// The settings of every frame: the scene's film, depth and cutoff where no option overrides them. Throws Error
/// (usage) where the crop leaves the frame.
FrameSettings frame_settings(const RenderOptions& options, const SceneDescription& scene);

}  // namespace cistula
