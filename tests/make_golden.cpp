// Renders the golden images by the plain loop of brute.h and says what changed: make_golden FOLDER [SCENE...]
#include <fmt/format.h>

#include <iostream>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/image/exr.h"
#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"

using namespace cistula;
namespace fs = std::filesystem;

namespace {

void write_and_compare(const fs::path& file, const LayeredPicture& picture) {
    if (!fs::exists(file)) {
        fmt::print("  {}: new\n", file.string());
    } else {
        const LayeredPicture before = read_exr(file.string());
        const golden::Difference d = golden::compare(before, picture, false);
        if (d.differing == 0 && before.channels.size() == picture.channels.size() &&
            before.attributes == picture.attributes) {
            fmt::print("  {}: unchanged\n", file.string());
            return;
        }
        fmt::print("  {}: {} floats differ, at most by {:.3g} ({} at {}, {})\n", file.string(), d.differing, d.worst,
                   d.channel, d.x, d.y);
    }
    write_exr(file.string(), picture);
}

/// The hashes tell of changes too small for the floats of the pictures.
void write_and_compare(const fs::path& file, const nlohmann::ordered_json& record) {
    const std::string text = record.dump(2) + "\n";
    if (!fs::exists(file)) {
        fmt::print("  {}: new\n", file.string());
    } else {
        std::ifstream in(file, std::ios::binary);
        const std::string before{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        if (before == text) {
            fmt::print("  {}: unchanged\n", file.string());
            return;
        }
        fmt::print("  {}: changed\n", file.string());
        const auto old = nlohmann::json::parse(before, nullptr, false);
        for (const auto& [key, value] : record.items()) {
            const std::string was = old.is_object() && old.contains(key) ? old[key].dump() : "nothing";
            // By value, as the keys' order may differ.
            if (was != nlohmann::json(value).dump()) fmt::print("    {}: was {}, is {}\n", key, was, value.dump());
        }
    }
    write_file_atomically(file.string(), text);
}

void make(const fs::path& folder, const std::string& name) {
    fmt::print("{}\n", name);
    const SceneDescription scene = test::shipped_scene(name);
    const Film single = golden::render_brute<float>(scene), twice = golden::render_brute<double>(scene);
    if (single.flags || twice.flags) throw Error(ExitCode::failed, name + ": the render raised a flag");
    const LayeredPicture in_float = to_layers(single, golden::channels());
    const LayeredPicture in_double = to_layers(twice, golden::channels());
    const golden::Difference d = golden::compare(in_float, in_double, true);
    const FrameSettings settings = golden::settings_for(scene);
    fs::create_directories(folder / name);
    write_and_compare(folder / name / "float.exr", in_float);
    write_and_compare(folder / name / "double.exr", in_double);
    // Float against double: pixels whose rays graze an edge take another path, so the worst one may differ much.
    size_t over = 0;
    for (size_t i = 0; i < in_float.channels[0].values.size(); ++i)
        for (const auto& channel : in_float.channels)
            if (channel.name == "R" || channel.name == "G" || channel.name == "B") {
                const auto& other = in_double.channels[size_t(&channel - in_float.channels.data())];
                if (std::abs(channel.values[i] - other.values[i]) > 0.5f / 255) {
                    ++over;
                    break;
                }
            }
    const nlohmann::ordered_json record = {
        {"scene", name},
        {"width", settings.full_width},
        {"height", settings.full_height},
        {"depth", scene.depth},
        {"float", {{"hash", film_hash(single)}}},
        {"double", {{"hash", film_hash(twice)}}},
        {"float_against_double",
         {{"worst", d.worst},
          {"channel", d.channel},
          {"x", d.x},
          {"y", d.y},
          {"share_over_half_of_1_255", double(over) / (settings.full_width * settings.full_height)}}}};
    write_and_compare(folder / name / "golden.json", record);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::cerr << "usage: make_golden FOLDER [SCENE...]\n";
        return int(ExitCode::usage);
    }
    try {
        std::vector<std::string> names(arguments + 2, arguments + count);
        if (names.empty()) names = golden::scene_names(test::scene_folder);
        for (const std::string& name : names) make(arguments[1], name);
    } catch (const Error& error) {
        std::cerr << "make_golden: " << error.what() << "\n";
        return int(error.code());
    }
    return 0;
}
