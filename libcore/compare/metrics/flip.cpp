#include "compare/metrics/flip.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "compare/metrics/command.h"
#include "compare/metrics/picture_pairs.h"
#include "image/color/srgb_codes.h"
#include "image/exr/exr.h"
#include "image/picture/picture_io.h"

namespace cistula {
namespace {

constexpr const char* not_installed = "NVIDIA's program flip is not on PATH; pip install flip-evaluator installs it";

/// Why there is no FLIP.
struct FlipAbsent : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Runs flip of PATH and returns what it prints.
std::string run_flip(std::vector<std::string> arguments, const TemporaryFolder& folder, StopSignal stop) {
    arguments.insert(arguments.begin(), "flip");
    const std::optional<CommandEnd> end = run_command(std::move(arguments), ".", folder, stop);
    if (!end || end->code == 127 || end->code < 0) throw FlipAbsent(not_installed);
    return end->said;
}

/// "v1.7". Other programs have the name, too: one of Debian converts line ends.
std::string flip_version(const TemporaryFolder& folder, StopSignal stop) {
    const std::string help = run_flip({"--help"}, folder, stop);
    const std::string before = "FLIP v";
    const size_t start = help.find(before);
    if (start == help.npos || help.find("--reference") == help.npos) throw FlipAbsent(not_installed);
    const size_t number = start + before.size() - 1;
    const size_t end = help.find_first_not_of("v0123456789.", number);
    std::string version = help.substr(number, end - number);
    while (!version.empty() && version.back() == '.') version.pop_back();
    return version;
}

/// The number after a name in what flip prints: "     Mean: 0.000038".
double number_after(const std::string& text, const std::string& name) {
    const size_t place = text.find(" " + name + ": ");
    char* end = nullptr;
    const char* const number = place == text.npos ? "" : text.c_str() + place + name.size() + 3;
    const double value = std::strtod(number, &end);
    if (end == number)
        throw FlipAbsent(fmt::format("flip says no {}, but: {}", name, text.empty() ? "nothing" : text.substr(0, 300)));
    return value;
}

/// R, G and B of a picture.
using Colors = std::array<const StoredChannel*, 3>;

std::optional<Colors> colors_of(const StoredPicture& picture) {
    const Colors colors = {picture.channel("R"), picture.channel("G"), picture.channel("B")};
    if (!colors[0] || !colors[1] || !colors[2]) return std::nullopt;
    return colors;
}

bool has_only(const Colors& colors, StoredType type) {
    return colors[0]->type == type && colors[1]->type == type && colors[2]->type == type;
}

bool has_only_floats(const Colors& colors) {
    for (const StoredChannel* channel : colors)
        if (!std::holds_alternative<std::vector<float>>(channel->values)) return false;
    return true;
}

/// Calls `visit(i, index)` for the pixels of the window: their number and their place in the picture's values.
template <class Visit>
void for_each_pixel(const StoredPicture& picture, const PixelRect& window, Visit visit) {
    size_t i = 0;
    for (int y = window.y; y - window.y < window.height; ++y)
        for (int x = window.x; x - window.x < window.width; ++x, ++i) visit(i, picture.data.index(x, y));
}

void write_floats(const std::string& path, const StoredPicture& picture, const Colors& colors,
                  const PixelRect& window) {
    LayeredPicture written;
    written.width = written.display_width = window.width;
    written.height = written.display_height = window.height;
    for (const StoredChannel* channel : colors) {
        const auto& values = std::get<std::vector<float>>(channel->values);
        std::vector<float> chosen(window.pixels());
        for_each_pixel(picture, window, [&](size_t i, size_t index) {
            if (!std::isfinite(values[index])) throw FlipAbsent("the colors are not all finite");
            chosen[i] = values[index];
        });
        written.channels.push_back({channel->name, false, std::move(chosen)});
    }
    write_exr(path, written);
}

void write_codes(const std::string& path, const StoredPicture& picture, const Colors& colors, const PixelRect& window) {
    ColorPicture written{static_cast<uint32_t>(window.width), static_cast<uint32_t>(window.height), {}};
    written.texels.resize(window.pixels());
    for_each_pixel(picture, window, [&](size_t i, size_t index) {
        for (int c = 0; c < 3; ++c) {
            const auto& codes = std::get<std::vector<uint32_t>>(colors[static_cast<size_t>(c)]->values);
            written.texels[i][c] = srgb8_to_linear(static_cast<uint8_t>(codes[index]));
        }
    });
    write_file_atomically(path, encode_png(written));
}

FlipResult measure(const StoredFile& a, const StoredFile& b, const Selection& selection, StopSignal stop) {
    if (selection.mask) throw FlipAbsent("it looks at neighbors, and a mask leaves some out");
    const PicturePairs pairs = pair_pictures(a, b);
    for (const PicturePair& pair : pairs.pairs) {
        const std::optional<Colors> first = colors_of(*pair.a);
        const std::optional<Colors> second = colors_of(*pair.b);
        if (!pair.a->is_whole() || !first || !second) continue;
        const PixelRect window = region_of(*pair.a, *pair.b, selection, pair.subject()).window;
        if (window.pixels() == 0) throw FlipAbsent("no pixel has a partner");
        const bool codes = has_only(*first, StoredType::uint8) && has_only(*second, StoredType::uint8);
        if (!codes && (!has_only_floats(*first) || !has_only_floats(*second)))
            throw FlipAbsent("R, G and B must be half or float in both images, or 8 bits in both");
        const TemporaryFolder folder;
        FlipResult result;
        result.kind = codes ? "LDR-FLIP" : "HDR-FLIP";
        result.version = flip_version(folder, stop);
        const auto write = codes ? write_codes : write_floats;
        const std::string end = codes ? ".png" : ".exr";
        write(folder.file("reference" + end), *pair.a, *first, window);
        write(folder.file("test" + end), *pair.b, *second, window);
        const std::string said =
            run_flip({"--reference", folder.file("reference" + end), "--test", folder.file("test" + end),
                      "--no-exposure-map", "--no-error-map", "--directory", folder.file("")},
                     folder, stop);
        result.mean = number_after(said, "Mean");
        result.median = number_after(said, "Weighted median");
        result.min = number_after(said, "Min");
        result.max = number_after(said, "Max");
        return result;
    }
    throw FlipAbsent("no part has R, G and B in both images");
}

}  // namespace

FlipResult flip_of(const StoredFile& a, const StoredFile& b, const Selection& selection, StopSignal stop) {
    try {
        return measure(a, b, selection, stop);
    } catch (const FlipAbsent& absent) {
        FlipResult result;
        result.absent = absent.what();
        return result;
    }
}

}  // namespace cistula
