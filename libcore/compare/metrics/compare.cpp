#include "compare/metrics/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/option_text.h"
#include "base/suggest.h"
#include "compare/metrics/channel_statistics.h"
#include "compare/metrics/picture_pairs.h"
#include "image/picture/picture.h"
#include "render/record/frame_header.h"

namespace cistula {
namespace {

void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
}

/// What differences of a channel are counted in, where that needs a word.
std::string unit_text(const ChannelStatistics& channel) {
    const auto fractions = [](StoredType type) {
        return largest_code(type) > 0 ? fmt::format("{} as fractions of {}", type_name(type), largest_code(type))
                                      : fmt::format("{} as it is", type_name(type));
    };
    switch (channel.unit()) {
        case DifferenceUnit::integer:
            return fmt::format("{}: compared as integers", type_name(channel.first_type));
        case DifferenceUnit::fraction:
            return fmt::format("{} / {}: compared as numbers, {}, {}", type_name(channel.first_type),
                               type_name(channel.second_type), fractions(channel.first_type),
                               fractions(channel.second_type));
        case DifferenceUnit::value:
            break;
    }
    return "";
}

/// A comparison in work.
class Comparer {
  public:
    Comparer(const StoredFile& a, const StoredFile& b, const Selection& selection, const Thresholds& thresholds)
        : a_(a), b_(b), selection_(selection), thresholds_(thresholds), pairs_(pair_pictures(a, b)) {}

    Comparison compare(StopSignal stop) {
        check_layers();
        for (const LonePicture& lone : pairs_.unpaired) add_lone(lone);
        result_.compares_headers = a_.format == b_.format;
        if (!result_.compares_headers)
            result_.not_compared.push_back(
                fmt::format("attributes, which {} and {} do not have in common", a_.format, b_.format));
        for (const PicturePair& pair : pairs_.pairs) compare_pair(pair);
        if (selection_.common_channels && result_.channels.empty() && result_.structure.empty())
            result_.structure.push_back("no channel is in both");
        if (pairs_.is_other_order) result_.not_compared.push_back("the order of parts");
        if (!left_out_.empty())
            result_.not_compared.push_back(fmt::format("{} channel{} that `layers` leaves out: {}", left_out_.size(),
                                                       left_out_.size() == 1 ? "" : "s", fmt::join(left_out_, ", ")));
        count_pixels();
        if (selection_.flip || thresholds_.flip) result_.flip = flip_of(a_, b_, selection_, stop);
        return std::move(result_);
    }

  private:
    /// Pixels of parts with one window are one pixel, whatever the number of parts.
    using Place = std::tuple<PixelRect, int, int>;
    struct Pixels {
        Region region;
        std::vector<double> worst;
    };

    bool is_chosen(const PicturePair& pair, const StoredChannel& channel) const {
        return is_selected(selection_.layers, channel.name, name_in_part(pair.part, channel.name));
    }

    /// What only one file has: a difference where it is chosen.
    void add_alone(const std::string& line) {
        (selection_.common_channels ? result_.not_compared : result_.structure).push_back(line);
    }

    void add_lone(const LonePicture& lone) {
        const auto& channels = lone.picture.a->channels;
        if (channels.empty() || std::any_of(channels.begin(), channels.end(), [&](const StoredChannel& channel) {
                return is_chosen(lone.picture, channel);
            }))
            return add_alone(lone.line);
        for (const StoredChannel& channel : channels) left_out_.push_back(lone.picture.shown(channel.name));
    }

    /// Throws for a pattern that fits no channel of either file.
    void check_layers() const {
        std::set<std::string> names;
        std::set<std::string> fitting;  // patterns
        const auto look_at = [&](const PicturePair& pair) {
            for (const StoredPicture* picture : {pair.a, pair.b})
                for (const StoredChannel& channel : picture->channels) {
                    const std::string shown = name_in_part(pair.part, channel.name);
                    names.insert(shown);
                    for (const std::string& pattern : selection_.layers)
                        if (is_selected({pattern}, channel.name, shown)) fitting.insert(pattern);
                }
        };
        for (const PicturePair& pair : pairs_.pairs) look_at(pair);
        for (const LonePicture& lone : pairs_.unpaired) look_at(lone.picture);
        for (const std::string& pattern : selection_.layers)
            if (fitting.count(pattern) == 0)
                fail_usage(fmt::format("`layers` {}: no channel has such a name", pattern),
                           nearest_first(pattern, {names.begin(), names.end()}, "channels"));
    }

