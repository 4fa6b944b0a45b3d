#include "scene/image/oiio_input.h"

#include <algorithm>
#include <climits>
#include <string_view>
#include <vector>

#include "scene/base/file_bytes.h"

namespace cistula {

OIIO::ImageSpec as_stored() {
    OIIO::ImageSpec settings;
    settings["oiio:UnassociatedAlpha"] = 1;
    return settings;
}

void limit_library(uint64_t texels) {
    constexpr uint64_t most_stored_bytes = 32;  // of a texel: four doubles
    const uint64_t megabytes = texels * most_stored_bytes / (1 << 20) + 1;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::min<uint64_t>(megabytes, INT_MAX)));
    OIIO::attribute("limits:resolution", static_cast<int>(largest_picture_side));
    OIIO::attribute("threads", 1);
}

std::string read_rows(OIIO::ImageInput& input, int subimage, int level, int channels, OIIO::TypeDesc format,
                      const std::function<void(const void*, size_t)>& take) {
    const OIIO::ImageSpec spec = input.spec();
    const size_t texel = static_cast<size_t>(channels) * format.size(), row = texel * static_cast<size_t>(spec.width);
    constexpr size_t piece = 16 << 20;
    const int step = spec.tile_width > 0 ? spec.tile_height : static_cast<int>(std::clamp<size_t>(piece / row, 1, 256));
    if (step < 1) return "its tiles have no height";
    std::vector<char> samples(row * static_cast<size_t>(std::min(step, spec.height)));
    for (int y = 0; y < spec.height; y += std::min(step, spec.height - y)) {
        const int first = spec.y + y, end = first + std::min(step, spec.height - y);
        const bool done =
            spec.tile_width > 0
                ? input.read_tiles(subimage, level, spec.x, spec.x + spec.width, first, end, spec.z, spec.z + 1, 0,
                                   channels, format, samples.data())
                : input.read_scanlines(subimage, level, first, end, spec.z, 0, channels, format, samples.data());
        if (!done || input.has_error()) return reason_or_none(input.geterror());  // some formats fail after true
        take(samples.data(), static_cast<size_t>(end - first) * static_cast<size_t>(spec.width));
    }
    return "";
}

bool is_multiplied(OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    if (std::string_view(input.format_name()) != "webp" || spec.alpha_channel < 0) return false;
    if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) return false;
    std::vector<uint8_t> row(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels));
    for (int y = 0; y < spec.height; ++y) {
        if (!input.read_scanline(y, 0, OIIO::TypeDesc::UINT8, row.data()))
            return false;  // which is said when it is read
        for (auto at = static_cast<size_t>(spec.alpha_channel); at < row.size();
             at += static_cast<size_t>(spec.nchannels))
            if (row[at] != 255) return true;
    }
    return false;
}

}  // namespace cistula
