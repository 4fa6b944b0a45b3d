#include "scene/image/reader_reply.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "scene/base/suggest.h"
#include "scene/image/srgb_codes.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

[[noreturn]] void fail_broken() {
    throw ReaderBroken("its decoder gave an answer that makes no sense; the file is damaged, give another");
}

/// The head of the next part, which is of the kind `expected`; throws PictureRefused if it is the reason of a failure.
ReplyHead next_part(const Receive& receive, ReplyKind expected) {
    ReplyHead head;
    receive(&head, sizeof head);
    if (head.bytes > largest_reply_part) fail_broken();
    if (head.kind == ReplyKind::failed) {
        std::string reason(head.bytes, '\0');
        receive(reason.data(), reason.size());
        constexpr size_t longest = 1000;
        reason.resize(std::min(reason.size(), longest));
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throw PictureRefused(one_line(reason));
    }
    if (head.kind != expected) fail_broken();
    return head;
}

float linear(uint8_t code) {
    return linear_from_srgb8(code);
}
float linear(uint16_t code) {
    return linear_from_srgb16(code);
}
float linear(float value) {
    return value;
}

template <class T>
void append_texels(const std::string& bytes, uint32_t channels, std::vector<glm::vec3>& texels) {
    const auto sample = [&](size_t at) {
        T value;
        std::memcpy(&value, bytes.data() + at * sizeof value, sizeof value);
        return linear(value);
    };
    for (size_t at = 0; at < bytes.size() / sizeof(T); at += channels)
        texels.push_back(channels == 1 ? glm::vec3(sample(at)) : glm::vec3(sample(at), sample(at + 1), sample(at + 2)));
}

}  // namespace

ReplySize receive_size(const Receive& receive, uint64_t left) {
    ReplySize size;
    if (next_part(receive, ReplyKind::size).bytes != sizeof size) fail_broken();
    receive(&size, sizeof size);
    const bool known_samples = size.sample_bytes == 1 || size.sample_bytes == 2 || size.sample_bytes == 4;
    if (!known_samples || (size.channels != 1 && size.channels != 3) ||
        !texture_size_problem(size.width, size.height, left, left).empty())
        fail_broken();
    return size;
}

ColorPicture receive_texels(const Receive& receive, const ReplySize& size) {
    ColorPicture picture;
    picture.width = size.width;
    picture.height = size.height;
    const size_t count = static_cast<size_t>(size.width) * size.height;
    picture.texels.reserve(count);
    const size_t texel_size = static_cast<size_t>(size.channels) * size.sample_bytes;
    std::string bytes;
    while (picture.texels.size() < count) {
        bytes.resize(next_part(receive, ReplyKind::samples).bytes);
        if (bytes.empty() || bytes.size() % texel_size != 0 ||
            bytes.size() / texel_size > count - picture.texels.size())
            fail_broken();
        receive(bytes.data(), bytes.size());
        if (size.sample_bytes == 1)
            append_texels<uint8_t>(bytes, size.channels, picture.texels);
        else if (size.sample_bytes == 2)
            append_texels<uint16_t>(bytes, size.channels, picture.texels);
        else
            append_texels<float>(bytes, size.channels, picture.texels);
    }
    return picture;
}

}  // namespace cistula
