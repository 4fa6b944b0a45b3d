#include "scene/image/reader_reply.h"

#include <algorithm>
#include <array>
#include <string>

#include "scene/base/suggest.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

FileColors receive_colors(const Receive& receive, uint32_t bytes) {
    ReplyColors reply;
    if (bytes < sizeof reply || bytes - sizeof reply > largest_reply_id) fail_broken();
    receive(&reply, sizeof reply);
    FileColors colors;
    std::string& text = reply.names_profile != 0 ? colors.profile : colors.id;
    text.resize(bytes - sizeof reply);
    receive(text.data(), text.size());
    if (reply.has_chromaticities != 0) colors.chromaticities = std::to_array(reply.chromaticities);
    colors.is_aces = reply.is_aces != 0;
    colors.is_half = reply.is_half != 0;
    return colors;
}

}  // namespace

void fail_broken() {
    throw ReaderBroken("its decoder gave an answer that makes no sense; the file is damaged, give another");
}

ReplyHead next_part(const Receive& receive) {
    ReplyHead head;
    receive(&head, sizeof head);
    if (head.bytes > largest_reply_part) fail_broken();
    if (head.kind != ReplyKind::failed) return head;
    std::string reason(head.bytes, '\0');
    receive(reason.data(), reason.size());
    constexpr size_t longest = 1000;
    reason.resize(std::min(reason.size(), longest));
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw PictureRefused(one_line(reason));
}

ReplyStart receive_start(const Receive& receive, uint64_t left) {
    ReplyStart start;
    ReplyHead head = next_part(receive);
    if (head.kind == ReplyKind::colors) {
        start.colors = receive_colors(receive, head.bytes);
        head = next_part(receive);
    }
    ReplySize& size = start.size;
    if (head.kind != ReplyKind::size || head.bytes != sizeof size) fail_broken();
    receive(&size, sizeof size);
    const bool known_samples = size.sample_bytes == 1 || size.sample_bytes == 2 || size.sample_bytes == 4;
    if (!known_samples || (size.channels != 1 && size.channels != 3) ||
        !texture_size_problem(size.width, size.height, left, left).empty())
        fail_broken();
    return start;
}

ColorPicture receive_texels(const Receive& receive, const ReplySize& size, const TexelDecoder& decoder) {
    ColorPicture picture;
    picture.width = size.width;
    picture.height = size.height;
    const size_t count = static_cast<size_t>(size.width) * size.height;
    picture.texels.reserve(count);
    const size_t texel_size = static_cast<size_t>(size.channels) * size.sample_bytes;
    std::string bytes;
    while (picture.texels.size() < count) {
        const ReplyHead head = next_part(receive);
        if (head.kind != ReplyKind::samples) fail_broken();
        bytes.resize(head.bytes);
        if (bytes.empty() || bytes.size() % texel_size != 0 ||
            bytes.size() / texel_size > count - picture.texels.size())
            fail_broken();
        receive(bytes.data(), bytes.size());
        decoder.append(bytes, size.channels, picture.texels);
    }
    return picture;
}

}  // namespace cistula
