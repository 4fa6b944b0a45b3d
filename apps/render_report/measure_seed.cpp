// The seed's algorithm compared with ours.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/file_bytes.h"
#include "measure.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/read_scene.h"

namespace cistula::report {
namespace {

/// Parses a benchmark's name: "seed/3840x2160/depth:4/grid:16" or ".../cpu".
bool parse_name(const std::string& name, SeedTable& table, SeedRow& row) {
    int end = 0;
    if (std::sscanf(name.c_str(), "seed/%dx%d/depth:%d%n", &table.width, &table.height, &row.depth, &end) != 3)
        return false;
    const std::string rest = name.substr(static_cast<size_t>(end));
    if (rest == "/cpu") return true;
    return std::sscanf(rest.c_str(), "/grid:%d", &row.grid) == 1;
}

}  // namespace

SeedTable read_seed_table(const std::string& file) {
    const std::string text = read_file(file);
    try {
        const Json json = parse_json(text, "its JSON");
        SeedTable table;
        table.context = json.at("context");
        table.scene = std::filesystem::path(text_of(table.context, "scene")).stem().string();
        for (const Json& benchmark : json.at("benchmarks")) {
            SeedRow row;
            if (!parse_name(benchmark.at("name").get<std::string>(), table, row)) continue;
            benchmark.at("repetition_times").get_to(row.time.runs);
            if (row.time.empty()) throw std::runtime_error("a benchmark has no times");
            table.seed.push_back(row);
        }
        if (table.scene.empty() || table.seed.empty()) throw std::runtime_error("it times no algorithm of a scene");
        return table;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::file, fmt::format("{}: is no record of seed_baseline ({}); give what its --json wrote",
                                                 file, error.what()));
    }
}

bool is_same_machine(const Json& seed, const Json& context) {
    if (text_of(seed, "cpu").empty() || text_of(seed, "cpu") != text_of(context, "cpu")) return false;
    if (seed.value("num_cpus", 0) != context.value("num_cpus", 0)) return false;
    const bool on_gpu = seed.contains("gpu"), ours_on_gpu = context.contains("devices");
    if (on_gpu != ours_on_gpu) return false;
    if (!on_gpu) return text_of(seed, "host_name") == text_of(context, "host_name");
    const Json& devices = context.at("devices");
    return devices.size() == 1 && devices[0] == text_of(seed, "gpu") &&
           text_of(seed, "driver") == text_of(context, "gpu_driver");
}

void measure_seed_table(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                        const Record& record, SeedTable& table) {
    table.same_machine = is_same_machine(table.context, record.context);
    if (!table.same_machine) return;
    const SceneDescription description = read_scene(scene_file);
    Frames frames(description, settings.machine, table.width, table.height, progress);
    std::vector<int> depths;
    for (const SeedRow& row : table.seed)
        if (depths.empty() || depths.back() != row.depth) depths.push_back(row.depth);
    const int rounds = settings.warm_ups + settings.repetitions;
    progress.begin(table.scene + ": beside the seed's algorithm", 2.0 * static_cast<double>(depths.size()) * rounds);
    Film film;
    for (const int depth : depths)
        for (const Precision precision : {Precision::single_, Precision::double_}) {
            Setting setting;
            setting.depth = depth;
            setting.precision = precision;
            OwnRow row{depth, precision_name(precision), {}};
            for (int round = 0; round < rounds; ++round) {
                const double seconds = frames.render(setting, film);
                if (round >= settings.warm_ups)  // the seed's times are those of kernels, too
                    row.time.runs.push_back(frames.kernel_ms(setting, seconds));
                progress.advance();
            }
            table.ours.push_back(std::move(row));
        }
}

}  // namespace cistula::report
