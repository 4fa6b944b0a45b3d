#include "apps/common/view_options.h"

#include <fmt/format.h>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

const std::vector<std::string> own_views = {"srgb", "filmic"};

}  // namespace

PictureView parse_view(const ViewTexts& texts) {
    PictureView view;
    if (!texts.exposure.empty())
        view.exposure = number_option("--exposure", texts.exposure, -64, 64,
                                      "a number of stops from -64 to 64; each doubles the light");
    if (texts.view == "filmic") {
        view.curve = ViewCurve::filmic;
    } else if (texts.view != "srgb") {
        view.name = texts.view;
    }
    if (!texts.bloom.empty())
        view.bloom = number_option("--bloom", texts.bloom, 0, 100,
                                   "a number from 0 to 100; 1 adds the light above white once, spread around it");
    return view;
}

std::string open_config_view(PictureView& view) {
    if (view.name.empty()) return "";
    view.config = std::make_shared<const ConfigView>(view.name, own_views);
    return view.config->warning();
}

}  // namespace cistula
