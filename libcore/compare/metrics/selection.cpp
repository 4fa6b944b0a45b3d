#include "compare/metrics/selection.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <numeric>

#include "base/option_text.h"

namespace cistula {
namespace {

bool fits(const std::string& pattern, const std::string& name) {
    if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) return true;
    const size_t dot = name.rfind('.');
    return dot != name.npos && fnmatch(pattern.c_str(), name.substr(0, dot).c_str(), 0) == 0;
}

void add_mask(Region& region, const Mask& mask, const std::string& subject) {
    if (!contains(mask.window, region.window))
        fail_usage(fmt::format("{}`mask`: has the pixels {}, and {} are compared", subject, format_rect(mask.window),
                               format_rect(region.window)),
                   "give a mask with all of them");
    region.counts.reserve(region.window.pixels());
    const PixelRect& window = region.window;
    for (int y = window.y; y - window.y < window.height; ++y) {
        const auto row = mask.counts.begin() + static_cast<std::ptrdiff_t>(y - mask.window.y) * mask.window.width +
                         (window.x - mask.window.x);
        region.counts.insert(region.counts.end(), row, row + window.width);
    }
    if (region.pixels() == 0)
        fail_usage(fmt::format("{}`mask`: counts none of the pixels {}", subject, format_rect(window)),
                   "those count where it is above 0");
}

}  // namespace

size_t Region::pixels() const {
    return counts.empty() ? window.pixels() : std::accumulate(counts.begin(), counts.end(), size_t{0});
}

bool is_selected(const std::vector<std::string>& patterns, const std::string& name, const std::string& shown) {
    return patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
               return fits(pattern, name) || fits(pattern, shown);
           });
}

Mask mask_of(const StoredPicture& picture) {
    Mask mask{picture.data, std::vector<uint8_t>(picture.data.pixels())};
    for (const StoredChannel& channel : picture.channels) {
        if (channel.name == "A" && picture.channels.size() > 1) continue;
        std::visit(
            [&](const auto& values) {
                for (size_t i = 0; i < values.size(); ++i)
                    if (values[i] > 0) mask.counts[i] = 1;
            },
            channel.values);
    }
    return mask;
}

Region region_of(const StoredPicture& a, const StoredPicture& b, const Selection& selection,
                 const std::string& subject) {
    Region region{a.data, {}};
    if (selection.intersection) region.window = intersection(a.data, b.data);
    if (selection.crop) {
        const PixelRect& crop = *selection.crop;
        if (!selection.intersection)
            for (const auto& [which, data] : {std::pair("first", a.data), std::pair("second", b.data)})
                if (!contains(data, crop))
                    fail_usage(fmt::format("{}`crop` {}: leaves the data window of the {} image, {}", subject,
                                           format_rect(crop), which, format_rect(data)));
        region.window = selection.intersection ? intersection(region.window, crop) : crop;
    }
    if (!selection.excuses_windows() && a.data != b.data) return {};
    if (selection.mask && region.window.pixels() > 0) add_mask(region, *selection.mask, subject);
    return region;
}

}  // namespace cistula