    void compare_windows(const PicturePair& pair) {
        const std::vector<std::string> lines = differing_windows(pair);
        append(selection_.excuses_windows() ? result_.not_compared : result_.structure, lines);
    }

    void compare_pair(const PicturePair& pair) {
        const std::string subject = pair.subject();
        if (!pair.a->is_whole() && selection_.has_region()) {
            result_.not_compared.push_back(subject + "a level of lower resolution, since pixels are chosen");
            return;
        }
        compare_windows(pair);
        if (result_.compares_headers) {
            append(result_.header, differing_attributes(pair));
            append(result_.not_compared, differing_packing(pair));
        }
        const Region region = region_of(*pair.a, *pair.b, selection_, subject);
        if (selection_.excuses_windows() && region.window.pixels() == 0)
            result_.structure.push_back(subject + "no pixel is in both data windows");
        else if (selection_.has_region() && region.pixels() < std::max(pair.a->data.pixels(), pair.b->data.pixels()))
            result_.not_compared.push_back(
                fmt::format("{}pixels other than {} of {}", subject, region.pixels(), format_rect(region.window)));
        compare_channels(pair, region);
    }

    void compare_channels(const PicturePair& pair, const Region& region) {
        for (const StoredChannel& channel : pair.a->channels) {
            if (!is_chosen(pair, channel)) {
                left_out_.push_back(pair.shown(channel.name));
                continue;
            }
            const StoredChannel* other = pair.b->channel(channel.name);
            if (!other) {
                add_alone(fmt::format("channel {}: only in the first", pair.shown(channel.name)));
                continue;
            }
            if (const std::string line = differing_type(pair, channel, *other); !line.empty())
                result_.header.push_back(line);
            if (region.window.pixels() > 0) add_statistics(pair, region, channel, *other);
        }
        for (const StoredChannel& channel : pair.b->channels) {
            if (pair.a->channel(channel.name)) continue;
            if (is_chosen(pair, channel))
                add_alone(fmt::format("channel {}: only in the second", pair.shown(channel.name)));
            else
                left_out_.push_back(pair.shown(channel.name));
        }
    }

    void add_statistics(const PicturePair& pair, const Region& region, const StoredChannel& a, const StoredChannel& b) {
        Pixels& pixels = pixels_[{region.window, pair.a->x_level, pair.a->y_level}];
        if (pixels.worst.empty()) pixels = {region, std::vector<double>(region.window.pixels())};
        ChannelStatistics statistics = statistics_of({a, pair.a->data}, {b, pair.b->data}, region, pixels.worst);
        statistics.name = pair.shown(a.name);
        if (selection_.ssim || thresholds_.ssim)
            statistics.ssim = ssim_of({a, pair.a->data}, {b, pair.b->data}, region);
        result_.max = std::max(result_.max, statistics.max);
        const std::string unit = unit_text(statistics);
        if (!unit.empty() && std::find(result_.units.begin(), result_.units.end(), unit) == result_.units.end())
            result_.units.push_back(unit);
        result_.channels.push_back(std::move(statistics));
    }

    void count_pixels() {
        for (const auto& [place, pixels] : pixels_) {
            result_.pixels += pixels.region.pixels();
            for (const double worst : pixels.worst) {  // 0 where a pixel does not count
                if (thresholds_.fail && worst > *thresholds_.fail) ++result_.over_fail;
                if (thresholds_.hardfail && worst > *thresholds_.hardfail) ++result_.over_hardfail;
            }
        }
    }

    const StoredFile &a_, &b_;
    const Selection& selection_;
    const Thresholds& thresholds_;
    const PicturePairs pairs_;
    Comparison result_;
    std::vector<std::string> left_out_;
    std::map<Place, Pixels> pixels_;
};

}  // namespace

size_t Comparison::values() const {
    size_t sum = 0;
    for (const ChannelStatistics& channel : channels) sum += channel.values;
    return sum;
}

