#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/file_bytes.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_keys.h"
#include "image/color/color_space.h"
#include "render/record/film_picture.h"
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

/// What `parse` returns; its errors get the value's place.
template <class Parse>
auto parsed_at(const JsonValue& value, const Parse& parse) {
    try {
        return parse();
    } catch (const Error& error) {
        value.fail(error.named(quoted_name));
    }
}

Thresholds thresholds_in(const JsonValue& value) {
    Thresholds thresholds;
    JsonObject keys(value, suite_thresholds_keys);
    keys.read("fail", thresholds.fail);
    keys.read("failpercent", thresholds.failpercent);
    keys.read("hardfail", thresholds.hardfail);
    keys.read("failflip", thresholds.flip);
    keys.read("failssim", thresholds.ssim);
    keys.read("allow_nonfinite", thresholds.allow_nonfinite);
    if (keys.has("failpercent") && !thresholds.fail)
        keys.fail("failpercent", "needs to know when a pixel fails", "add \"fail\"");
    if (thresholds.allow_nonfinite && !thresholds.any())
        keys.fail("allow_nonfinite", "is for thresholds; without one every bit counts", "add \"fail\"");
    keys.finish();
    return thresholds;
}

template <class T, class Read>
std::vector<T> different_items(const JsonValue& value, size_t least, const char* expected, const Read& read) {
    std::vector<T> items;
    std::set<T> known;
    for (size_t i = 0; i < value.array_size(least, expected); ++i) {
        items.push_back(read(value.item(i)));
        if (!known.insert(items.back()).second) value.item(i).fail("is given already", "give it once");
    }
    return items;
}

void read_settings(JsonObject& keys, SuiteCase& one) {
    // A target error in a case replaces the grid and the cutoff of the defaults, and they it.
    const RenderRequest unset;
    if (keys.has("target_error")) {
        one.frame.supersample = unset.frame.supersample;
        one.frame.cutoff = unset.frame.cutoff;
    }
    if (keys.has("supersample") || keys.has("cutoff")) {
        one.frame.target_error = unset.frame.target_error;
        one.frame.max_samples = unset.frame.max_samples;
    }
    for (const RequestKey& key : request_keys())
        if (key.in_suite && keys.has(key.name)) read_key(one, key, keys.at(key.name));
    parsed_at(keys.value(), [&] { check_request(one); });
    if (one.frames.empty()) one.frames = {0};
    if (keys.has("thresholds")) one.thresholds = thresholds_in(keys.at("thresholds"));
    if (keys.has("backends"))
        one.backends =
            different_items<Backend>(keys.at("backends"), 1, "an array of one backend or more: [\"embree\", \"cuda\"]",
                                     [](const JsonValue& item) {
                                         return item.choice(suite_backend_key) == 1 ? Backend::cuda : Backend::embree;
                                     });
    if (keys.has("tags")) one.tags = different_items<std::string>(keys.at("tags"), 0, "an array of names", name_in);
}

std::string hash_in(const JsonValue& value) {
    const Json& json = value.json();
    std::string text = json.is_string() ? json.get<std::string>() : "";
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

/// Reads the name of a picture, or of one for each frame.
void read_picture_name(JsonObject& keys, const char* key, size_t frames, std::string& text) {
    if (!keys.has(key)) return;
    keys.read(key, text);
    const OutputName name = parsed_at(keys.at(key), [&] {
        if (lower_extension(text) != ".exr")
            throw Error(ErrorKind::scene, text + ": golden images, and pictures rendered elsewhere, are EXRs");
        return OutputName(text, key);
    });
    if (frames > 1 && !name.has_pattern())
        keys.fail(key, fmt::format("is one file, and \"frames\" names {}; put #### into its name", frames));
}

/// Reads where the picture of another program comes from.
void read_foreign(JsonObject& keys, SuiteCase& one) {
    read_picture_name(keys, "rendered", one.frames.size(), one.rendered);
    if (keys.has("command")) {
        constexpr const char* expected =
            "an array of words, {output} in one of them for the EXR to write, {frame} for the frame's number";
        const JsonValue words = keys.at("command");
        for (size_t i = 0; i < words.array_size(1, expected); ++i) {
            if (!words.item(i).json().is_string()) words.fail_expected(expected);
            one.command.push_back(words.item(i).json().get<std::string>());
        }
        if (std::none_of(one.command.begin(), one.command.end(),
                         [](const std::string& word) { return word.find("{output}") != word.npos; }))
            words.fail_expected(expected);
        if (keys.has("rendered")) keys.fail("command", "\"rendered\" is there, too; give one of them");
    }
    if (!one.is_foreign()) return;
    for (const RequestKey& key : request_keys())
        if (key.in_suite && key.name != "frames" && keys.has(key.name))
            keys.fail(key.name, "has no place here: another program renders; leave it out");
    for (const char* key : {"film_hash", "recorded", "backends"})
        if (keys.has(key)) keys.fail(key, "has no place here: another program renders; leave it out");
    one.backends = {Backend::embree};
}

void read_golden(JsonObject& keys, SuiteCase& one) {
    read_picture_name(keys, "golden", one.frames.size(), one.golden);
    if (keys.has("hash") && keys.has("golden"))
        keys.fail("hash", "\"golden\" has no place here: either says what is expected", "leave it out");
    if (keys.has("hash")) {
        one.hashes = hashes_in(keys.at("hash"), one.frames.size());
        if (keys.has("thresholds")) keys.fail("thresholds", "a \"hash\" is equal or not", "give a \"golden\" image");
    }
    if (keys.has("film_hash")) one.film_hashes = hashes_in(keys.at("film_hash"), one.frames.size());
    if (keys.has("recorded")) read_recorded(keys.at("recorded"), one);
}

SuiteCase read_case(const JsonValue& value, SuiteCase one) {
    JsonObject keys(value, suite_case_keys);
    one.place = value.place();
    one.name = name_in(keys.at("name"));
    read_settings(keys, one);
    read_golden(keys, one);
    read_foreign(keys, one);
    keys.finish();
    if (one.scene.empty() && !one.is_foreign())
        value.fail("missing key 'scene', which \"defaults\" may have: expected a scene's file");
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

std::string SuiteCase::rendered_path(const std::string& folder, int frame) const {
    return rendered.empty() ? "" : below(folder, OutputName(rendered, "rendered").for_frame(frame));
}

Suite read_suite(const std::string& folder) {
    namespace fs = std::filesystem;
    Suite suite;
    suite.folder = folder;
    suite.path = (fs::path(folder) / "suite.json").string();
    std::error_code error;
    if (fs::is_regular_file(folder, error))
        throw Error(ErrorKind::file, "is a file", "give the folder of a suite.json").at(folder);
    const fs::path whole = fs::weakly_canonical(folder, error);
    suite.name = whole.filename().empty() ? "suite" : whole.filename().string();
    check_readable(suite.path);
    suite.text = read_file(suite.path);
    const Json json = parse_json(suite.text, suite.path);
    const JsonValue root(json, suite.path);
    JsonObject keys(root, suite_keys);
    std::string ignored;
    keys.read("$schema", ignored);
    SuiteCase defaults;
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
        if (!is_new) cases.item(i).fail(fmt::format("'{}' is the name of {}", one.name, first->second), "names differ");
        suite.cases.push_back(std::move(one));
    }
    keys.finish();
    return suite;
}

}  // namespace cistula
