// render-compare: compares two images, or scenes with their golden images.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "apps/common/programs.h"
#include "base/error.h"
#include "base/file_bytes.h"
#include "base/shown_text.h"
#include "compare/metrics/compare.h"
#include "compare/metrics/report.h"
#include "compare/metrics/sums.h"
#include "image/exr/exr.h"
#include "image/reader/picture_reader.h"
#include "options.h"
#include "sequence/output_name.h"
#include "sequence/run_files.h"
#include "suite_options.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// Two images that are compared, in the way of the options.
struct Judged {
    bool holds = false;
    std::string verdict, text;  // a line, and the report
    nlohmann::ordered_json json;
};

Judged judge_files(const CompareOptions& options, const std::string& first, const std::string& second,
                   StopSignal stop) {
    StoredReader reader;
    const auto [a, b] = reader.read_two(first, second, [&](const StoredFile& one, const StoredFile& other) {
        return compares_values(one, other, options.selection);
    });
    stop.check();
    Selection selection = options.selection;
    if (!options.mask.empty()) selection.mask = mask_of(reader.read(options.mask).pictures.front());
    Comparison comparison = compare_files(a, b, options.thresholds, selection, stop);
    for (std::string& line : comparison.not_compared) line = with_options(line);
    Judged judged{passes(comparison, options.thresholds), with_options(verdict(comparison, options.thresholds)),
                  with_options(report_text(comparison, options.thresholds)),
                  report_json(comparison, options.thresholds, first, second)};
    judged.json["verdict"] = judged.verdict;
    if (!options.diff.empty()) {
        const std::vector<PicturePart> parts = difference_parts(a, b, selection);
        if (parts.empty())
            judged.text += one_line(options.diff) + ": not written, as no pixel has a partner\n";
        else
            write_exr(options.diff, parts);
    }
    return judged;
}

/// Images by what pairs them.
using Images = std::map<std::string, std::string>;

/// Adds the images of a folder and of those in it, by their names after `before`. `around`: the folders that it is in.
void add_images(const fs::path& folder, const std::string& before, std::set<fs::path>& around, Images& images) {
    constexpr std::string_view kinds[] = {".exr", ".png", ".tif", ".tiff", ".jpg", ".jpeg",
                                          ".hdr", ".tga", ".bmp", ".dpx",  ".webp"};
    const auto [real, is_new] = around.insert(fs::canonical(folder));
    if (!is_new) throw Error(ErrorKind::file, "leads back to a folder that it is in").at(folder.string());
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string own = entry.path().filename().string();
        if (fs::is_directory(entry.path()))  // links are followed
            add_images(entry.path(), before + own + '/', around, images);
        else if (std::count(std::begin(kinds), std::end(kinds), lower_extension(own)) > 0)
            images[before + own] = entry.path().string();
    }
    around.erase(real);
}

/// The images of a folder by their paths in it, those of a sequence by their numbers.
Images images_of(const std::string& text) {
    Images images;
    try {
        if (fs::is_directory(text)) {
            std::set<fs::path> around;
            add_images(text, "", around, images);
        } else {
            const OutputName name(text, "the images");
            const fs::path folder = fs::path(text).parent_path();
            for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder)) {
                const std::string own = entry.path().filename().string();
                for (const int frame : numbers_in(own))
                    if (fs::path(name.for_frame(frame)).filename() == own)
                        images[std::to_string(frame)] = (folder / own).string();
            }
        }
    } catch (const fs::filesystem_error& error) {
        throw file_error(error.path1().string(), "read", error.code().value());
    }
    if (images.empty()) throw Error(ErrorKind::file, "has no images").at(text);
    return images;
}

/// Several images and their partners, a line for each.
Judged judge_several(const CompareOptions& options, StopSignal stop) {
    const Images first = images_of(options.a);
    const Images second = images_of(options.b);
    std::set<std::string> names;
    RunFiles files;
    for (const auto* images : {&first, &second})
        for (const auto& [name, path] : *images) {
            names.insert(name);
            files.reads(path, "an image");
        }
    if (options.json != "-") files.writes(options.json, "--json");
    Judged all;
    all.json = {{"first", options.a}, {"second", options.b}, {"holds", true}, {"images", nlohmann::json::array()}};
    size_t held = 0;
    for (const std::string& name : names) {
        const auto a = first.find(name);
        const auto b = second.find(name);
        Judged one;
        if (a == first.end() || b == second.end()) {
            one.verdict = a == first.end() ? "only in the second" : "only in the first";
            one.json = {{"holds", false}, {"verdict", one.verdict}};
        } else {
            one = judge_files(options, a->second, b->second, stop);
        }
        held += one.holds;
        one.json["name"] = name;
        all.json["images"].push_back(std::move(one.json));
        all.text += fmt::format("{}: {}\n", one_line(name), one_line(one.verdict));
    }
    all.holds = held == names.size();
    all.json["holds"] = all.holds;
    all.text += all.holds ? fmt::format("hold: all {} images\n", held)
                          : fmt::format("differ: {} of {} images\n", names.size() - held, names.size());
    return all;
}

bool compare_images(const CompareOptions& options) {
    std::atomic<bool> stop = false;
    std::optional<StopOnInterrupt> watch;
    // FLIP has files and processes to leave in order; nothing else does.
    if (options.selection.flip || options.thresholds.flip) watch.emplace(stop);
    const Judged judged =
        names_several(options.a) ? judge_several(options, stop) : judge_files(options, options.a, options.b, stop);
    const std::string json = judged.json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    write_output(options.json, json);
    if (!options.quiet && options.json != "-") print(judged.text);
    return judged.holds;
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

int render_compare_program(int argc, const char* const* argv) {
    return run_program("render-compare", "smaller images need less", [&] {
        if (argc > 1 && std::string_view(argv[1]) == "suite") return run_suite(argc - 1, argv + 1);
        return run(parse_compare_options(argc, argv));
    });
}

}  // namespace cistula
