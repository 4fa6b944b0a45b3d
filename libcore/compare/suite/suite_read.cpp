#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>

#include "base/file_bytes.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_keys.h"
#include "image/color/color_space.h"
#include "render/layer_list.h"
#include "scene/readers/json_reader.h"
#include "sequence/output_name.h"

namespace cistula {
namespace {

/// The name in a value, of a case or a tag.
const std::string& name_in(const JsonValue& value) {
    const Json& json = value.json();
    if (!json.is_string() || !is_suite_name(json.get_ref<const std::string&>()))
        value.fail_expected(
            fmt::format("a name of letters, digits and {} that begins with a letter, a digit or _", suite_name_signs));
    return json.get_ref<const std::string&>();
}

/// What `parse` makes of a text; its errors get the value's place.
template <class Parse>
auto parsed_at(const JsonValue& value, const Parse& parse) {
    try {
        return parse(value.json().get_ref<const std::string&>());
    } catch (const Error& error) {
        value.fail(error.what());
    }
}

std::vector<int> whole_numbers(const JsonValue& value, std::initializer_list<Key> keys, const char* expected) {
    if (!value.json().is_array() || value.json().size() != keys.size()) value.fail_expected(expected);
    std::vector<int> numbers;
    for (const Key& key : keys) numbers.push_back(static_cast<int>(value.item(numbers.size()).whole(key)));
    return numbers;
}

std::vector<int> frames_in(const JsonValue& value) {
    if (value.json().is_string()) return parsed_at(value, [](const std::string& text) { return parse_frames(text); });
    if (!value.json().is_number())
        value.fail_expected("a frame's number, or a list as --frames takes it: \"0-299x30\"");
    return {static_cast<int>(value.whole(suite_frame_key))};
}

float z_far_in(const JsonValue& value) {
    if (value.json().is_string() && value.json().get_ref<const std::string&>() == "inf")
        return std::numeric_limits<float>::infinity();
    const double number = value.json().is_number() ? value.json().get<double>() : 0;
    if (!(static_cast<float>(number) > 0) || number > double(std::numeric_limits<float>::max()))
        value.fail_expected("a number above 0 in single precision, or \"inf\"");
    return static_cast<float>(number);
}

Thresholds thresholds_in(const JsonValue& value) {
    Thresholds thresholds;
    JsonObject keys(value, suite_thresholds_keys);
    keys.read("fail", thresholds.fail);
    keys.read("failpercent", thresholds.failpercent);
    keys.read("hardfail", thresholds.hardfail);
    if (keys.has("failpercent") && !thresholds.fail)
        keys.fail("failpercent", "needs to know when a pixel fails; add \"fail\"");
    keys.finish();
    return thresholds;
}

template <class T, class Read>
std::vector<T> different_items(const JsonValue& value, size_t least, const char* expected, const Read& read) {
    std::vector<T> items;
    for (size_t i = 0; i < value.array_size(least, expected); ++i) {
        T item = read(value.item(i));
        if (std::find(items.begin(), items.end(), item) != items.end())
            value.item(i).fail("is given already; give it once");
        items.push_back(std::move(item));
    }
    return items;
}

void read(JsonObject& keys, std::string_view key, std::optional<int>& value) {
    if (keys.has(key)) keys.read(key, value.emplace());
}

/// Two keys of one object that exclude each other.
void refuse_both(JsonObject& keys, std::string_view key, std::string_view other, const char* why) {
    if (keys.has(key) && keys.has(other))
        keys.fail(key, fmt::format("\"{}\" has no place beside it: {}; leave one out", other, why));
}

/// How many samples a pixel gets: a target error, or a grid and a cutoff. One in a case replaces the other of the
/// defaults.
void read_samples(JsonObject& keys, SuiteSettings& settings) {
    refuse_both(keys, "target_error", "supersample", "pixels get as many samples as they need");
    refuse_both(keys, "target_error", "cutoff", "a quarter of the target is the cutoff");
    if (keys.has("target_error")) settings.supersample.reset(), settings.cutoff.reset();
    if (keys.has("supersample") || keys.has("cutoff")) settings.target_error.reset(), settings.max_samples.reset();
    read(keys, "supersample", settings.supersample);
    read(keys, "depth", settings.depth);
    keys.read("cutoff", settings.cutoff);
    keys.read("target_error", settings.target_error);
    read(keys, "max_samples", settings.max_samples);
    if (keys.has("max_samples") && !settings.target_error)
        keys.fail("max_samples", "is for a \"target_error\"; a grid's samples are those of \"supersample\"");
}

/// The channels of a picture, whose layers are a choice apart.
void read_channels(JsonObject& keys, SuiteSettings& settings) {
    OutputChannels& channels = settings.channels;
    keys.read("layers", settings.layers);
    if (keys.has("layers")) {
        const OutputChannels before = channels;
        channels = parsed_at(keys.at("layers"), [](const std::string& text) { return parse_layers(text); });
        channels.half = before.half;
        channels.transparent = before.transparent;
        channels.space = before.space;
        channels.z_far = before.z_far;
    }
    if (keys.has("bits")) channels.half = keys.read_choice("bits") == 1;
    if (keys.has("background")) channels.transparent = keys.read_choice("background") == 1;
    if (keys.has("colorspace")) {
        keys.read_choice("colorspace");
        channels.space = find_color_space(keys.at("colorspace").json().get<std::string>());
    }
    if (keys.has("z_far")) channels.z_far = z_far_in(keys.at("z_far"));
}

void read_settings(JsonObject& keys, SuiteSettings& settings) {
    keys.read("scene", settings.scene);
    if (keys.has("frames")) settings.frames = frames_in(keys.at("frames"));
    if (keys.has("resolution")) {
        const auto size = whole_numbers(keys.at("resolution"), {suite_width_key, suite_width_key}, "[width, height]");
        settings.resolution = {size[0], size[1]};
    }
    if (keys.has("crop")) {
        const auto crop =
            whole_numbers(keys.at("crop"), {suite_width_key, suite_width_key, suite_offset_key, suite_offset_key},
                          "[width, height, x, y]");
        settings.crop = {crop[2], crop[3], crop[0], crop[1]};
    }
    read_samples(keys, settings);
    if (keys.has("precision"))
        settings.precision = std::array<std::optional<Precision>, 3>{
            std::nullopt, Precision::single_, Precision::double_}[size_t(keys.read_choice("precision"))];
    read_channels(keys, settings);
    if (keys.has("thresholds")) settings.thresholds = thresholds_in(keys.at("thresholds"));
    if (keys.has("backends"))
        settings.backends =
            different_items<Backend>(keys.at("backends"), 1, "an array of one backend or more: [\"embree\", \"cuda\"]",
                                     [](const JsonValue& item) {
                                         return item.choice(suite_backend_key) == 1 ? Backend::cuda : Backend::embree;
                                     });
    if (keys.has("tags"))
        settings.tags = different_items<std::string>(keys.at("tags"), 0, "an array of names", name_in);
}

std::string hash_in(const JsonValue& value) {
    const Json& json = value.json();
    const std::string text = json.is_string() ? json.get<std::string>() : "";
    if (text.size() != 32 || text.find_first_not_of("0123456789abcdef") != text.npos)
        value.fail_expected("a hash: 32 of the characters 0 to 9 and a to f");
    return text;
}

/// A hash, or one for each of several frames.
std::vector<std::string> hashes_in(const JsonValue& value, size_t frames) {
    if (frames == 1 && !value.json().is_array()) return {hash_in(value)};
    if (!value.json().is_array() || value.json().size() != frames)
        value.fail_expected(fmt::format("an array of {} hashes, one for each of \"frames\"", frames));
    std::vector<std::string> hashes;
    for (size_t i = 0; i < frames; ++i) hashes.push_back(hash_in(value.item(i)));
    return hashes;
}

void read_recorded(const JsonValue& value, SuiteCase& one) {
    JsonObject keys(value, suite_recorded_keys);
    keys.read("version", one.recorded_version);
    if (keys.has("precision"))
        one.recorded_precision = keys.read_choice("precision") == 1 ? Precision::double_ : Precision::single_;
    keys.finish();
}

void read_golden(JsonObject& keys, SuiteCase& one) {
    keys.read("golden", one.golden);
    if (keys.has("golden")) {
        const OutputName name = parsed_at(keys.at("golden"), [](const std::string& text) {
            if (lower_extension(text) != ".exr") throw Error(ExitCode::usage, text + ": golden images are EXRs");
            return OutputName(text, "golden");
        });
        if (one.frames.size() > 1 && !name.has_pattern())
            keys.fail("golden",
                      fmt::format("is one file, and \"frames\" names {}; put #### into its name", one.frames.size()));
    }
    refuse_both(keys, "hash", "golden", "either says what is expected");
    if (keys.has("hash")) {
        one.hashes = hashes_in(keys.at("hash"), one.frames.size());
        if (keys.has("thresholds")) keys.fail("thresholds", "a \"hash\" is equal or not; give a \"golden\" image");
    }
    if (keys.has("film_hash")) one.film_hashes = hashes_in(keys.at("film_hash"), one.frames.size());
    if (keys.has("recorded")) read_recorded(keys.at("recorded"), one);
}

SuiteCase read_case(const JsonValue& value, const SuiteSettings& defaults) {
    SuiteCase one{defaults, {}, {}, {}, {}, {}, {}, {}};
    JsonObject keys(value, suite_case_keys);
    one.place = value.place();
    one.name = name_in(keys.at("name"));
    read_settings(keys, one);
    read_golden(keys, one);
    keys.finish();
    if (one.scene.empty()) value.fail("missing key 'scene', which \"defaults\" may have: expected a scene's file");
    return one;
}

std::string below(const std::string& folder, const std::string& path) {
    return path.empty() ? path : (std::filesystem::path(folder) / path).string();
}

}  // namespace

std::string SuiteCase::scene_path(const std::string& folder) const {
    return below(folder, scene);
}

std::string SuiteCase::golden_path(const std::string& folder, int frame) const {
    return golden.empty() ? "" : below(folder, OutputName(golden, "golden").for_frame(frame));
}

const char* precision_name(Precision precision) {
    return precision == Precision::double_ ? "double" : "float";
}

Suite read_suite(const std::string& folder) {
    namespace fs = std::filesystem;
    Suite suite;
    suite.folder = folder;
    suite.path = (fs::path(folder) / "suite.json").string();
    std::error_code error;
    if (fs::is_regular_file(folder, error))
        throw Error(ExitCode::file, fmt::format("{}: is a file; give the folder of a suite.json", folder));
    const fs::path whole = fs::weakly_canonical(folder, error);
    suite.name = whole.filename().empty() ? "suite" : whole.filename().string();
    suite.text = read_file(suite.path);
    const Json json = parse_json(suite.text, suite.path);
    const JsonValue root(json, suite.path);
    JsonObject keys(root, suite_keys);
    std::string ignored;
    keys.read("$schema", ignored);
    SuiteSettings defaults;
    if (keys.has("defaults")) {
        JsonObject values(keys.at("defaults"), suite_defaults_keys);
        read_settings(values, defaults);
        values.finish();
    }
    const JsonValue cases = keys.at("cases");
    std::map<std::string, std::string> places;
    for (size_t i = 0; i < cases.array_size(1, "an array of one case or more"); ++i) {
        SuiteCase one = read_case(cases.item(i), defaults);
        const auto [first, is_new] = places.emplace(one.name, one.place);
        if (!is_new) cases.item(i).fail(fmt::format("'{}' is the name of {}; names differ", one.name, first->second));
        suite.cases.push_back(std::move(one));
    }
    keys.finish();
    return suite;
}

}  // namespace cistula
