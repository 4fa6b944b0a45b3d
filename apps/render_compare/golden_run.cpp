#include "golden_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/common/build_info.h"
#include "apps/common/command_line.h"
#include "apps/common/golden.h"
#include "apps/common/run_files.h"
#include "report.h"
#include "scene/base/atomic_file.h"
#include "scene/base/file_bytes.h"
#include "scene/base/suggest.h"
#include "scene/compile/scene_source.h"
#include "scene/image/exr.h"
#include "scene/readers/read_scene.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The comparison of one scene in one precision.
struct GoldenResult {
    std::string scene, precision, expected_hash, hash;
    uint32_t flags = 0;
    Comparison comparison;

    bool holds() const { return flags == 0 && hash == expected_hash && passes(comparison, {}); }
};

/// The subfolders that hold a golden.json, sorted: "benchmark", "hard/slivers".
std::vector<std::string> golden_names(const fs::path& folder) {
    std::error_code error;
    std::vector<std::string> names;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().filename() == "golden.json" && entry.depth() > 0)
            names.push_back(entry->path().parent_path().lexically_relative(folder).generic_string());
    if (names.empty())
        throw Error(ExitCode::file,
                    fmt::format("{}: holds no golden images{}; run in Cistula's source tree, or name its folder: "
                                "--golden DIR",
                                folder.string(), error ? fmt::format(" ({})", error.message()) : ""));
    std::sort(names.begin(), names.end());
    return names;
}

/// The hash of the film in golden.json.
std::string expected_hash(const fs::path& file, const char* precision) {
    try {
        return Json::parse(read_file(file.string())).at(precision).at("hash").get<std::string>();
    } catch (const nlohmann::json::exception& error) {
        throw file_error(file.string(), "read", fmt::format("a record of make_golden is expected; {}", error.what()));
    }
}

/// Throws Error (usage) if the file to be written is one of those that are read.
void require_other_file(const std::string& json, const fs::path& folder, const fs::path& scenes,
                        const std::vector<std::string>& names) {
    if (json.empty()) return;
    RunFiles files;
    for (const std::string& name : names) {
        for (const char* file : {"golden.json", "float.exr", "double.exr"})
            files.reads((folder / name / file).string(), "a golden image");
        const std::string scene = (scenes / (name + ".json")).string();
        files.reads_scene(scene, gather_scene(read_scene(scene)).files);
    }
    files.writes(json, "--json");
}

template <class Real>
Film render(const SceneDescription& scene, Backend backend, const CudaOptions& cuda) {
    const auto renderer = make_renderer<Real>(backend, compile_scene<Real>(scene), cuda);
    return golden::render_with(*renderer, scene, golden::settings_for(scene));
}

GoldenResult check(const std::string& name, const fs::path& folder, const SceneDescription& scene, Precision precision,
                   Backend backend, const CudaOptions& cuda) {
    const bool in_double = precision == Precision::double_;
    GoldenResult result;
    result.scene = name;
    result.precision = in_double ? "double" : "float";
    result.expected_hash = expected_hash(folder / "golden.json", result.precision.c_str());
    const LayeredPicture expected = read_exr((folder / (result.precision + ".exr")).string());
    const Film film = in_double ? render<double>(scene, backend, cuda) : render<float>(scene, backend, cuda);
    result.flags = film.flags;
    result.hash = film_hash(film);
    result.comparison = compare_pictures(expected, to_layers(film, golden::channels()), {});
    return result;
}

std::string image_text(const Comparison& comparison) {
    if (passes(comparison, {})) return "equal";
    const auto worst = std::max_element(
        comparison.channels.begin(), comparison.channels.end(),
        [](const auto& a, const auto& b) { return a.max < b.max || (a.max == b.max && a.differing < b.differing); });
    std::string text = verdict(comparison, {});
    if (worst != comparison.channels.end() && worst->differing > 0)
        text += fmt::format("; worst: {} at {}", worst->name, worst_text(*worst));
    return text;
}

std::string row(const GoldenResult& result, size_t name_width) {
    return fmt::format("{:<{}} {:<9} {:<8} {}{}\n", result.scene, name_width, result.precision,
                       result.hash == result.expected_hash ? "equal" : "differs",
                       one_line(image_text(result.comparison)),
                       result.flags == 0 ? "" : fmt::format("; the film cannot be trusted (flags {})", result.flags));
}

Json to_json(const std::vector<GoldenResult>& results, size_t differing, const CompareOptions& options,
             const ChosenDevices& devices) {
    Json context = {{"executable", "render-compare"},
                    {"cistula_version", CISTULA_VERSION},
                    {"compiler", __VERSION__},
                    {"flags", build_flags()},
                    {"commit", build_commit()},
                    {"golden", options.golden},
                    {"backend", backend_name(options.backend)}};
    if (!devices.names.empty()) {
        context["devices"] = devices.names;
        context["driver"] = devices.driver;
    }
    Json cases = Json::array();
    for (const GoldenResult& result : results)
        cases.push_back({{"scene", result.scene},
                         {"precision", result.precision},
                         {"holds", result.holds()},
                         {"film_hash", result.hash},
                         {"film_hash_golden", result.expected_hash},
                         {"flags", result.flags},
                         {"floats", result.comparison.values()},
                         {"floats_differing", result.comparison.differing()},
                         {"image", image_text(result.comparison)}});
    return {
        {"context", context}, {"parity", {{"compared", results.size()}, {"differing", differing}}}, {"cases", cases}};
}

}  // namespace

bool run_golden(const CompareOptions& options) {
    const ChosenDevices devices = choose_devices(options.backend, options.devices);
    const auto say = [&](const std::string& text) {
        if (!options.quiet) print(text);
    };
    const std::vector<std::string> names = golden_names(options.golden);
    // Canonical, because "." and "golden/.." have a parent too.
    const fs::path folder = fs::canonical(options.golden), scenes = folder.parent_path() / "scenes";
    require_other_file(options.json, folder, scenes, names);
    size_t name_width = 12;
    for (const std::string& name : names) name_width = std::max(name_width, name.size());
    say(fmt::format("{}: backend {}{}\n{:<{}} {:<9} {:<8} {}\n", options.golden, backend_name(options.backend),
                    devices.names.empty() ? "" : fmt::format(" on {}", fmt::join(devices.names, ", ")), "scene",
                    name_width, "precision", "film", "image"));
    std::vector<GoldenResult> results;
    for (const std::string& name : names) {
        const SceneDescription scene = read_scene((scenes / (name + ".json")).string());
        for (const Precision precision : options.precisions) {
            results.push_back(check(name, folder / name, scene, precision, options.backend, devices.options));
            say(row(results.back(), name_width));
        }
    }
    const auto differing = static_cast<size_t>(
        std::count_if(results.begin(), results.end(), [](const GoldenResult& result) { return !result.holds(); }));
    say(differing == 0 ? fmt::format("equal: all {} renders\n", results.size())
                       : fmt::format("differ: {} of {} renders\n", differing, results.size()));
    if (!options.json.empty())
        write_file_atomically(options.json, to_json(results, differing, options, devices)
                                                    .dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                                                "\n");
    return differing == 0;
}

}  // namespace cistula
