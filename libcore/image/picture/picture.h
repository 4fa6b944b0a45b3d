// Pictures in memory, as the readers and writers of files exchange them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace cistula {

/// A picture in linear RGB, Rec. 709 unless something else is said, row-major from the top left; textures are read into
/// it.
struct ColorPicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<glm::vec3> texels;
    std::vector<float> alpha = {};                 // of texels that are not premultiplied; empty: all are opaque
    std::array<double, 3> divided_by = {1, 1, 1};  // factors that its file's header said its numbers had
};

/// A fraction, as EXR headers give frame rates.
struct Ratio {
    int numerator = 0;
    unsigned denominator = 1;
    bool operator==(const Ratio&) const = default;
};

/// How the pixels of an EXR file are compressed; dwaa and dwab lose some. `other`: as in files of other programs; never
/// written.
enum class Compression { none, rle, zips, zip, piz, dwaa, dwab, other };
/// The names of those that are written, in their order.
inline constexpr std::string_view compression_names[] = {"none", "rle", "zips", "zip", "piz", "dwaa", "dwab"};
/// Whether a compression is one of those that lose something.
constexpr bool is_dwa(Compression compression) {
    return compression == Compression::dwaa || compression == Compression::dwab;
}

/// The contents of an EXR file: named channels of width x height floats each, row-major from the top left, in memory or
/// made as they are written.
struct LayeredPicture {
    // of the data window
    int width = 0;
    int height = 0;
    // top left corner in the display window
    int x = 0;
    int y = 0;
    int display_width = 0;
    int display_height = 0;
    struct Channel {
        std::string name;   // "R", "error.R", "Z", "N.X", ...
        bool half = false;  // stored as half; id, Z, samples, cost are always float
        std::vector<float> values;
        /// Writes the values [first, last) to `to`, in any thread, where `values` is empty.
        std::function<void(size_t first, size_t last, float* to)> write = {};

        /// Puts the values [first, last) there, whether they are in memory or made now.
        void put(size_t first, size_t last, float* to) const {
            if (write)
                write(first, last, to);
            else
                std::copy_n(values.data() + first, last - first, to);
        }
    };
    std::vector<Channel> channels;
    Compression compression = Compression::zip;
    float dwa_level = 45;  // for dwaa and dwab: 0 loses nothing but for half's rounding, more is smaller
    /// Header attributes, written in the order of their names. 16 floats become an M44f (row-vector convention of
    /// OpenEXR). screenWindowWidth, a double here, is a float in the file; without it that is 1.
    std::map<std::string, std::variant<std::string, int, double, std::vector<float>, Ratio>> attributes;
};

using Attributes = decltype(LayeredPicture::attributes);

/// The channel of that name, or null.
inline const LayeredPicture::Channel* channel_of(const LayeredPicture& picture, const std::string& name) {
    const auto found = std::find_if(picture.channels.begin(), picture.channels.end(),
                                    [&](const LayeredPicture::Channel& channel) { return channel.name == name; });
    return found == picture.channels.end() ? nullptr : &*found;
}

/// The attribute of that name, or null if it is not there or of another type.
template <class T>
const T* attribute_of(const LayeredPicture& picture, const std::string& name) {
    const auto found = picture.attributes.find(name);
    return found == picture.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

/// A part of an EXR file. The name tells it apart from other parts; the only part of a file needs none.
struct PicturePart {
    std::string name;
    LayeredPicture picture;
};

}  // namespace cistula
