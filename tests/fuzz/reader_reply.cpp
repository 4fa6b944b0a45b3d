// What the program that reads pictures says, to texels and to a file as it stands: a picture may have made it say
// anything.
#include "image/reader/reader_reply.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include "image/color/clamped_texels.h"
#include "image/reader/texture_limits.h"
#include "mesh_checks.h"
#include "target.h"

namespace {

using namespace cistula;

constexpr uint64_t limit = 1'000'000;

/// Calls `take` with the bytes as an answer; `left` is what remains of the limit.
template <class Take>
void answer(const uint8_t* data, size_t size, bool is_texture, Take take) {
    uint64_t left = limit;
    const Receive receive = [&](void* to, size_t count) {
        if (count > size) throw ReaderBroken("ended");
        if (count > 0) std::memcpy(to, data, count);
        data += count;
        size -= count;
    };
    ReaderReply reply(receive, is_texture, left);
    try {
        take(reply, left);
    } catch (const ReaderBroken&) {
    } catch (const std::runtime_error& refused) {  // the reason, or colors that are not known
        for (const char* c = refused.what(); *c; ++c) fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    }
}

void check_texture(ReaderReply& reply, const uint64_t& left) {
    ColorPicture picture = receive_texture(reply, "");
    fuzz::require(picture.texels.size() == static_cast<size_t>(picture.width) * picture.height);
    fuzz::require(picture.texels.size() * texel_bytes + left == limit);
    const ClampedTexels clamped = clamp_texels(picture);
    fuzz::require(clamped.count() <= 3 * picture.texels.size());
    for (const glm::vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c) fuzz::require(std::isfinite(texel[c]) && texel[c] >= 0);
}

void check_stored(ReaderReply& reply, const uint64_t& left) {
    const StoredFile file = receive_stored(reply);
    fuzz::require(!file.pictures.empty() && file.pictures.front().is_whole());
    uint64_t bytes = 0;
    for (const StoredPicture& picture : file.pictures) {
        std::set<std::string> names;
        for (const StoredChannel& channel : picture.channels) {
            fuzz::require(names.insert(channel.name).second);
            std::visit(
                [&](const auto& values) {
                    fuzz::require(values.size() == picture.data.pixels());
                    bytes += values.size() * sizeof(values[0]);
                },
                channel.values);
        }
    }
    fuzz::require(bytes + left == limit);
}

}  // namespace

FUZZ_TARGET(reader_reply) {
    answer(data, size, true, check_texture);
    answer(data, size, false, check_stored);
    return 0;
}
