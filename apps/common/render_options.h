// The command line of `render`, parsed and checked as far as possible without the scene. `render-farm` takes it, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/common/status_line.h"
#include "render/picture_size.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "sequence/film_options.h"
#include "sequence/frame_list.h"

namespace CLI {
class App;
}

namespace cistula {

struct ChosenPixel {
    int x = 0, y = 0;  // from the top left of the full frame
};

enum class Action { render, explain, measure, pixel, print_help, print_version, print_template, list_devices };

struct RenderOptions : FilmOptions {
    std::optional<Precision> wanted_precision;  // none: auto, which the scene decides (precision_choice.h)
    Action action = Action::render;
    std::string scene;        // "-": standard input
    std::string layers;       // as given; empty: none
    std::string output;       // as given; empty: default_output
    std::string preview;      // as given; empty: none
    std::vector<int> frames;  // empty: none given
    DeviceChoice devices;     // for the CUDA backend
    std::optional<PictureSize> resolution;
    std::optional<PixelRect> crop;
    TileGrid tiles;           // over the crop or the full frame
    std::optional<int> tile;  // the one to render; none: all pixels
    ChosenPixel pixel;        // for Action::pixel
    std::string json;         // for Action::pixel: a file, "-" or empty
    std::optional<int> supersample, depth;
    std::optional<double> cutoff, target_error;
    std::optional<int> max_samples;  // for a target error
    bool quiet = false, verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
    bool all_effects = false;               // --effects all
    int threads = 0;                        // 0: one per core
    int lanes = 0;                          // 0: as many as can be
    std::optional<uint64_t> texture_bytes;  // --max-texture-gb
};

inline constexpr int largest_supersample = 64;  // k

/// Adds render's options to a command line; `options` must outlive it.
void declare_render_options(CLI::App& app, RenderOptions& options);

/// Checks how the options that were given fit together, whatever --tiles. Throws Error (usage).
void check_render_options(const CLI::App& app, RenderOptions& options);

/// Whether a compression is one of those that lose something.
constexpr bool is_dwa(Compression compression) {
    return compression == Compression::dwaa || compression == Compression::dwab;
}
inline constexpr const char* why_no_dwa_of_tiles = "a tile would lose something else than the whole frame does";

/// Parses the command line. Throws Error (usage); the message names the option, what is wrong and what would be right.
RenderOptions parse_options(int argc, const char* const* argv);

/// The output of --help: options, examples, exit codes.
std::string help_text();

/// Parses "X,Y". Throws Error (usage).
ChosenPixel parse_pixel(std::string_view text);

/// Reads the scene, and adds what options say about reading it. Throws Error.
SceneDescription read_scene(const RenderOptions& options);

/// The settings of every frame: the scene's film, depth and cutoff unless options override them. Throws Error (usage)
/// if the crop is not inside the frame.
FrameSettings frame_settings(const RenderOptions& options, const SceneDescription& scene);

}  // namespace cistula
