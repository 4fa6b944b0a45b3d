#include "apps/common/view_options.h"

#include <fmt/format.h>

#include "apps/common/command_line.h"
#include "scene/base/suggest.h"

namespace cistula {
namespace {

double number_between(const char* option, const std::string& text, double low, double high, const char* what) {
    const std::optional<double> value = whole_number<double>(text);
    if (!value || !(*value >= low && *value <= high)) fail_usage(fmt::format("{} {}: must be {}", option, text, what));
    return *value;
}

ViewCurve parse_curve(const std::string& text) {
    if (text == "srgb") return ViewCurve::srgb;
    if (text == "filmic") return ViewCurve::filmic;
    fail_usage(
        fmt::format("--view {}: there is no such view; {}", text, nearest_first(text, {"srgb", "filmic"}, "views")));
}

}  // namespace

PictureView parse_view(const ViewTexts& texts) {
    PictureView view;
    if (!texts.exposure.empty())
        view.exposure = number_between("--exposure", texts.exposure, -64, 64,
                                       "a number of stops from -64 to 64; each doubles the light");
    if (!texts.view.empty()) view.curve = parse_curve(texts.view);
    if (!texts.bloom.empty())
        view.bloom = number_between("--bloom", texts.bloom, 0, 100,
                                    "a number from 0 to 100; 1 adds the light above white once, spread around it");
    return view;
}

}  // namespace cistula
