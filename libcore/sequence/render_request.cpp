#include "sequence/render_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "base/option_text.h"
#include "base/suggest.h"
#include "cistula/model/effects.h"
#include "cistula/model/lattice_settings.h"
#include "cistula/transport/ray_tree.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/read_scene.h"
#include "sequence/frame_list.h"

namespace cistula {
namespace {

using Request = RenderRequest;

constexpr bool of_suite = true;
constexpr bool not_of_suite = false;
constexpr std::string_view precision_choices[] = {"auto", "float", "double"};
constexpr std::string_view effects_choices[] = {"auto", "all"};
constexpr std::string_view bits_choices[] = {"float", "half"};
constexpr std::string_view split_choices[] = {"none", "parts", "files"};
constexpr std::string_view background_choices[] = {"opaque", "transparent"};
constexpr std::string_view progress_choices[] = {"auto", "plain", "none", "json", "openjd"};
constexpr std::string_view space_choices[] = {"lin_rec709_scene",  "lin_ap1_scene",   "lin_ap0_scene",
                                              "lin_rec2020_scene", "lin_p3d65_scene", "lin_adobergb_scene"};
const std::vector<std::string> own_views = {"srgb", "filmic"};

/// A key of the scene without its default there, since without it a request leaves the choice to the scene.
Key scene_key(const KeyTable& table, std::string_view name) {
    Key key = *table.find(name);
    key.fallback = {};
    return key;
}
Key whole(std::string_view name, double low, double high) {
    return {name, KeyType::whole, {low, high}, {}, false, {}};
}
Key number(std::string_view name, Range range) {
    return {name, KeyType::number, range, {}, false, {}};
}

// Rows by type. `at` is the member, or of() one in a member.

template <class Outer, class Inner>
auto of(Outer Request::*outer, Inner Outer::*inner) {
    return [=](auto& request) -> auto& {
        return request.*outer.*inner;
    };
}

/// A number; one that is not in the key's range stands for none.
template <class At>
RequestKey numeric(const Key& key, const KeyWords& words, At at, const std::string& takes = {}) {
    const std::string right = "must be " + (takes.empty() ? expected_text(key) : takes);
    return {key, words,
            [key, at, right](Request& request, const std::string& text) {
                std::optional<double> value = whole_number<double>(text);
                if (key.type == KeyType::whole && !whole_number<int>(text)) value.reset();  // 4.0 is a number alone
                if (!value || !key.range.contains(*value)) fail_usage("", right);
                std::invoke(at, request) =
                    static_cast<std::remove_cvref_t<std::invoke_result_t<At, Request&>>>(*value + 0.0);  // -0 becomes 0
            },
            [key, at](const Request& request) {
                return key.range.contains(double(std::invoke(at, request)))
                           ? fmt::format("{}", std::invoke(at, request))
                           : "";
            }};
}

/// One of a few names, which stand for `values`, if there are any, else for the enumerators in their order.
template <class At, class T = std::remove_cvref_t<std::invoke_result_t<At, Request&>>>
RequestKey choice(std::string_view name, std::span<const std::string_view> names, const KeyWords& words, At at,
                  std::string_view fallback = {}, std::vector<T> values = {}) {
    if constexpr (!std::is_class_v<T>)
        for (size_t i = values.size(); i < names.size(); ++i) values.push_back(static_cast<T>(i));
    return {{name, KeyType::choice, {}, fallback, false, names},
            words,
            [names, at, values](Request& request, const std::string& text) {
                const auto found = std::find(names.begin(), names.end(), text);
                if (found == names.end()) fail_choice(text, {names.begin(), names.end()});
                std::invoke(at, request) = values[static_cast<size_t>(found - names.begin())];
            },
            [names, at, values](const Request& request) {
                const auto found = std::find(values.begin(), values.end(), std::invoke(at, request));
                return std::string(names[static_cast<size_t>(found - values.begin())]);
            }};
}

constexpr std::string_view truth_choices[] = {"false", "true"};
template <class At>
RequestKey flag(std::string_view name, const KeyWords& words, At at) {
    RequestKey made = choice(name, truth_choices, words, at, "false");
    made.type = KeyType::boolean;
    return made;
}

template <class At>
RequestKey text(std::string_view name, const KeyWords& words, At at) {
    return {{name, KeyType::text, {}, {}, false, {}},
            words,
            [at](Request& request, const std::string& given) { std::invoke(at, request) = given; },
            at};
}

RequestKey other(std::string_view name, const KeyWords& words, decltype(RequestKey::set) set,
                 decltype(RequestKey::text) print) {
    return {{name, KeyType::other, {}, {}, false, {}}, words, std::move(set), std::move(print)};
}

void set_space(Request& request, const std::string& name) {
    const ColorSpace* const space = find_color_space(name);
    if (!space)
        fail_usage("there is no such space",
                   nearest_first(name, {std::begin(space_choices), std::end(space_choices)}, "spaces"));
    request.channels.space = space;
}

void set_z_far(Request& request, const std::string& text) {
    const double value = whole_number<double>(text).value_or(0);
    constexpr double largest = std::numeric_limits<float>::max();
    if (!(value > 0) || (value > largest && value != INFINITY) || static_cast<float>(value) == 0)
        fail_usage("", "must be a number above 0 in single precision, or inf");
    request.channels.z_far = static_cast<float>(value);
}

std::vector<RequestKey> make_keys() {
    const std::string radiance = ", in the scene's units of radiance";
    const Key cutoff = scene_key(scene_keys, "cutoff");
    const Key target = number("target_error", {0, cutoff.range.high, true});
    return {
        text("scene", {"", "scene file: JSON or the seed's text; - reads standard input", of_suite}, &Request::scene),
        text("output",
             {"FILE", "image: .exr, or .out/.data for the seed's raw frames; #### or %04d is the frame number"},
             &Request::output),
        other(
            "frames", {"LIST", "frames to render, e.g. 0-299x5,7", of_suite},
            [](Request& r, const std::string& list) { r.frames = parse_frames(list); },
            [](const Request& r) { return format_frames(r.frames); }),
        choice("backend", backend_names, {"NAME", "embree (CPU) or cuda (GPU)"}, &Request::backend),
        other(
            "device", {"LIST", "with `backend` cuda: GPUs that share every frame, e.g. 0,2, or all; 0"},
            [](Request& r, const std::string& list) { r.devices = parse_devices(list, r.backend); },
            [](const Request& r) { return devices_text(r.devices); }),
        other(
            "resolution", {"WxH", "full frame in pixels", of_suite},
            [](Request& r, const std::string& size) {
                const PictureSize given = parse_size(size);
                r.frame.full_width = given.width;
                r.frame.full_height = given.height;
            },
            [](const Request& r) {
                return r.frame.full_width == 0 ? "" : fmt::format("{}x{}", r.frame.full_width, r.frame.full_height);
            }),
        other(
            "crop", {"WxH+X+Y", "render these pixels only; the file's data window", of_suite},
            [](Request& r, const std::string& crop) { r.frame.crop = parse_crop(crop); },
            [](const Request& r) { return r.frame.crop.width == 0 ? "" : format_rect(r.frame.crop); }),
        other(
            "tiles", {"CxR", "with `tile`: the grid of tiles that the frame, or the crop, is cut into"},
            [](Request& r, const std::string& grid) { r.tiles = parse_tiles(grid); },
            [](const Request& r) { return r.tiles ? fmt::format("{}x{}", r.tiles->columns, r.tiles->rows) : ""; }),
        other(
            "tile", {"N", "render this tile alone, counted from 0; render-merge joins them", not_of_suite, "", "tiles"},
            [](Request& r, const std::string& tile) {
                r.tile = integer_in(tile, 0, r.tiles ? r.tiles->count() - 1 : most_tiles);
            },
            [](const Request& r) { return r.tile ? fmt::format("{}", *r.tile) : ""; }),
        numeric(scene_key(film_keys, "supersample"),
                {"K", "k: a k x k grid of samples per pixel", of_suite, "cistula:supersample"},
                of(&Request::frame, &FrameSettings::supersample)),
        numeric(scene_key(scene_keys, "depth"),
                {"N", "surfaces shaded along a path, 1 to 1024", of_suite, "cistula:depth"},
                of(&Request::frame, &FrameSettings::depth)),
        numeric(cutoff,
                {"E", "radiance that dropping faint branches may cost a pixel; 0: none", of_suite, "cistula:cutoff"},
                of(&Request::frame, &FrameSettings::cutoff), expected_text(cutoff) + radiance),
        numeric(target,
                {"E", "radiance by which a pixel may be wrong: samples and branches as needed, whatever `supersample`",
                 of_suite, "cistula:targetError"},
                of(&Request::frame, &FrameSettings::target_error), expected_text(target) + radiance),
        numeric(whole("max_samples", least_lattice_samples, lattice_samples),
                {"N", "with `target_error`: samples of a pixel, 5 to 256; 256", of_suite, "cistula:maxSamples",
                 "target_error"},
                of(&Request::frame, &FrameSettings::max_samples)),
        choice("effects", effects_choices,
               {"NAME", "auto: compiled are those the scene calls for; all: every one, to compare"},
               of(&Request::frame, &FrameSettings::effects), "", std::vector<uint32_t>{0, all_effects}),
        choice("precision", precision_choices,
               {"NAME", "auto (float, or double where parts are too small for it), float or double", of_suite,
                "cistula:precision"},
               &Request::precision, "\"auto\"",
               std::vector<std::optional<Precision>>{std::nullopt, Precision::single_, Precision::double_}),
        numeric(whole("threads", 1, 1024), {"N", "threads; all by default"}, &Request::threads),
        numeric(whole("lanes", 1, 16),
                {"N", "rays that a CPU thread traces at once, at most; 1 to 16, all that it can by default"},
                of(&Request::frame, &FrameSettings::lanes)),
        numeric(number("max_texture_gb", {0, 1e6, true}),
                {"N", "memory for all textures, in GB of 10^9 bytes; a quarter of the machine's"},
                &Request::texture_gb),
        choice("bits", bits_choices, {"NAME", "float (32 bits a channel) or half (16)", of_suite},
               of(&Request::channels, &OutputChannels::half), "\"float\""),
        flag("strict", {"", "with `bits` half: a value over 65504 is an error, and not clamped"}, &Request::strict),
        other(
            "layers",
            {"LIST", "more layers: path, light, data, cryptomatte, or single ones such as diffuse, Z, N", of_suite},
            [](Request& r, const std::string& list) {
                r.channels = parse_layers(list, r.channels);
                r.layers = list;
            },
            [](const Request& r) { return r.layers; }),
        choice(
            "split", split_choices,
            {"NAME", "layers go into: none, the beauty's part of the file; parts of their own; or files of their own",
             not_of_suite, "", "layers"},
            &Request::split),
        other("z_far", {"Z", "with `layers` Z: the depth of nothing, a number or inf; 1e10", of_suite, "cistula:zFar"},
              set_z_far, [](const Request& r) { return fmt::format("{}", r.channels.z_far); }),
        choice(
            "background", background_choices,
            {"NAME", "opaque, or transparent: alpha is coverage, color premultiplied", of_suite, "cistula:background"},
            of(&Request::channels, &OutputChannels::transparent), "\"opaque\""),
        {{"colorspace", KeyType::choice, {}, "\"lin_rec709_scene\"", false, space_choices},
         {"NAME",
          "lin_rec709_scene, lin_ap1_scene (ACEScg), lin_ap0_scene (ACES2065-1), lin_rec2020_scene, lin_p3d65_scene or "
          "lin_adobergb_scene",
          of_suite, "colorInteropID"},
         set_space,
         [](const Request& r) { return std::string(r.channels.space->id); }},
        choice("compression", compression_names,
               {"NAME", fmt::format("{}; those of dwa lose some", fmt::join(compression_names, ", "))},
               of(&Request::channels, &OutputChannels::compression)),
        numeric(number("dwa_level", {0, 1000}),
                {"L", "with dwaa and dwab: 0 to 1000, more is smaller; 45", not_of_suite, "cistula:dwaLevel"},
                of(&Request::channels, &OutputChannels::dwa_level)),
        text("preview", {"FILE", "also a PNG, clamped, sRGB; may hold a pattern"}, &Request::preview),
        numeric(number("exposure", {-64, 64}),
                {"EV", "with `preview`: stops by which it is brighter; 0", not_of_suite, "", "preview"},
                of(&Request::view, &PictureView::exposure), "a number of stops from -64 to 64; each doubles the light"),
        other(
            "view",
            {"NAME",
             "with `preview`: srgb cuts off above white, filmic tells bright colors apart, or a view of $OCIO; srgb",
             not_of_suite, "", "preview"},
            [](Request& r, const std::string& name) {
                r.view.curve = name == "filmic" ? ViewCurve::filmic : ViewCurve::srgb;
                r.view.name = name == "filmic" || name == "srgb" ? "" : name;
            },
            [](const Request& r) {
                return r.view.name.empty() ? own_views[static_cast<size_t>(r.view.curve)] : r.view.name;
            }),
        numeric(number("bloom", {0, 100}),
                {"AMOUNT", "with `preview`: how much light above white glows around; 0", not_of_suite, "", "preview"},
                of(&Request::view, &PictureView::bloom),
                "a number from 0 to 100; 1 adds the light above white once, spread around it"),
        text("stats", {"FILE", "times, rays, memory and the effects mask as JSON"}, &Request::stats),
        flag("resume", {"", "skip frames whose file is complete and of the same scene and settings"}, &Request::resume),
        choice("progress", progress_choices,
               {"STYLE",
                "auto, plain or none; or, for programs, on standard output: json, or openjd (Open Job Description)"},
               &Request::progress),
        flag("quiet", {"", "errors only"}, &Request::quiet),
        flag("verbose", {"", "also times, hashes and effects"}, &Request::verbose),
    };
}

/// A key whose value has no place beside another's, or beside this value of it.
struct Exclusion {
    std::string_view key, other, value;
    const char* why;
};
constexpr const char* other_losses = "a tile would lose something else than the whole frame does";
constexpr Exclusion exclusions[] = {
    {"tile", "preview", "", "it is of whole frames; render-merge `preview` makes it"},
    {"tiles", "compression", "dwaa", other_losses},
    {"tiles", "compression", "dwab", other_losses},
    {"lanes", "backend", "cuda", "a thread of a GPU traces one ray"},
    {"target_error", "supersample", "", "pixels get as many samples as they need"},
    {"target_error", "cutoff", "", "a quarter of the target is the cutoff"},
};

}  // namespace

const std::vector<RequestKey>& request_keys() {
    static const std::vector<RequestKey> keys = make_keys();
    return keys;
}

const RequestKey& request_key(std::string_view name) {
    for (const RequestKey& key : request_keys())
        if (key.name == name) return key;
    throw std::logic_error(fmt::format("there is no key '{}' of a request", name));
}

std::string quoted_name(std::string_view key) {
    return fmt::format("\"{}\"", key);
}

void read_key(RenderRequest& request, const RequestKey& key, const JsonValue& value) {
    const Json& json = value.json();
    const bool is_free = key.type == KeyType::other;
    const bool is_number = key.type == KeyType::whole || key.type == KeyType::number;
    std::string given = found_text(json);
    if (json.is_number() && (is_number || is_free)) {
        given = number_text(json.get<double>());
    } else if (json.is_string() && !is_number && key.type != KeyType::boolean && !json.get<std::string>().empty()) {
        given = json.get<std::string>();
    } else if (json.is_array() && is_free) {  // [64, 48, 8, 6] is 64x48+8+6
        given.clear();
        for (const Json& part : json) given += (given.empty() ? "" : &part == &json[1] ? "x" : "+") + part.dump();
    } else if (!is_free && !(json.is_boolean() && key.type == KeyType::boolean)) {
        value.fail_expected(expected_text(key));
    }
    try {
        key.set(request, given);
    } catch (const Error& error) {
        value.fail(fmt::format("{}: {}", json.is_array() ? json.dump() : found_text(json), error.what()));
    }
}

void check_request(const RenderRequest& request) {
    const auto fail = [&](const RequestKey& key, const std::string& problem, const char* remedy = "") {
        throw Error(ErrorKind::usage, problem, remedy).of(key.name, key.text(request));
    };
    for (const Exclusion& excluded : exclusions) {
        const RequestKey &key = request_key(excluded.key), &other = request_key(excluded.other);
        if (!key.given(request) || !other.given(request)) continue;
        if (!excluded.value.empty() && other.text(request) != excluded.value) continue;
        fail(key,
             fmt::format("`{}`{}{} has no place here: {}", other.name, excluded.value.empty() ? "" : " ",
                         excluded.value, excluded.why),
             "leave it out");
    }
    for (const RequestKey& key : request_keys())
        if (!key.needs.empty() && key.given(request) && !request_key(key.needs).given(request))
            fail(key, fmt::format("is for `{}`", key.needs));
    const RequestKey& level = request_key("dwa_level");
    if (level.given(request) && !is_dwa(request.channels.compression))
        fail(level, "is for `compression` dwaa and dwab");
}

SceneDescription read_scene(const RenderRequest& request) {
    SceneDescription scene = read_scene(request.scene);
    if (request.texture_gb > 0) scene.texture_bytes = static_cast<uint64_t>(request.texture_gb * 1e9);
    if (request.described) request.described(scene);
    return scene;
}

FrameSettings frame_settings(const RenderRequest& request, const SceneDescription& scene) {
    const FrameSettings own = frame_settings(scene);
    FrameSettings settings = request.frame;
    if (settings.full_width == 0) {
        settings.full_width = own.full_width;
        settings.full_height = own.full_height;
    }
    if (settings.supersample == 0) settings.supersample = own.supersample;
    // With a target error the depth is unlimited by default: the budget of truncation ends the ray trees.
    if (settings.depth == 0) settings.depth = settings.adaptive() ? largest_depth : own.depth;
    if (settings.cutoff < 0) settings.cutoff = own.cutoff;
    settings.layers = layers_for(request.channels);
    if (request.channels.transparent && scene.sky) settings.layers.path = true;  // tells what is left out of a pixel
    settings.parts = parts_for(request.channels);
    PixelRect& crop = settings.crop;
    if (crop.width == 0) crop = {0, 0, settings.full_width, settings.full_height};
    if (crop.x < 0 || crop.y < 0 || crop.x > settings.full_width - crop.width ||
        crop.y > settings.full_height - crop.height)
        fail_usage(fmt::format("`crop` {}: leaves the frame, which is {}x{}", format_rect(crop), settings.full_width,
                               settings.full_height));
    if (request.tile) crop = tile_rect(crop, request.tiles.value_or(TileGrid()), *request.tile);
    return settings;
}

std::string open_config_view(PictureView& view) {
    if (view.name.empty()) return "";
    view.config = std::make_shared<const ConfigView>(view.name, own_views);
    return view.config->warning();
}

}  // namespace cistula
