// What the program that reads pictures says, to a file as it stands: a picture may have made it say anything.
#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include "mesh_checks.h"
#include "scene/image/stored_reply.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    constexpr uint64_t limit = 1'000'000;
    uint64_t left = limit, announced = 0;
    const Receive receive = [&](void* to, size_t count) {
        if (count > size) throw ReaderBroken("ended");
        if (count > 0) std::memcpy(to, data, count);
        data += count;
        size -= count;
    };
    try {
        const StoredFile file = receive_stored(receive, left, [&](uint64_t bytes) { announced += bytes; });
        fuzz::require(!file.pictures.empty() && file.pictures.front().is_whole());
        fuzz::require(left + announced == limit);
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
        fuzz::require(bytes == announced);
    } catch (const PictureRefused& refused) {
        for (const char* c = refused.what(); *c; ++c) fuzz::require(static_cast<unsigned char>(*c) >= 0x20);
    } catch (const ReaderBroken&) {
    }
    return 0;
}
