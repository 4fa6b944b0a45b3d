// Cistula against POV-Ray 3.7, on scenes/benchmark.json, solids of glass, a mesh between mirrors, balls of glass, and
// bodies under a sky: the time to trace them on 1, 2 and all threads, and whether the pictures agree. bench_povray
// [FOLDER]: scenes and pictures go there (out/bench).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/shown_text.h"
#include "image/exr/exr.h"
#include "povray_scene.h"
#include "program.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int width = 640;
constexpr int height = 480;
constexpr int repetitions = 5;
/// A difference that 8 bits do not show.
constexpr float visible = 0.004f;

struct Work {
    std::filesystem::path scene;
    int depth;
    std::filesystem::path povray_scene, povray_image, image, stats;

    Work(const std::filesystem::path& of, int to_depth, const std::filesystem::path& folder)
        : scene(of), depth(to_depth) {
        const std::filesystem::path stem = folder / of.stem();
        povray_scene = stem.string() + ".pov";
        povray_image = stem.string() + "_povray.exr";
        image = stem.string() + "_cistula.exr";
        stats = stem.string() + "_stats.json";
    }
};

/// The number in parentheses that POV-Ray ends "Trace Time: 0 hours 0 minutes 7 seconds (7.418 seconds)" with.
double povray_trace_seconds(const std::string& log) {
    const size_t line = log.find("Trace Time:");
    const size_t begin = line == log.npos ? line : log.find('(', line);
    if (begin == log.npos) throw Error(ErrorKind::failed, "POV-Ray's output names no trace time");
    return std::stod(log.substr(begin + 1));
}

double run_povray(const Work& work, int threads) {
    return povray_trace_seconds(output_of(
        fmt::format("povray {} {} +FE +W{} +H{} +WT{} -A -D -V", shell_word("+I" + work.povray_scene.string()),
                    shell_word("+O" + work.povray_image.string()), width, height, threads)));
}

nlohmann::json run_cistula(const Work& work, int threads) {
    output_of(fmt::format(
        "{} {} -o {} --res {}x{} --depth {} --cutoff 0 --supersample 1 --threads {} --stats {} "
        "--progress none -q",
        shell_word(CISTULA_BIN_DIR "/render"), shell_word(work.scene.string()), shell_word(work.image.string()), width,
        height, work.depth, threads, shell_word(work.stats.string())));
    const nlohmann::json stats = nlohmann::json::parse(std::ifstream(work.stats));
    for (const auto& entry : stats.at("benchmarks"))
        if (entry.contains("render_ms")) return entry;
    throw Error(ErrorKind::failed, work.stats.string() + ": names no frame");
}

void time_povray(benchmark::State& state, const Work& work, int threads) {
    for (auto _ : state) state.SetIterationTime(run_povray(work, threads));
}

void time_cistula(benchmark::State& state, const Work& work, int threads) {
    for (auto _ : state) {
        const nlohmann::json frame = run_cistula(work, threads);
        state.SetIterationTime(frame.at("render_ms").get<double>() / 1e3);
        state.counters["rays"] = frame.at("rays").at("total").get<double>();
        state.counters["rays_per_second"] = frame.at("rays_per_second").get<double>();
    }
}

const LayeredPicture::Channel& channel(const LayeredPicture& picture, std::string_view name) {
    for (const LayeredPicture::Channel& c : picture.channels)
        if (c.name == name) return c;
    throw Error(ErrorKind::failed, "a picture has no channel " + std::string(name));
}

