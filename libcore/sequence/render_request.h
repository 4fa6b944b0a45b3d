// What is asked of a render, and the table of its keys: command lines, suite.json and headers take names, values, help
// and words of errors from it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/view/picture_view.h"
#include "render/picture_size.h"
#include "render/record/film_picture.h"
#include "render/record/split_picture.h"
#include "render/renderer.h"
#include "scene/readers/scene_keys.h"
#include "sequence/backends.h"
#include "sequence/sequence_events.h"

namespace cistula {

class JsonValue;

struct RenderRequest {
    std::string scene;        // "-": standard input
    std::string output;       // as given; empty: default_output
    std::vector<int> frames;  // empty: none given
    Backend backend = Backend::embree;
    DeviceChoice devices;  // for the CUDA backend
    /// What frames are rendered with. Size, supersample and depth 0, and a cutoff below 0: as the scene says.
    FrameSettings frame = {.full_width = 0, .full_height = 0, .supersample = 0, .depth = 0, .cutoff = -1};
    std::optional<TileGrid> tiles;       // over the crop or the full frame
    std::optional<int> tile;             // the one to render; none: all pixels
    std::optional<Precision> precision;  // none: the scene decides (choose_precision)
    int threads = 0;                     // 0: one per core
    double texture_gb = 0;               // for all textures; 0: default_texture_bytes()
    std::string layers;                  // as given
    OutputChannels channels = {.space = &color_spaces().front()};
    bool strict = false;         // values that the file's type does not hold are an error
    Split split = Split::none;   // of the layers
    std::string preview, stats;  // files, as given; empty: none
    PictureView view;            // of previews
    bool resume = false;
    bool quiet = false;
    bool verbose = false;
    ProgressStyle progress = ProgressStyle::automatic;
    std::function<void(SceneDescription&)> described;  // called with the scene once it is read; null: nothing is
};

/// What is told of a key. Other keys stand in texts as `layers` (base/error.h).
struct KeyWords {
    std::string_view shape;        // of its value in --help; empty: it has none
    std::string help;              // with the default at its end
    bool in_suite = false;         // whether a suite.json may have it
    std::string_view attribute{};  // of EXR headers, that tells it
    std::string_view needs{};      // the key that it says something of
};

/// A key: its name, its type, the numbers or names that it takes, and its words.
struct RequestKey : Key, KeyWords {
    /// Reads the value. Throws Error (usage): what would be right. Who calls it says where, and what was given.
    std::function<void(RenderRequest&, const std::string&)> set;
    /// The value as set() takes it; empty where there is none.
    std::function<std::string(const RenderRequest&)> text;

    /// Whether a request has another value than by default.
    bool given(const RenderRequest& request) const { return text(request) != text(RenderRequest()); }
};

/// The table, in the order in which options are read and --help lists them.
const std::vector<RequestKey>& request_keys();
const RequestKey& request_key(std::string_view name);

/// Reads a value in JSON. Throws Error (usage): the place, the value and what would be right.
void read_key(RenderRequest& request, const RequestKey& key, const JsonValue& value);

/// How JSON names keys: "depth" in double quotes.
std::string quoted_name(std::string_view key);

/// Throws Error (usage) for keys that say nothing of what is rendered, or do not fit together.
void check_request(const RenderRequest& request);

/// Reads the scene, and adds what the request says about reading it. Throws Error.
SceneDescription read_scene(const RenderRequest& request);

/// The settings of every frame: the request's, and where it has none the scene's. Throws Error (usage) if the crop is
/// not inside the frame.
FrameSettings frame_settings(const RenderRequest& request, const SceneDescription& scene);

/// Opens the view of a config that `view` names, if it does. Returns a warning, or nothing. Throws Error: usage for an
/// unknown view, with those that exist; file where the config cannot be used.
std::string open_config_view(PictureView& view);

}  // namespace cistula
