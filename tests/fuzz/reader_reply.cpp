// What the program that reads pictures says, to texels: a picture may have made it say anything.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "mesh_checks.h"
#include "scene/image/clamped_texels.h"
#include "scene/image/reader_reply.h"
#include "scene/image/texture_limits.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    constexpr uint64_t limit = 1'000'000;
    const Receive receive = [&](void* to, size_t count) {
        if (count > size) throw ReaderBroken("ended");
        std::memcpy(to, data, count);
        data += count;
        size -= count;
    };
    try {
        const ReplyStart start = receive_start(receive, limit);
        const FileEncoding encoding = file_encoding("", start.colors, start.size.sample_bytes == 4);
        const TexelDecoder decoder(encoding, start.size.sample_bytes, start.colors.is_half);
        ColorPicture picture = receive_texels(receive, start.size, decoder);
        fuzz::require(picture.texels.size() == static_cast<size_t>(picture.width) * picture.height);
        fuzz::require(picture.texels.size() * texel_bytes <= limit);
        const ClampedTexels clamped = clamp_texels(picture);
        fuzz::require(clamped.count() <= 3 * picture.texels.size());
        for (const glm::vec3& texel : picture.texels)
            for (int c = 0; c < 3; ++c) fuzz::require(std::isfinite(texel[c]) && texel[c] >= 0);
    } catch (const PictureRefused& refused) {
        for (const char* c = refused.what(); *c; ++c) fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    } catch (const ReaderBroken&) {
    } catch (const std::runtime_error& refused) {  // colors that are not known
        for (const char* c = refused.what(); *c; ++c) fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    }
    return 0;
}
