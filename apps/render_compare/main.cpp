// render-compare: compares two images, or scenes with their golden images.
#include <algorithm>
#include <atomic>
#include <optional>
#include <string_view>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/shown_text.h"
#include "compare/metrics/compare.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/report.h"
#include "compare/metrics/sums.h"
#include "image/exr/exr.h"
#include "image/reader/picture_reader.h"
#include "options.h"
#include "suite_options.h"

namespace cistula {
namespace {

/// Writes the difference image; returns a line where there is nothing to write.
std::string write_differences(const CompareOptions& options, const StoredFile& a, const StoredFile& b) {
    const std::vector<PicturePart> parts = difference_parts(a, b, options.selection);
    if (parts.empty()) return one_line(options.diff) + ": not written, as no pixel has a partner\n";
    write_exr(options.diff, parts);
    return "";
}

bool compare_images(CompareOptions options) {
    StoredReader reader;
    const StoredFile a = reader.read(options.a), b = reader.read(options.b);
    if (!options.mask.empty()) options.selection.mask = mask_of(reader.read(options.mask).pictures.front());
    Comparison comparison = compare_files(a, b, options.thresholds, options.selection);
    for (std::string& line : comparison.not_compared) line = with_options(line);
    std::optional<FlipResult> flip;
    if (options.flip) {
        std::atomic<bool> stop = false;
        InterruptGuard guard;  // before there are files and processes
        guard.watch(stop);
        flip = flip_of(a, b, options.selection, stop);
    }
    std::string text = with_options(report_text(comparison, options.thresholds, flip ? &*flip : nullptr));
    if (!options.diff.empty()) text += write_differences(options, a, b);
    if (!options.json.empty()) {
        auto json = report_json(comparison, options.thresholds, options.a, options.b, flip ? &*flip : nullptr);
        json["verdict"] = with_options(json["verdict"].get<std::string>());
        write_file_atomically(options.json, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }
    if (!options.quiet) print(text);
    return passes(comparison, options.thresholds);
}

bool check_sums(const CompareOptions& options) {
    const LayeredPicture picture = read_exr(options.a);
    const std::vector<DivisionSums> divisions = division_sums(picture);
    if (divisions.empty())
        throw Error(ErrorKind::file,
                    one_line(options.a) +
                        ": has no R G B with all layers by path or by light; render --layers path,light writes them");
    if (!options.quiet)
        print(sums_text(divisions, static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height)));
    return std::all_of(divisions.begin(), divisions.end(), [](const DivisionSums& d) { return d.pixels_off == 0; });
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
            holds = compare_images(options);
            break;
        case CompareAction::sums:
            holds = check_sums(options);
            break;
    }
    return static_cast<int>(holds ? ExitCode::done : ExitCode::failed);
}

}  // namespace
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-compare", "smaller images need less", [&] {
        if (argc > 1 && std::string_view(argv[1]) == "suite") return run_suite(argc - 1, argv + 1);
        return run(parse_compare_options(argc, argv));
    });
}
