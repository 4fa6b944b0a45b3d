#include "scene/image/stored_picture.h"

#include <algorithm>

namespace cistula {

const StoredChannel* StoredPicture::channel(const std::string& wanted) const {
    const auto found =
        std::find_if(channels.begin(), channels.end(), [&](const StoredChannel& one) { return one.name == wanted; });
    return found == channels.end() ? nullptr : &*found;
}

std::string_view type_name(StoredType type) {
    switch (type) {
        case StoredType::half:
            return "half";
        case StoredType::float_:
            return "float";
        case StoredType::double_:
            return "double";
        case StoredType::uint:
            return "uint";
        case StoredType::uint8:
            return "uint8";
        case StoredType::uint16:
            return "uint16";
        case StoredType::uint32:
            return "uint32";
        case StoredType::int8:
            return "int8";
        case StoredType::int16:
            return "int16";
        case StoredType::int32:
            break;
    }
    return "int32";
}

double largest_code(StoredType type) {
    switch (type) {
        case StoredType::uint8:
            return UINT8_MAX;
        case StoredType::uint16:
            return UINT16_MAX;
        case StoredType::uint32:
            return UINT32_MAX;
        case StoredType::int8:
            return INT8_MAX;
        case StoredType::int16:
            return INT16_MAX;
        case StoredType::int32:
            return INT32_MAX;
        default:
            return 0;
    }
}

}  // namespace cistula
