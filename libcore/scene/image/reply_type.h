// Types of the values of stored pictures, as the module that uses OpenImageIO and the program that reads pictures say
// them.
#pragma once

#include <cstdint>

namespace cistula {

/// Type of the values of a stored picture.
enum class ReplyType : uint32_t { uint8, int8, uint16, int16, uint32, int32, half, float_, double_ };

/// Bytes of a value as it is sent.
inline uint32_t sample_bytes(ReplyType type) {
    switch (type) {
        case ReplyType::uint8:
        case ReplyType::int8:
            return 1;
        case ReplyType::uint16:
        case ReplyType::int16:
            return 2;
        case ReplyType::double_:
            return 8;
        default:
            return 4;
    }
}

/// Bytes of a value in a StoredChannel.
inline uint32_t value_bytes(ReplyType type) {
    return type == ReplyType::double_ ? 8 : 4;
}

inline constexpr uint32_t most_stored_channels = 4096;

}  // namespace cistula
