#include "apps/common/view_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

const std::vector<std::string> own_views = {"srgb", "filmic"};

}  // namespace

OptionReader read_exposure(PictureView& view) {
    return read_number(view.exposure, -64, 64, "a number of stops from -64 to 64; each doubles the light");
}

OptionReader read_view(PictureView& view) {
    return [&view](const char*, const std::string& text) {
        if (text == "filmic")
            view.curve = ViewCurve::filmic;
        else if (text != "srgb")
            view.name = text;
    };
}

OptionReader read_bloom(PictureView& view) {
    return read_number(view.bloom, 0, 100,
                       "a number from 0 to 100; 1 adds the light above white once, spread around it");
}

void add_preview_options(CLI::App& app, std::string& preview, PictureView& view) {
    CLI::Option* const shown =
        app.add_option("--preview", preview, "also a PNG, clamped, sRGB; may hold a pattern")->type_name("FILE");
    const auto add = [&](const char* name, const char* value, const char* description, const OptionReader& read) {
        add_option(app, name, value, description, read)->needs(shown);
    };
    add("--exposure", "EV", "with --preview: stops by which it is brighter; 0", read_exposure(view));
    add("--view", "NAME",
        "with --preview: srgb cuts off above white, filmic tells bright colors apart, or a view of $OCIO; srgb",
        read_view(view));
    add("--bloom", "AMOUNT", "with --preview: how much light above white glows around; 0", read_bloom(view));
}

std::string open_config_view(PictureView& view) {
    if (view.name.empty()) return "";
    view.config = std::make_shared<const ConfigView>(view.name, own_views);
    return view.config->warning();
}

}  // namespace cistula
