#include "sequence/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "image/exr/exr.h"
#include "image/picture/stored_picture.h"
#include "render/picture_size.h"
#include "render/record/frame_header.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& problem, const char* remedy = "") {
    throw Error(ErrorKind::failed, problem, remedy).at(path);
}

PixelRect rect_of(const LayeredPicture& picture) {
    return {picture.x, picture.y, picture.width, picture.height};
}

std::string text_of(const Attributes::mapped_type& value) {
    const std::string text = attribute_text(value);
    return std::holds_alternative<std::string>(value) ? quoted(std::string_view(text)) : text;
}

/// What two headers differ in; empty if nothing.
std::string difference(const Attributes& own, const Attributes& first, const std::string& first_path) {
    const auto text = [](const Attributes& of, const std::string& name) {
        const auto found = of.find(name);
        return found == of.end() ? std::string("missing") : text_of(found->second);
    };
    // The version first: it explains what else differs.
    std::vector<std::string> names = {"cistula:version", "cistula:sceneHash"};
    for (const Attributes* attributes : {&own, &first})
        for (const auto& [name, value] : *attributes) names.push_back(name);
    for (const std::string& name : names) {
        const auto a = own.find(name);
        const auto b = first.find(name);
        if ((a == own.end()) == (b == first.end()) && (a == own.end() || a->second == b->second)) continue;
        return fmt::format("{} is {}, and {} in {}: they are of different renders; render it again as the others", name,
                           text(own, name), text(first, name), first_path);
    }
    return "";
}

/// The attributes that the files of a frame's layers have in common (split_picture.h).
Attributes common_attributes(const Attributes& attributes) {
    Attributes common = without_target_attributes(attributes);
    std::erase_if(common, [](const auto& entry) {
        return entry.first == "colorInteropID" || entry.first == "chromaticities" || entry.first == "name" ||
               entry.first.starts_with("cryptomatte/");
    });
    return common;
}

std::string channels_of(const LayeredPicture& picture) {
    std::string names;
    for (const LayeredPicture::Channel& channel : picture.channels)
        names += fmt::format("{}{}{}", names.empty() ? "" : " ", channel.name, channel.half ? " (half)" : "");
    return names;
}

/// Copies a tile's pixels to their place in the whole.
void place(const LayeredPicture& tile, LayeredPicture& whole) {
    const auto width = static_cast<size_t>(tile.width);
    for (size_t c = 0; c < tile.channels.size(); ++c)
        for (int y = 0; y < tile.height; ++y) {
            const float* from = tile.channels[c].values.data() + static_cast<size_t>(y) * width;
            const size_t row = static_cast<size_t>(tile.y + y - whole.y) * static_cast<size_t>(whole.width);
            std::copy_n(from, width, whole.channels[c].values.data() + row + static_cast<size_t>(tile.x - whole.x));
        }
}

}  // namespace

void Merge::begin(const std::string& path, const std::vector<PicturePart>& tile) {
    const LayeredPicture& first = tile.front().picture;
    if (first.attributes.count("cistula:sceneHash") == 0)
        fail(path, "is no tile that render wrote: its header has no cistula:sceneHash");
    if (is_dwa(first.compression))
        fail(path, "its compression loses something, and not what that of the whole frame does",
             "render tiles with another");
    const PixelRect frame{0, 0, first.display_width, first.display_height};
    if (!window_) window_ = frame;
    if (!contains(frame, *window_))
        throw Error(ErrorKind::usage, fmt::format("`crop` {}: leaves the frame, which is {}x{}", format_rect(*window_),
                                                  frame.width, frame.height));
    parts_ = tile;
    for (PicturePart& part : parts_) {
        LayeredPicture& picture = part.picture;
        picture.x = window_->x;
        picture.y = window_->y;
        picture.width = window_->width;
        picture.height = window_->height;
    }
}

void Merge::check_window(const std::string& path, const PixelRect& rect) const {
    if (!contains(*window_, rect))
        fail(path,
             fmt::format("its pixels, {}, leave those to be covered, {}", format_rect(rect), format_rect(*window_)));
    for (const Placed& other : placed_)
        if (const PixelRect shared = intersection(rect, other.rect); !shared.is_empty())
            fail(path, fmt::format("its pixels {} are also in {}", format_rect(shared), other.path), "leave one out");
}

void Merge::check(const std::string& path, const std::vector<PicturePart>& tile) const {
    const std::string& first = placed_.front().path;
    if (tile.size() != parts_.size())
        fail(path, fmt::format("has {} parts, and {} has {}: they are of different renders", tile.size(), first,
                               parts_.size()));
    for (size_t i = 0; i < tile.size(); ++i) {
        const LayeredPicture &own = tile[i].picture, &whole = parts_[i].picture;
        if (tile[i].name != parts_[i].name)
            fail(path,
                 fmt::format("its part {} is {}, and {} in {}: they are of different renders", i + 1,
                             quoted(std::string_view(tile[i].name)), quoted(std::string_view(parts_[i].name)), first));
        if (own.display_width != whole.display_width || own.display_height != whole.display_height)
            fail(path, fmt::format("its frame is {}x{}, and {}x{} in {}", own.display_width, own.display_height,
                                   whole.display_width, whole.display_height, first));
        const std::string differs =
            difference(without_target_attributes(own.attributes), without_target_attributes(whole.attributes), first);
        if (!differs.empty()) fail(path, differs);
        if (channels_of(own) != channels_of(whole))
            fail(path, fmt::format("its channels are {}, and {} in {}", channels_of(own), channels_of(whole), first));
        if (own.compression != whole.compression)
            fail(path, fmt::format("is compressed otherwise than {}", first), "render it again as the others");
    }
}

