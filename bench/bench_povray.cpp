// Cistula against POV-Ray 3.7 on scenes/benchmark.json: the time to trace it, and whether the pictures agree.
// bench_povray [FOLDER]: scene and pictures go there (out/bench).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "povray_scene.h"
#include "program.h"
#include "scene/base/error.h"
#include "scene/image/exr.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int width = 640, height = 480, depth = 16, threads = 2, repetitions = 5;
/// A difference that 8 bits do not show.
constexpr float visible = 0.004f;

struct Paths {
    std::filesystem::path scene, povray_scene, povray_image, image, stats;
} paths;

/// The number in parentheses that POV-Ray ends "Trace Time: 0 hours 0 minutes 7 seconds (7.418 seconds)" with.
double povray_trace_seconds(const std::string& log) {
    const size_t line = log.find("Trace Time:");
    const size_t begin = line == log.npos ? line : log.find('(', line);
    if (begin == log.npos) throw Error(ExitCode::failed, "POV-Ray's output names no trace time");
    return std::stod(log.substr(begin + 1));
}

double run_povray() {
    return povray_trace_seconds(
        output_of(fmt::format("povray {} {} +FE +W{} +H{} +WT{} -A -D -V", quoted("+I" + paths.povray_scene.string()),
                              quoted("+O" + paths.povray_image.string()), width, height, threads)));
}

nlohmann::json run_cistula() {
    output_of(
        fmt::format("{} {} -o {} --res {}x{} --depth {} --cutoff 0 --supersample 1 --threads {} --stats {} "
                    "--progress none -q",
                    quoted(CISTULA_BIN_DIR "/render"), quoted(paths.scene), quoted(paths.image), width, height, depth,
                    threads, quoted(paths.stats)));
    const nlohmann::json stats = nlohmann::json::parse(std::ifstream(paths.stats));
    for (const auto& entry : stats.at("benchmarks"))
        if (entry.contains("render_ms")) return entry;
    throw Error(ExitCode::failed, paths.stats.string() + ": names no frame");
}

void time_povray(benchmark::State& state) {
    for (auto _ : state) state.SetIterationTime(run_povray());
}

void time_cistula(benchmark::State& state) {
    for (auto _ : state) {
        const nlohmann::json frame = run_cistula();
        state.SetIterationTime(frame.at("render_ms").get<double>() / 1e3);
        state.counters["rays"] = frame.at("rays").at("total").get<double>();
        state.counters["rays_per_second"] = frame.at("rays_per_second").get<double>();
    }
}

const LayeredPicture::Channel& channel(const LayeredPicture& picture, std::string_view name) {
    for (const LayeredPicture::Channel& c : picture.channels)
        if (c.name == name) return c;
    throw Error(ExitCode::failed, "a picture has no channel " + std::string(name));
}

/// Per pixel the largest difference of its channels; POV-Ray writes half floats, which at 1 are 0.0005 apart.
void compare_images(benchmark::State& state) {
    for (auto _ : state) {
        run_povray();
        run_cistula();
        const LayeredPicture theirs = read_exr(paths.povray_image.string()), ours = read_exr(paths.image.string());
        if (theirs.width != width || theirs.height != height || ours.width != width || ours.height != height)
            throw Error(ExitCode::failed, "the pictures to compare differ in size");
        double sum = 0, worst = 0, sum_ours = 0, sum_theirs = 0;
        int agree = 0;
        for (size_t i = 0; i < size_t(width * height); ++i) {
            float difference = 0;
            for (const char* name : {"R", "G", "B"}) {
                const float a = channel(ours, name).values[i], b = channel(theirs, name).values[i];
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

void register_all(const std::vector<std::string>& arguments) {
    const std::filesystem::path folder = arguments.empty() ? "out/bench" : arguments[0];
    std::filesystem::create_directories(folder);
    paths = {scene_file("benchmark.json"), folder / "benchmark.pov", folder / "benchmark_povray.exr",
             folder / "benchmark_cistula.exr", folder / "benchmark_stats.json"};
    const SceneDescription scene = read_scene(paths.scene.string());
    std::ofstream file(paths.povray_scene);
    file << povray_scene(scene, camera_at(scene.camera, 0), width, height, depth);
    if (!file.flush()) throw Error(ExitCode::file, paths.povray_scene.string() + ": cannot be written");
    const auto add = [](const char* name, void (*run)(benchmark::State&)) {
        return benchmark::RegisterBenchmark(name, run)->Iterations(1)->Unit(benchmark::kMillisecond);
    };
    add("benchmark.json/povray", time_povray)->UseManualTime();
    add("benchmark.json/cistula", time_cistula)->UseManualTime();
    add("benchmark.json/images", compare_images)->Repetitions(1);
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    return cistula::bench::run_program(argc, argv, cistula::bench::repetitions, cistula::bench::register_all);
}
