#include "program.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <filesystem>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "apps/common/step_progress.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_bytes.h"
#include "html.h"
#include "html_page.h"
#include "measure.h"
#include "options.h"
#include "scene/compile/scene_source.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/read_scene.h"
#include "sequence/run_files.h"

namespace cistula::report {
namespace {

/// Reads render-verify's record.
Json read_verdicts(const std::string& file) {
    const std::string text = read_file(file);
    try {
        Record record;
        record.verify = parse_json(text, "its JSON");
        (void)verify_section({record});  // throws for what its table does not find
        return *record.verify;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::file, fmt::format("{}: is no record of render-verify ({}); give what its --json wrote",
                                                 file, error.what()));
    }
}

Record measure(const ReportOptions& options, int threads) {
    const ChosenDevices devices = choose_devices(options.backend, options.devices);
    Record record;
    if (!options.verify.empty()) record.verify = read_verdicts(options.verify);
    if (!options.seed_baseline.empty()) record.seed = read_seed_table(options.seed_baseline);

    MeasureSettings settings;
    settings.machine = {options.backend, devices.options};
    settings.repetitions = options.repetitions;
    settings.warm_ups = options.quick ? 1 : settings.warm_ups;
    settings.quick = options.quick;
    settings.limit = options.limit;
    settings.width = options.width;
    settings.height = options.height;
    settings.cache = options.cache;
    record.context = machine_context(backend_name(options.backend), devices.names, devices.driver);
    record.context["threads"] = threads;
    record.context["repetitions"] = settings.repetitions;
    record.context["warm_ups"] = settings.warm_ups;
    record.context["quick"] = settings.quick;
    record.context["limit_seconds"] = settings.limit;

    const ProgressStyle style = is_terminal() ? ProgressStyle::automatic : ProgressStyle::plain;
    StepProgress progress(options.quiet ? ProgressStyle::none : style);
    InterruptGuard guard;
    guard.watch(progress.render.stop);
    if (options.scaling != ScalingChoice::only)
        for (const std::string& scene : options.scenes) measure_scene(scene, settings, progress, record);
    if (record.seed) {
        for (const std::string& scene : options.scenes)
            if (std::filesystem::path(scene).stem() == record.seed->scene)
                measure_seed_table(scene, settings, progress, record, *record.seed);
    }
    if (options.scaling != ScalingChoice::none) measure_scaling(options.scenes.front(), settings, progress, record);
    return record;
}

std::vector<Record> read_records(const ReportOptions& options) {
    std::vector<Record> records;
    for (const std::string& file : options.from) records.push_back(parse_record(read_file(file), file));
    if (!options.verify.empty()) records.front().verify = read_verdicts(options.verify);
    if (!options.seed_baseline.empty()) {
        SeedTable table = read_seed_table(options.seed_baseline);
        for (Record& record : records)
            if (record.seed && record.seed->scene == table.scene && record.seed->context == table.context)
                return records;  // it is included, with ours
        records.front().seed = std::move(table);
    }
    return records;
}

/// The page for these records. Throws Error (file) if a file's values have wrong types.
std::string page_of(const std::vector<Record>& records, const ReportOptions& options) {
    try {
        return report_page(records);
    } catch (const Json::exception& error) {
        std::vector<std::string> files = options.from;
        for (const std::string& file : {options.verify, options.seed_baseline})
            if (!file.empty()) files.push_back(file);
        throw Error(ErrorKind::file, fmt::format("{}: a value is not of its type ({}); give what --json wrote",
                                                 fmt::join(files, ", "), error.what()));
    }
}

/// Throws Error (usage) if a file to be written is read too, or both are one.
void require_different_files(const ReportOptions& options) {
    RunFiles files;
    for (const std::string& file : options.from) files.reads(file, "--from");
    files.reads(options.verify, "--verify");
    files.reads(options.seed_baseline, "--seed-baseline");
    for (const std::string& scene : options.scenes) files.reads_scene(scene, gather_scene(read_scene(scene)).files);
    files.writes(options.json, "--json");
    files.writes(options.output, "--output");
}

int run(const ReportOptions& options) {
    require_different_files(options);
    // Checked before a long run rather than after it.
    for (const std::string& file : {options.output, options.json})
        if (!file.empty()) AtomicFile probe(file);
    std::vector<Record> records;
    if (!options.from.empty()) {
        records = read_records(options);
    } else {
        const int threads = options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] { records.push_back(measure(options, threads)); });
    }
    if (!options.json.empty()) write_file_atomically(options.json, record_text(records.front()));
    if (!options.output.empty()) write_file_atomically(options.output, page_of(records, options));
    return static_cast<int>(ExitCode::done);
}

}  // namespace

int report_program(int argc, const char* const* argv) {
    const ReportOptions options = parse_report_options(argc, argv);
    switch (options.action) {
        case Action::print_help:
            print(report_help_text());
            return 0;
        case Action::print_version:
            print("render-report (Cistula) " CISTULA_VERSION "\n");
            return 0;
        case Action::report:
            break;
    }
    return run(options);
}

}  // namespace cistula::report
