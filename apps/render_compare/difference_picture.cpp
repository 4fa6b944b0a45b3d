#include "difference_picture.h"

#include <utility>

#include "apps/common/part_name.h"
#include "channel_statistics.h"
#include "picture_pairs.h"
#include "stored_layers.h"

namespace cistula {
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

LayeredPicture difference_picture(const LayeredPicture& a, const LayeredPicture& b) {
    std::vector<PicturePart> parts = difference_parts(stored_layers(a), stored_layers(b));
    return parts.empty() ? LayeredPicture() : std::move(parts.front().picture);
}

}  // namespace cistula
