#include "image/picture/picture_io.h"

#include <stdexcept>
#include <string>

#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "image/picture/png.h"
#include "image/reader/picture_reader.h"

namespace cistula {
ColorPicture read_texture(const std::string& path, std::string_view encoding) {
    return TextureReader().read(path, nullptr, encoding);
}

void write_preview(const std::string& path, const ColorPicture& linear) {
    if (linear.width == 0 || linear.texels.size() != static_cast<size_t>(linear.width) * linear.height)
        throw std::invalid_argument("write_preview: texels must number width * height, and be some");
    if (lower_extension(path) != ".png")
        throw file_error(path, "write", std::string("a preview is a PNG"), "give a name that ends in .png");
    std::string bytes;
    try {
        bytes = encode_png(linear);
    } catch (const std::runtime_error& error) {
        throw file_error(path, "write", std::string(error.what()));
    }
    write_file_atomically(path, bytes);
}

}  // namespace cistula