void Merge::add(const std::string& path) {
    const std::vector<PicturePart> tile = read_exr_headers(path);
    for (const PicturePart& part : tile)
        if (part.picture.attributes.count(snapshot_attribute) != 0)
            fail(path, "is a snapshot of a frame in work, and no tile");
    if (parts_.empty())
        begin(path, tile);
    else
        check(path, tile);
    const PixelRect rect = rect_of(tile.front().picture);
    for (const PicturePart& part : tile)
        if (rect_of(part.picture) != rect) fail(path, "its parts have different windows; render writes none such");
    check_window(path, rect);
    for (size_t i = 0; i < tile.size() && !placed_.empty(); ++i)
        join_target_attributes(tile[i].picture.attributes, parts_[i].picture.attributes);
    placed_.push_back({path, rect});
}

void Merge::check_beside(const Merge& main) const {
    const std::string& path = placed_.front().path;
    const std::string differs =
        difference(common_attributes(parts_.front().picture.attributes),
                   common_attributes(main.parts_.front().picture.attributes), main.placed_.front().path);
    if (!differs.empty()) fail(path, differs + ", or remove it");
    for (const Placed& own : placed_)
        if (std::none_of(main.placed_.begin(), main.placed_.end(),
                         [&](const Placed& other) { return other.rect == own.rect; }))
            fail(own.path, fmt::format("its pixels, {}, are those of no tile of the frame", format_rect(own.rect)));
}

std::vector<PicturePart> Merge::whole() && {
    for (PicturePart& part : parts_)
        for (LayeredPicture::Channel& channel : part.picture.channels)
            channel.values.assign(static_cast<size_t>(part.picture.width) * static_cast<size_t>(part.picture.height),
                                  0);
    for (const Placed& placed : placed_) {
        const std::vector<PicturePart> tile = read_exr_parts(placed.path);
        check(placed.path, tile);  // it may be another file by now
        for (size_t i = 0; i < tile.size(); ++i) {
            if (rect_of(tile[i].picture) != placed.rect) fail(placed.path, "was replaced meanwhile; merge again");
            place(tile[i].picture, parts_[i].picture);
        }
    }
    return std::move(parts_);
}

bool is_layer_file(const std::string& path, const std::string& layer) {
    try {
        const std::vector<PicturePart> parts = read_exr_headers(path);
        return std::all_of(parts.begin(), parts.end(), [&](const PicturePart& part) {
            const auto& channels = part.picture.channels;
            return std::all_of(channels.begin(), channels.end(), [&](const LayeredPicture::Channel& channel) {
                const std::string& name = channel.name;
                return name == "R" || name == "G" || name == "B" ||
                       (name.starts_with(layer) &&
                        name.find_first_not_of("0123456789", layer.size()) == name.rfind('.'));
            });
        });
    } catch (const Error&) {
        return false;
    }
}

void Merge::check_whole() const {
    std::vector<PixelRect> rects;
    for (const Placed& placed : placed_) rects.push_back(placed.rect);
    std::vector<PixelRect> gaps = uncovered(*window_, rects);
    std::sort(gaps.begin(), gaps.end(),
              [](const PixelRect& a, const PixelRect& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    if (!gaps.empty()) {
        int64_t pixels = 0;
        for (const PixelRect& gap : gaps) pixels += int64_t{gap.width} * gap.height;
        constexpr size_t most = 4;
        std::vector<std::string> texts;
        for (size_t i = 0; i < std::min(gaps.size(), most); ++i) texts.push_back(format_rect(gaps[i]));
        throw Error(
            ErrorKind::failed,
            fmt::format("{} of {} pixels are in no tile: {}{}", pixels, int64_t{window_->width} * window_->height,
                        fmt::join(texts, ", "), gaps.size() > most ? " and others" : ""),
            "`crop` names the pixels of a smaller whole");
    }
}

namespace {

/// Adds what of `rect` lies outside of `hole`, which is inside of it: above, below, left and right.
void add_around(const PixelRect& rect, const PixelRect& hole, std::vector<PixelRect>& to) {
    const auto add = [&](int x, int y, int width, int height) {
        if (width > 0 && height > 0) to.push_back({x, y, width, height});
    };
    const int right = hole.x + hole.width;
    const int below = hole.y + hole.height;
    add(rect.x, rect.y, rect.width, hole.y - rect.y);
    add(rect.x, below, rect.width, rect.y + rect.height - below);
    add(rect.x, hole.y, hole.x - rect.x, hole.height);
    add(right, hole.y, rect.x + rect.width - right, hole.height);
}

}  // namespace

std::vector<PixelRect> uncovered(const PixelRect& window, const std::vector<PixelRect>& rects) {
    std::vector<PixelRect> left = {window};
    for (const PixelRect& rect : rects) {
        std::vector<PixelRect> next;
        for (const PixelRect& part : left) {
            if (const PixelRect shared = intersection(part, rect); !shared.is_empty())
                add_around(part, shared, next);
            else
                next.push_back(part);
        }
        left = std::move(next);
    }
    return left;
}

}  // namespace cistula
