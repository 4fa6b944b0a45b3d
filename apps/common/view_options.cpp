#include "apps/common/view_options.h"

#include <fmt/format.h>

#include "apps/common/command_line.h"
#include "scene/base/suggest.h"

namespace cistula {
namespace {

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
        view.exposure = number_option("--exposure", texts.exposure, -64, 64,
                                      "a number of stops from -64 to 64; each doubles the light");
    if (!texts.view.empty()) view.curve = parse_curve(texts.view);
    if (!texts.bloom.empty())
        view.bloom = number_option("--bloom", texts.bloom, 0, 100,
                                   "a number from 0 to 100; 1 adds the light above white once, spread around it");
    return view;
}

}  // namespace cistula
