#include "sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "apps/common/command_line.h"
#include "base/suggest.h"
#include "image/color/srgb_codes.h"

namespace cistula {
namespace {

constexpr size_t gap = 8;  // pixels between layers

/// The places of pictures in a sheet.
struct Grid {
    Grid(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers, size_t most_columns)
        : columns(std::min(most_columns, layers.size())), rows((layers.size() + columns - 1) / columns) {
        for (const Layer& layer : layers) {
            cell_width = std::max(cell_width, static_cast<size_t>(parts[layer.part].width));
            cell_height = std::max(cell_height, static_cast<size_t>(parts[layer.part].height));
        }
    }
    size_t width() const { return columns * (cell_width + gap) - gap; }
    size_t height() const { return rows * (cell_height + gap) - gap; }
    size_t x(size_t index) const { return index % columns * (cell_width + gap); }
    size_t y(size_t index) const { return index / columns * (cell_height + gap); }

    size_t columns, rows, cell_width = 0, cell_height = 0;
};

void place(const ColorPicture& picture, size_t x, size_t y, ColorPicture& sheet) {
    for (size_t row = 0; row < picture.height; ++row)
        std::copy_n(&picture.texels[row * picture.width], picture.width, &sheet.texels[(y + row) * sheet.width + x]);
}

std::string describe(const Layer& layer, const ShownLayer& shown) {
    std::string text = fmt::format("{}: {}", one_line(layer.name), kind_name(layer.kind));
    if (!shown.values.empty()) text += ", " + shown.values;
    const auto add = [&](size_t pixels, const char* what) {
        if (pixels > 0) text += fmt::format(", {} {} {}", pixels, pixels == 1 ? "pixel is" : "pixels are", what);
    };
    add(shown.nans, "not a number (magenta)");
    add(shown.infinities, "infinite (cyan)");
    return text;
}

/// The channels of a part that some of the layers have, with their values; the others are empty.
std::vector<ExrChannel> read_channels(const ExrFile& file, size_t part, const std::vector<Layer>& layers) {
    std::set<size_t> wanted;
    for (const Layer& layer : layers)
        if (layer.part == part) wanted.insert(layer.channels.begin(), layer.channels.end());
    std::vector<ExrChannel> channels(file.parts()[part].channels.size());
    std::vector<ExrChannel> read = file.read(part, {wanted.begin(), wanted.end()});
    size_t next = 0;
    for (const size_t channel : wanted) channels[channel] = std::move(read[next++]);
    return channels;
}

}  // namespace

Sheet make_sheet(const ExrFile& file, const std::vector<Layer>& layers, const ViewOptions& options) {
    const Grid grid(file.parts(), layers, static_cast<size_t>(options.columns));
    size_t shown_pixels = 0;
    for (const Layer& layer : layers)
        shown_pixels +=
            static_cast<size_t>(file.parts()[layer.part].width) * static_cast<size_t>(file.parts()[layer.part].height);
    // libpng takes 4 GiB of bytes; a part that is large beside many small ones would make a file of nothing but
    // borders.
    const size_t most_pixels = std::min(size_t{1} << 30, (size_t{1} << 24) + 16 * shown_pixels);
    if (grid.height() > most_pixels / grid.width())
        fail_usage(fmt::format("{} layers would be a picture of {}x{} pixels: too large, or mostly borders; name fewer",
                               layers.size(), grid.width(), grid.height()));
    Sheet sheet;
    sheet.picture = {static_cast<uint32_t>(grid.width()), static_cast<uint32_t>(grid.height()), {}};
    sheet.picture.texels.assign(grid.width() * grid.height(), glm::vec3(srgb8_to_linear(48)));
    std::vector<std::string> lines(layers.size());
    std::set<size_t> parts;
    for (const Layer& layer : layers) parts.insert(layer.part);
    for (const size_t part : parts) {
        const std::vector<ExrChannel> channels = read_channels(file, part, layers);
        for (size_t i = 0; i < layers.size(); ++i) {
            if (layers[i].part != part) continue;
            std::vector<const ExrChannel*> own;
            for (const size_t channel : layers[i].channels) own.push_back(&channels[channel]);
            const ShownLayer shown = show_layer(layers[i], file.parts()[part], own, options.view, options.exposed);
            place(shown.picture, grid.x(i), grid.y(i), sheet.picture);
            const std::string at = layers.size() == 1
                                       ? ""
                                       : fmt::format("row {}, column {}: ", i / grid.columns + 1, i % grid.columns + 1);
            lines[i] = at + describe(layers[i], shown) + "\n";
        }
    }
    sheet.legend = fmt::format("{}", fmt::join(lines, ""));
    return sheet;
}

}  // namespace cistula
