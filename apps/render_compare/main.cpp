// render-compare: compares two images, or a backend's images with the golden ones.
#include "apps/common/command_line.h"
#include "compare.h"
#include "golden_run.h"
#include "options.h"
#include "report.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/shown_text.h"
#include "scene/image/exr.h"

namespace cistula {
namespace {

bool compare_files(const CompareOptions& options) {
    const LayeredPicture a = read_exr(options.a), b = read_exr(options.b);
    const Comparison comparison = compare_pictures(a, b, options.thresholds);
    std::string text = report_text(comparison, options.thresholds);
    if (!options.diff.empty()) {
        if (comparison.channels.empty())
            text += one_line(options.diff) + ": not written, as no pixel has a partner\n";
        else
            write_exr(options.diff, difference_picture(a, b));
    }
    if (!options.json.empty())
        write_file_atomically(
            options.json,
            report_json(comparison, options).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!options.quiet) print(text);
    return passes(comparison, options.thresholds);
}

int run(const CompareOptions& options) {
    bool holds = true;
    switch (options.action) {
        case CompareAction::print_help:
            print(compare_help_text());
            break;
        case CompareAction::print_version:
            print("render-compare (Cistula) " CISTULA_VERSION "\n");
            break;
        case CompareAction::compare:
            holds = compare_files(options);
            break;
        case CompareAction::golden:
            holds = run_golden(options);
            break;
    }
    return static_cast<int>(holds ? ExitCode::done : ExitCode::failed);
}

}  // namespace
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-compare", "smaller images need less",
                       [&] { return run(parse_compare_options(argc, argv)); });
}