size_t Comparison::differing() const {
    size_t sum = 0;
    for (const ChannelStatistics& channel : channels) sum += channel.differing;
    return sum;
}

size_t Comparison::nonfinite(NonfiniteValues ChannelStatistics::*kind) const {
    size_t sum = 0;
    for (const ChannelStatistics& channel : channels) sum += (channel.*kind).count;
    return sum;
}

bool Comparison::has_only_floats() const {
    const auto is_float = [](StoredType type) { return type == StoredType::half || type == StoredType::float_; };
    return std::all_of(channels.begin(), channels.end(), [&](const ChannelStatistics& channel) {
        return is_float(channel.first_type) && is_float(channel.second_type);
    });
}

std::optional<double> Comparison::least_ssim() const {
    std::optional<double> least;
    for (const ChannelStatistics& channel : channels)
        if (channel.ssim) least = std::min(least.value_or(*channel.ssim), *channel.ssim);
    return least;
}

bool compares_values(const StoredFile& a, const StoredFile& b, const Selection& selection) {
    const PicturePairs pairs = pair_pictures(a, b);
    return selection.excuses_windows() || std::any_of(pairs.pairs.begin(), pairs.pairs.end(),
                                                      [](const auto& pair) { return pair.a->data == pair.b->data; });
}

Comparison compare_files(const StoredFile& a, const StoredFile& b, const Thresholds& thresholds,
                         const Selection& selection, StopSignal stop) {
    return Comparer(a, b, selection, thresholds).compare(stop);
}

Comparison compare_pictures(const LayeredPicture& a, const LayeredPicture& b, const Thresholds& thresholds,
                            const Selection& selection, StopSignal stop) {
    return compare_files(stored_file(a), stored_file(b), thresholds, selection, stop);
}

bool passes(const Comparison& comparison, const Thresholds& thresholds) {
    if (!comparison.structure.empty()) return false;
    if (!thresholds.any()) return comparison.differing() == 0 && comparison.header.empty();
    if (comparison.nonfinite(&ChannelStatistics::nonfinite_other) > 0) return false;
    if (!thresholds.allow_nonfinite && comparison.nonfinite(&ChannelStatistics::nonfinite_alike) > 0) return false;
    const FlipResult* const flip = comparison.flip ? &*comparison.flip : nullptr;
    if (thresholds.flip && !(flip && flip->absent.empty() && flip->mean <= *thresholds.flip)) return false;
    if (thresholds.ssim && !(comparison.least_ssim() >= thresholds.ssim)) return false;
    return static_cast<double>(comparison.over_fail) * 100 <=
               thresholds.failpercent * static_cast<double>(comparison.pixels) &&
           comparison.over_hardfail == 0;
}

namespace {

PicturePart difference_part(const PicturePair& pair, const Selection& selection) {
    PicturePart part;
    part.name = pair.part;
    const Region region = region_of(*pair.a, *pair.b, selection, pair.subject());
    LayeredPicture& picture = part.picture;
    picture.width = region.window.width;
    picture.height = region.window.height;
    picture.x = region.window.x - pair.a->display.x;
    picture.y = region.window.y - pair.a->display.y;
    picture.display_width = pair.a->display.width;
    picture.display_height = pair.a->display.height;
    if (region.window.pixels() == 0) return part;
    for (const StoredChannel& channel : pair.a->channels) {
        if (!is_selected(selection.layers, channel.name, name_in_part(pair.part, channel.name))) continue;
        const StoredChannel* other = pair.b->channel(channel.name);
        if (!other) continue;
        picture.channels.push_back(
            {channel.name, false, differences_of({channel, pair.a->data}, {*other, pair.b->data}, region)});
    }
    return part;
}

}  // namespace

std::vector<PicturePart> difference_parts(const StoredFile& a, const StoredFile& b, const Selection& selection) {
    std::vector<PicturePart> parts;
    const PicturePairs pairs = pair_pictures(a, b);
    for (const PicturePair& pair : pairs.pairs) {
        if (!pair.a->is_whole()) continue;
        PicturePart part = difference_part(pair, selection);
        if (!part.picture.channels.empty()) parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace cistula