/// Per pixel the largest difference of its channels; POV-Ray writes half floats, which at 1 are 0.0005 apart.
void compare_images(benchmark::State& state, const Work& work, int threads) {
    for (auto _ : state) {
        run_povray(work, threads);
        run_cistula(work, threads);
        const LayeredPicture theirs = read_exr(work.povray_image.string());
        const LayeredPicture ours = read_exr(work.image.string());
        if (theirs.width != width || theirs.height != height || ours.width != width || ours.height != height)
            throw Error(ErrorKind::failed, "the pictures to compare differ in size");
        double sum = 0, worst = 0, sum_ours = 0, sum_theirs = 0;
        int agree = 0;
        for (size_t i = 0; i < size_t(width * height); ++i) {
            float difference = 0;
            for (const char* name : {"R", "G", "B"}) {
                const float a = channel(ours, name).values[i];
                const float b = channel(theirs, name).values[i];
                difference = std::max(difference, std::abs(a - b));
                sum_ours += double(a);
                sum_theirs += double(b);
            }
            sum += double(difference);
            worst = std::max(worst, double(difference));
            agree += difference <= visible ? 1 : 0;
        }
        const double pixels = double(width) * height;
        state.counters["mean_difference"] = sum / pixels;
        state.counters["worst_difference"] = worst;
        state.counters["share_within_0.004"] = agree / pixels;
        state.counters["mean_cistula"] = sum_ours / pixels / 3;
        state.counters["mean_povray"] = sum_theirs / pixels / 3;
    }
}

/// A file of the scene: three solids of glass over a floor of 144 tiles.
std::filesystem::path write_glass_scene(const std::filesystem::path& folder) {
    std::string objects;
    for (int i = 0; i < 144; ++i)
        objects += fmt::format(
            R"({{"quad": [[{0}, {1}, 0], [{2}, {1}, 0], [{2}, {3}, 0], [{0}, {3}, 0]], "material": "{4}"}},
)",
            i % 12 - 6, i / 12 - 4, i % 12 - 5, i / 12 - 3, (i % 12 + i / 12) % 2 ? "light" : "dark");
    const std::filesystem::path path = folder / "glass_on_tiles.json";
    write_file_atomically(
        path.string(),
        R"({"film": {"width": 640, "height": 480}, "depth": 24, "ambient": 0.2, "background": [0.4, 0.5, 0.6],
"camera": {"position": [0, -6, 4], "target": [0, 1, 1], "fov": 50},
"materials": {
    "light": {"color": 0.8, "diffuse": 0.8}, "dark": {"color": [0.2, 0.2, 0.25], "diffuse": 0.8},
    "water": {"color": 1, "transmission": 1, "fresnel": true, "index": 1.33},
    "crown": {"color": 1, "transmission": 1, "fresnel": true, "index": 1.5},
    "flint": {"color": 1, "transmission": 1, "fresnel": true, "index": 1.8}},
"objects": [
)" + objects +
            R"({"solid": "cube", "center": [-2, 1, 1.3], "radius": 1.2, "rotate": [11, 23, 37], "material": "water"},
{"solid": "dodecahedron", "center": [0.2, 0.5, 1.4], "radius": 1.2, "rotate": [11, 23, 37], "material": "crown"},
{"solid": "icosahedron", "center": [2.4, 1, 1.3], "radius": 1.2, "rotate": [11, 23, 37], "material": "flint"}],
"lights": [{"position": [4, -5, 8], "color": 0.9}, {"position": [-6, -3, 7], "color": 0.4}]})");
    return path;
}

