// Pictures as they stand in their files: every part and level, each value in the type that the file gives it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/base/pixel_rect.h"

namespace cistula {

/// Type of the values of a channel. Those of `uint8` to `int32` are codes, which stand for fractions of the largest of
/// their type, as in PNG and TIFF; `uint`, of OpenEXR, is a number itself.
enum class StoredType { half, float_, double_, uint, uint8, uint16, uint32, int8, int16, int32 };

std::string_view type_name(StoredType type);

/// The largest code of a type; 0 where its values are no codes.
double largest_code(StoredType type);

/// A channel with a value for each pixel of its picture's data window, row-major from the top left. A subsampled one
/// repeats its values.
struct StoredChannel {
    std::string name;
    StoredType type = StoredType::float_;
    int x_sampling = 1, y_sampling = 1;  // pixels of the file's pixel space for one value of the file
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
    const StoredChannel* channel(const std::string& wanted) const;
};

struct StoredFile {
    std::string format;                   // "openexr", "png"
    std::vector<StoredPicture> pictures;  // parts in the order of the file; a part's levels follow each other
};

/// The name of a channel or a layer among those of all parts: PART.NAME, but NAME alone where it begins with its
/// part's, or the part has none.
inline std::string name_in_part(const std::string& part, const std::string& name) {
    const bool repeats = name == part || name.rfind(part + ".", 0) == 0;
    return part.empty() || repeats ? name : part + "." + name;
}

}  // namespace cistula
