// OpenEXR files of any number of parts, as render-view shows them.
#include "apps/render_view/layer_choice.h"
#include "apps/render_view/sheet.h"
#include "checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    const fuzz::MemoryFile memory(data, size);
    try {
        const ExrFile file(memory.path());
        const std::vector<Layer> layers = layers_of(file.parts());
        if (layers.empty()) return 0;
        fuzz::require(!layer_table(file.parts(), layers).empty());
        ViewOptions options;
        options.view = {1, ViewCurve::filmic, 1};
        const Sheet one = make_sheet(file, {default_layer(layers)}, options), all = make_sheet(file, layers, options);
        fuzz::require(one.picture.texels.size() == static_cast<size_t>(one.picture.width) * one.picture.height);
        fuzz::require(all.picture.texels.size() >= one.picture.texels.size());
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::usage)  // too large a sheet
            fuzz::check_line(error.what());
        else
            fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
