// How two pictures differ.
#include "compare/metrics/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>
#include <variant>

#include <nanobind/stl/variant.h>

#include "compare/metrics/report.h"
#include "image.h"
#include "image/reader/picture_reader.h"
#include "module.h"

namespace cistula::python {
namespace {

using Side = std::variant<std::string, const Image*>;

/// A comparison with what judges it.
struct Judged {
    Comparison comparison;
    Thresholds thresholds;
    std::string first, second;  // names
};

StoredFile file_of(const Side& side, bool both_are_images, StoredReader& reader) {
    if (const auto* path = std::get_if<std::string>(&side)) return reader.read(*path);
    StoredFile file = stored_file(std::get<const Image*>(side)->picture);
    if (!both_are_images) file.format = "memory";  // whose header is not one of a file
    return file;
}

std::string name_of_side(const Side& side) {
    const auto* path = std::get_if<std::string>(&side);
    return path ? *path : "an image";
}

Judged compare(const Side& a, const Side& b, std::optional<double> fail, double failpercent,
               std::optional<double> hardfail, bool allow_nonfinite, std::vector<std::string> layers) {
    check_process();
    for (const auto& [name, value, high] : {std::tuple{"fail", fail, double(INFINITY)},
                                            {"hardfail", hardfail, double(INFINITY)},
                                            {"failpercent", std::optional(failpercent), 100.0}})
        if (value && !(*value >= 0 && *value <= high))
            throw Error(ErrorKind::usage, fmt::format("`{}`={}: must be a number from 0 to {}", name, *value, high));
    if (failpercent > 0 && !fail)
        throw Error(ErrorKind::usage, fmt::format("`failpercent`={}: is for `fail`", failpercent));
    Thresholds thresholds{fail, failpercent, hardfail};
    thresholds.allow_nonfinite = allow_nonfinite;
    if (allow_nonfinite && !thresholds.any())
        throw Error(ErrorKind::usage, "`allow_nonfinite`: is for `fail` or `hardfail`; without them every bit counts");
    const WithoutGil free;
    StoredReader reader;
    Selection selection;
    selection.layers = std::move(layers);
    const bool images = std::holds_alternative<const Image*>(a) && std::holds_alternative<const Image*>(b);
    return {compare_files(file_of(a, images, reader), file_of(b, images, reader), thresholds, selection), thresholds,
            name_of_side(a), name_of_side(b)};
}

}  // namespace

void bind_compare(nb::module_& m) {
    using Channel = ChannelStatistics;
    nb::class_<Channel>(m, "ChannelDifference", "How a channel differs.")
        .def_prop_ro(
            "name", [](const Channel& c) { return c.name; }, "Its name, after its part's where it has one.")
        .def_prop_ro(
            "max", [](const Channel& c) { return c.max; }, "The largest absolute difference.")
        .def_prop_ro(
            "mean", [](const Channel& c) { return c.mean; }, "The mean absolute difference.")
        .def_prop_ro(
            "rmse", [](const Channel& c) { return c.rmse; }, "The root of the mean square difference.")
        .def_prop_ro(
            "psnr", [](const Channel& c) { return c.psnr; }, "Peak signal to noise ratio in dB.")
        .def_prop_ro(
            "differing", [](const Channel& c) { return c.differing; }, "Values with different bits.")
        .def_prop_ro(
            "values", [](const Channel& c) { return c.values; }, "Values that were compared.")
        .def_prop_ro(
            "x", [](const Channel& c) { return c.x; }, "The column of the largest difference.")
        .def_prop_ro(
            "y", [](const Channel& c) { return c.y; }, "The row of the largest difference.")
        .def_prop_ro(
            "a", [](const Channel& c) { return c.a; }, "The first picture's value there.")
        .def_prop_ro(
            "b", [](const Channel& c) { return c.b; }, "The second picture's value there.");
    nb::class_<Judged>(m, "Comparison", "How two pictures differ, and whether that is allowed.")
        .def_prop_ro(
            "passes", [](const Judged& j) { return passes(j.comparison, j.thresholds); },
            "Whether the differences are allowed; without thresholds, whether all bits are equal.")
        .def("__bool__", [](const Judged& j) { return passes(j.comparison, j.thresholds); })
        .def_prop_ro(
            "max", [](const Judged& j) { return j.comparison.max; }, "The largest difference of any channel.")
        .def_prop_ro(
            "pixels", [](const Judged& j) { return j.comparison.pixels; }, "Pixels that were compared.")
        .def_prop_ro(
            "over_fail", [](const Judged& j) { return j.comparison.over_fail; },
            "Pixels that differ by more than `fail`.")
        .def_prop_ro(
            "channels", [](const Judged& j) { return j.comparison.channels; }, "Each channel's differences.")
        .def_prop_ro(
            "structure", [](const Judged& j) { return j.comparison.structure; },
            "Differences of parts, windows and channels, which are never allowed.")
        .def_prop_ro(
            "header", [](const Judged& j) { return j.comparison.header; }, "Differences of headers.")
        .def_prop_ro(
            "verdict", [](const Judged& j) { return verdict(j.comparison, j.thresholds); },
            "One line: whether it passes, and why.")
        .def(
            "text", [](const Judged& j) { return report_text(j.comparison, j.thresholds); },
            "What render-compare prints.")
        .def(
            "json", [](const Judged& j) { return report_json(j.comparison, j.thresholds, j.first, j.second).dump(); },
            "What `render-compare --json` writes.")
        .def("__repr__",
             [](const Judged& j) { return "<cistula.Comparison: " + verdict(j.comparison, j.thresholds) + ">"; });
    m.def("compare", compare, "a"_a, "b"_a, "fail"_a.none(), "failpercent"_a, "hardfail"_a.none(), "allow_nonfinite"_a,
          "layers"_a, "Compares two files or images. Internal.");
}

}  // namespace cistula::python
