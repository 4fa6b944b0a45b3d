// render-view: shows layers of an EXR as a PNG.
#include <fmt/format.h>

#include "apps/common/command_line.h"
#include "base/file_bytes.h"
#include "image/picture/picture_io.h"
#include "layer_choice.h"
#include "options.h"
#include "sequence/output_name.h"
#include "sequence/render_request.h"
#include "sheet.h"

namespace cistula {
namespace {

void show(ViewOptions options) {
    const ExrFile file(options.file);
    const std::vector<Layer> layers = layers_of(file.parts());
    if (layers.empty()) throw file_error(options.file, "show", std::string("it has no channels"));
    if (options.action == ViewAction::list) return print(layer_table(file.parts(), layers));
    if (const std::string warning = open_config_view(options.view); !warning.empty() && !options.quiet)
        note(fmt::format("render-view: warning: {}", warning));
    const Sheet sheet = make_sheet(
        file, options.all ? layers : chosen_layers(file.parts(), layers, options.layers, options.file), options);
    make_directory_of(options.output);
    write_preview(options.output, sheet.picture);
    if (options.quiet) return;
    try {
        print(fmt::format("{}: {}x{}\n{}", one_line(options.output), sheet.picture.width, sheet.picture.height,
                          sheet.legend));
    } catch (const Error& error) {  // the PNG, which was asked for, is written
        note(fmt::format("render-view: warning: {}", error.what()));
    }
}

void run(const ViewOptions& options) {
    switch (options.action) {
        case ViewAction::print_help:
            return print(view_help_text());
        case ViewAction::print_version:
            return print("render-view (Cistula) " CISTULA_VERSION "\n");
        case ViewAction::list:
        case ViewAction::show:
            return show(options);
    }
}

}  // namespace
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-view", "fewer layers at a time need less", [&] {
        run(parse_view_options(argc, argv));
        return static_cast<int>(ExitCode::done);
    });
}
