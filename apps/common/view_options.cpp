#include "apps/common/view_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

const std::vector<std::string> own_views = {"srgb", "filmic"};

}  // namespace

void add_preview_options(CLI::App& app, std::string& preview, ViewTexts& texts) {
    app.add_option("--preview", preview, "also a PNG, clamped, sRGB; may hold a pattern")->type_name("FILE");
    app.add_option("--exposure", texts.exposure, "with --preview: stops by which it is brighter; 0")->type_name("EV");
    app.add_option("--view", texts.view,
                   "with --preview: srgb cuts off above white, filmic tells bright colors apart, or a view of "
                   "$OCIO; srgb")
        ->type_name("NAME");
    app.add_option("--bloom", texts.bloom, "with --preview: how much light above white glows around; 0")
        ->type_name("AMOUNT");
}

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