/// A file of a scene of balls and of solids by planes under a graded sky.
std::filesystem::path write_sky_scene(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "bodies_under_a_sky.json";
    write_file_atomically(path.string(), R"({"film": {"width": 640, "height": 480}, "depth": 16, "ambient": 0.3,
"background": {"axis": [0.1, 0.2, 1], "stops": [[0, [0.2, 0.35, 0.7]], [70, [0.6, 0.7, 0.85]], [90, [1, 0.9, 0.75]],
    [90, [0.3, 0.28, 0.25]], [180, 0.1]]},
"camera": {"position": [0, -8, 3], "target": [0, 0, 1.1], "fov": 50},
"textures": {"checker": {"checker": [0.8, 0.3], "repeat": [6, 6]}},
"materials": {
    "floor": {"color": 1, "texture": "checker", "diffuse": 0.8, "specular": 0},
    "paint": {"color": [0.8, 0.3, 0.2], "diffuse": 0.7, "specular": 0.5, "exponent": 40},
    "mirror": {"color": [0.7, 0.7, 0.6], "diffuse": 0.3, "specular": 0.4, "exponent": 60, "reflection": 0.6},
    "glass": {"color": 1, "specular": 0, "transmission": 1, "fresnel": true, "index": 1.5}},
"objects": [
{"quad": [[-6, -6, 0], [6, -6, 0], [6, 6, 0], [-6, 6, 0]], "material": "floor"},
{"solid": "sphere", "center": [-2.4, 0.4, 1], "radius": 1, "material": "mirror"},
{"solid": "sphere", "center": [0.1, -1.4, 0.9], "radius": 0.9, "material": "glass"},
{"solid": "sphere", "center": [1.2, 1.6, 0.7], "radius": 0.7, "material": "paint"},
{"solid": "convex", "planes": [[1, 0, 0, 0.8], [-1, 0, 0, 0.8], [0, 1, 0, 0.7], [0, -1, 0, 0.7], [0, 0, 1, 1], [0, 0, -1, 1],
    [1, 1, 1, 1.5], [-1, -1, 1, 1.5], [1, -1, 1, 1.6]], "center": [2.7, 0, 1.01], "rotate": [0, 0, 25], "material": "mirror"},
{"solid": "prism", "sides": 7, "radius": 0.7, "height": 1.2, "center": [-0.9, 1.9, 0.61], "material": "paint"}],
"lights": [{"position": [4, -5, 8], "color": 0.7}, {"position": [-6, -3, 7], "color": 0.3}]})");
    return path;
}

/// A file of mesh.json's scene, without what POV-Ray lacks or does otherwise: colored highlights, our textures,
/// normals.
std::filesystem::path write_mesh_scene(const std::filesystem::path& folder) {
    nlohmann::json scene = nlohmann::json::parse(std::ifstream(scene_file("mesh.json")));
    scene.erase("$schema");
    scene["materials"]["copper"].erase("specular_color");
    scene["textures"] = {{"marble", {{"checker", {0.8, 0.3}}, {"repeat", {4, 4}}}}};
    scene["objects"][0]["smooth"] = false;
    scene["objects"][0]["mesh"] = std::filesystem::absolute(scene_file("knot.ply")).string();
    const std::filesystem::path path = folder / "knot_between_mirrors.json";
    write_file_atomically(path.string(), scene.dump(2));
    return path;
}

void register_all(const std::vector<std::string>& arguments) {
    const std::filesystem::path folder = arguments.empty() ? "out/bench" : arguments[0];
    std::filesystem::create_directories(folder);
    const int cores = int(std::thread::hardware_concurrency());
    for (const Work& work : {Work(scene_file("benchmark.json"), 16, folder),
                             Work(write_glass_scene(folder), 24, folder), Work(write_mesh_scene(folder), 12, folder),
                             Work(scene_file("spheres.json"), 12, folder), Work(write_sky_scene(folder), 16, folder)}) {
        const SceneDescription scene = read_scene(work.scene.string());
        write_file_atomically(work.povray_scene.string(),
                              povray_scene(scene, camera_at(scene.camera, 0), width, height, work.depth));
        const auto add = [&](std::string name, void (*run)(benchmark::State&, const Work&, int), int threads) {
            name = work.scene.filename().string() + "/" + name;
            return benchmark::RegisterBenchmark(name.c_str(), run, work, threads)
                ->Iterations(1)
                ->Unit(benchmark::kMillisecond);
        };
        for (const int threads : std::set{1, 2, cores}) {
            add(fmt::format("povray/threads:{}", threads), time_povray, threads)->UseManualTime();
            add(fmt::format("cistula/threads:{}", threads), time_cistula, threads)->UseManualTime();
        }
        add("images", compare_images, cores)->Repetitions(1);
    }
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    return cistula::bench::run_program(argc, argv, cistula::bench::repetitions, cistula::bench::register_all);
}
