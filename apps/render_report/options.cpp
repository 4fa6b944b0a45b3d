#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <cmath>

#include "apps/common/command_line.h"
#include "apps/common/render_options.h"
#include "reference.h"
#include "render/picture_size.h"

namespace cistula::report {
namespace {

constexpr int quick_repetitions = 3;

/// The options' texts as CLI11 stores them.
struct Texts {
    std::vector<std::string> scenes, from;
    std::string output, json, verify, seed_baseline, cache, repetitions, limit;
    RenderRequest request;  // backend, devices, threads and resolution
    std::string scaling;
    bool no_cache = false, quick = false, quiet = false, version = false;
};

void declare(CLI::App& app, Texts& texts) {
    app.add_option("SCENE", texts.scenes, "scene files to measure")->type_name("");
    app.add_option("--from", texts.from, "show records that --json wrote, on whatever machine; measures nothing")
        ->type_name("FILE");
    app.add_option("-o,--output", texts.output, "the report, one HTML file that needs nothing else")->type_name("FILE");
    app.add_option("--json", texts.json, "write what was measured, for --from and for programs")->type_name("FILE");
    add_key(app, texts.request, "backend", "embree (CPU) or cuda (GPU); embree");
    add_key(app, texts.request, "device");
    add_key(app, texts.request, "threads", "threads; all");
    add_key(app, texts.request, "resolution", "frames of this many pixels; each scene's film");
    app.add_option("--repetitions", texts.repetitions, "timed runs of each setting after warm-up; 10, --quick 3")
        ->type_name("N");
    app.add_option("--limit", texts.limit, "leave out settings whose frames take longer than S seconds; 2")
        ->type_name("S");
    app.add_flag("--quick", texts.quick, "fewer settings and runs: to try it out");
    add_valued_flag(app, "--scaling", "also",
                    "also time against triangles, lights, depth, pixels and GPUs; --scaling=only: nothing else",
                    [&texts](const std::string& text) { texts.scaling = text; });
    app.add_option("--verify", texts.verify, "show the hard cases' verdicts from render-verify's --json")
        ->type_name("FILE");
    app.add_option("--seed-baseline", texts.seed_baseline,
                   "show the seed's algorithm from seed_baseline's --json, and ours beside it")
        ->type_name("FILE");
    app.add_option("--cache", texts.cache, "keep references in DIR; ~/.cache/cistula")->type_name("DIR");
    app.add_flag("--no-cache", texts.no_cache, "neither use nor keep references");
    app.add_flag("-q,--quiet", texts.quiet, "errors only");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

void refuse(bool given, const char* option, const char* why) {
    if (given) fail_usage(fmt::format("{}: {}", option, why));
}

void check_from(const CLI::App& app, const Texts& texts) {
    constexpr const char* why = "is for measuring; --from shows what was measured before";
    if (!texts.scenes.empty())
        fail_usage(fmt::format("{}: a scene and --from; measure the scene first with --json FILE, or leave --from out",
                               texts.scenes.front()));
    for (const char* option : {"--backend", "--device", "--threads", "--res", "--limit", "--repetitions", "--quick",
                               "--scaling", "--cache", "--no-cache", "--json"})
        refuse(app.count(option) > 0, option, why);
}

double limit_option(const std::string& text) {
    const std::optional<double> value = whole_number<double>(text);
    if (!value || !std::isfinite(*value) || *value <= 0)
        fail_usage(fmt::format("--limit {}: must be a number of seconds above 0, as in 2 or 0.5", text));
    return *value;
}

}  // namespace

ReportOptions parse_report_options(int argc, const char* const* argv) {
    CLI::App app;
    Texts texts;
    declare(app, texts);
    ReportOptions options;
    const bool whole = parse_command_line(
        app, argc, argv, [](const std::string& extra) { return fmt::format("{}: unexpected", extra); });
    if (!whole || texts.version) {
        options.action = whole ? Action::print_version : Action::print_help;
        return options;
    }
    if (texts.scenes.empty() && texts.from.empty())
        fail_usage("no scene is given; render-report SCENE... -o report.html, or --from FILE.json; --help tells more");
    for (const std::string& scene : texts.scenes) refuse(scene == "-", "-", "a report names its scenes; give files");
    if (!texts.from.empty()) check_from(app, texts);
    if (texts.output.empty() && texts.json.empty())
        fail_usage("nothing would be written; add -o FILE.html, or --json FILE");
    refuse(texts.output.empty() && !texts.from.empty(), "--from", "is shown in a page; add -o FILE.html");
    options.scenes = texts.scenes;
    options.from = texts.from;
    options.output = texts.output;
    options.json = texts.json;
    options.verify = texts.verify;
    options.seed_baseline = texts.seed_baseline;
    options.backend = texts.request.backend;
    options.devices = texts.request.devices;
    options.threads = texts.request.threads;
    options.width = texts.request.frame.full_width;
    options.height = texts.request.frame.full_height;
    options.quick = texts.quick;
    if (!texts.scaling.empty())
        read_given("--scaling", texts.scaling,
                   read_choice(options.scaling, {{"also", ScalingChoice::also}, {"only", ScalingChoice::only}}));
    if (options.scaling == ScalingChoice::only) {
        refuse(texts.scenes.size() > 1, "--scaling=only", "looks at one scene; give one");
        refuse(!texts.seed_baseline.empty(), "--seed-baseline",
               "is measured beside scenes; --scaling=only measures none");
    }
    options.quiet = texts.quiet;
    if (options.quick) options.repetitions = quick_repetitions;
    if (!texts.repetitions.empty())
        read_given("--repetitions", texts.repetitions, read_whole(options.repetitions, 1, 1000));
    if (!texts.limit.empty()) options.limit = limit_option(texts.limit);
    refuse(texts.no_cache && !texts.cache.empty(), "--no-cache", "and --cache are opposites; leave one out");
    if (!texts.no_cache) options.cache = texts.cache.empty() ? default_cache() : texts.cache;
    return options;
}

std::string report_help_text() {
    CLI::App app(
        "Measures what accuracy costs in time: every knob of a render alone and all together, against a reference, as "
        "a "
        "page.",
        "render-report");
    Texts texts;
    declare(app, texts);
    app.footer(R"(
Examples:
  render-report scenes/benchmark.json --quick --res 320x240 -o report.html
  render-report scenes/*.json --backend cuda --scaling -o report.html --json report.json
  render-report --from report.json --verify verify.json -o report.html       measured elsewhere

Exit codes: 0 done, 1 a frame cannot be trusted, 2 command line or scene, 3 file, 4 device, 130 interrupted.)");
    return app.help();
}

}  // namespace cistula::report
