#include "scene/image/picture_io.h"

#include <stdexcept>
#include <string>

#include "cistula/numerics/real.h"
#include "scene/base/atomic_file.h"
#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"
#include "scene/image/picture_oiio.h"
#include "scene/image/png.h"
#include "scene/image/raw_picture.h"

namespace cistula {
namespace {

ColorPicture read_any(const std::string& path) {
    const std::string start = read_file_start(path, 4);
    if (start.empty()) throw file_error(path, "read", std::string("it is empty; give a picture"));
    const std::string extension = lower_extension(path);
    if (extension == ".exr" || start == "\x76\x2f\x31\x01") return read_exr_texture(path);
    if (extension == ".data" || extension == ".out") return read_raw_picture(path);
    return oiio_read(path);
}

/// Throws unless all texels are finite and not negative; a scene's radiance bound holds only for such textures.
void check_texels(const std::string& path, const ColorPicture& picture) {
    for (size_t i = 0; i < picture.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float value = picture.texels[i][c];
            if (is_finite(value) && value >= 0) continue;
            throw Error(ExitCode::file, path + ": texel (" + std::to_string(i % picture.width) + ", " +
                                            std::to_string(i / picture.width) + ") has " + "RGB"[c] + " = " +
                                            std::to_string(value) + "; texels are finite and not negative");
        }
}

}  // namespace

ColorPicture read_texture(const std::string& path) {
    ColorPicture picture = read_any(path);
    check_texels(path, picture);
    return picture;
}

void write_preview(const std::string& path, const ColorPicture& linear) {
    if (linear.width == 0 || linear.texels.size() != static_cast<size_t>(linear.width) * linear.height)
        throw std::invalid_argument("write_preview: texels must number width * height, and be some");
    if (lower_extension(path) != ".png")
        throw file_error(path, "write", std::string("a preview is a PNG; give a name that ends in .png"));
    std::string bytes;
    try {
        bytes = encode_png(linear);
    } catch (const std::runtime_error& error) {
        throw file_error(path, "write", std::string(error.what()));
    }
    write_file_atomically(path, bytes);
}

}  // namespace cistula
