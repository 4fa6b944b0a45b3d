// Pictures as they stand in their files: every part and level, each value in the type that the file gives it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/pixel_rect.h"
#include "image/picture/picture.h"

namespace cistula {

/// Type of the values of a channel. Those of `uint8` to `int32` are codes, which stand for fractions of the largest of
/// their type, as in PNG and TIFF; `uint`, of OpenEXR, is a number itself.
enum class StoredType : uint32_t { uint8, int8, uint16, int16, uint32, int32, half, float_, double_, uint };

/// What there is to know of a type.
struct StoredTypeFacts {
    std::string_view name;
    double largest_code;    // 0: its values are no codes
    uint32_t sample_bytes;  // of a value as the program that reads pictures sends it: halves as floats
    uint32_t value_bytes;   // of a value in a StoredChannel
};

inline const StoredTypeFacts& facts_of(StoredType type) {
    static constexpr StoredTypeFacts facts[] = {
        {"uint8", UINT8_MAX, 1, 4}, {"int8", INT8_MAX, 1, 4},     {"uint16", UINT16_MAX, 2, 4},
        {"int16", INT16_MAX, 2, 4}, {"uint32", UINT32_MAX, 4, 4}, {"int32", INT32_MAX, 4, 4},
        {"half", 0, 4, 4},          {"float", 0, 4, 4},           {"double", 0, 8, 8},
        {"uint", 0, 4, 4}};
    return facts[static_cast<uint32_t>(type)];
}

inline std::string_view type_name(StoredType type) {
    return facts_of(type).name;
}

inline double largest_code(StoredType type) {
    return facts_of(type).largest_code;
}

/// A channel with a value for each pixel of its picture's data window, row-major from the top left. A subsampled one
/// repeats its values.
struct StoredChannel {
    std::string name;
    StoredType type = StoredType::float_;
    // pixels of the file's pixel space for one value of the file
    int x_sampling = 1;
    int y_sampling = 1;
    std::variant<std::vector<float>, std::vector<double>, std::vector<uint32_t>, std::vector<int32_t>> values;
};

/// An attribute of a header.
struct StoredAttribute {
    std::string type;   // "string", "m44f"
    std::string value;  // the bytes in the file, or what tells them apart
    std::string text;   // for people

    bool operator==(const StoredAttribute& other) const { return type == other.type && value == other.value; }
};

/// A part of a file, at one of its levels.
struct StoredPicture {
    std::string name;              // of the part; "": none
    int x_level = 0, y_level = 0;  // of a mip map or a rip map; 0: the whole resolution
    PixelRect data, display;
    std::vector<StoredChannel> channels;
    std::map<std::string, StoredAttribute> attributes;  // but for what is said above, and for how the file is packed
    std::map<std::string, std::string> packing;         // for people: "compression": "zip"

    bool is_whole() const { return x_level == 0 && y_level == 0; }

    /// The channel of that name, or null.
    const StoredChannel* channel(const std::string& wanted) const {
        for (const StoredChannel& one : channels)
            if (one.name == wanted) return &one;
        return nullptr;
    }
};

struct StoredFile {
    std::string format;                   // "openexr", "png"
    std::vector<StoredPicture> pictures;  // parts in the order of the file; a part's levels follow each other
};

/// The file of one part that a picture in memory would be, its attributes as texts.
StoredFile stored_file(const LayeredPicture& picture);

/// The value of an attribute for people: the shortest text that reads back as the same number, so that equal texts are
/// equal values, NaN and -0 included.
std::string attribute_text(const Attributes::mapped_type& value);

/// The name of a channel or a layer among those of all parts: PART.NAME, but NAME alone where it begins with its
/// part's, or the part has none.
inline std::string name_in_part(const std::string& part, const std::string& name) {
    const bool repeats = name == part || name.rfind(part + ".", 0) == 0;
    return part.empty() || repeats ? name : part + "." + name;
}

}  // namespace cistula
