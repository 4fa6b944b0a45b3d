#include "scene/picture_oiio.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <new>
#include <stdexcept>

#include "scene/atomic_file.h"
#include "scene/srgb_codes.h"

namespace cistula {
namespace {

/// The first channel, or the first three, as T, in the order of the texels.
template <class T>
std::vector<T> read_samples(const std::string& path, OIIO::ImageInput& input, int channels) {
    const OIIO::ImageSpec& spec = input.spec();
    std::vector<T> samples(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) *
                           static_cast<size_t>(channels));
    if (!input.read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<T>::value, samples.data()))
        throw file_error(path, "read", input.geterror());
    return samples;
}

template <class T, class Linear>
ColorPicture read_as(const std::string& path, OIIO::ImageInput& input, Linear linear) {
    const OIIO::ImageSpec& spec = input.spec();
    const size_t channels = spec.nchannels < 3 ? 1 : 3;
    const std::vector<T> samples = read_samples<T>(path, input, static_cast<int>(channels));
    ColorPicture picture;
    picture.width = static_cast<uint32_t>(spec.width);
    picture.height = static_cast<uint32_t>(spec.height);
    picture.texels.resize(static_cast<size_t>(picture.width) * picture.height);
    for (size_t i = 0; i < picture.texels.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            picture.texels[i][static_cast<int>(c)] = linear(samples[i * channels + (channels == 3 ? c : 0)]);
    return picture;
}

ColorPicture read_opened(const std::string& path, OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > largest_picture_side || spec.height > largest_picture_side)
        throw file_error(path, "read",
                         "its size is " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                             "; width and height of a texture are 1 to " + std::to_string(largest_picture_side));
    if (spec.depth > 1 || spec.deep || spec.nchannels < 1)
        throw file_error(path, "read", std::string("it is no flat picture; a texture has one color per pixel"));
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            return read_as<uint8_t>(path, input, linear_from_srgb8);
        case OIIO::TypeDesc::UINT16:
            return read_as<uint16_t>(path, input, linear_from_srgb16);
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE:
            return read_as<float>(path, input, [](float value) { return value; });
        default:
            throw file_error(path, "read",
                             std::string("its samples are of type ") + spec.format.c_str() +
                                 "; a texture has 8 or 16 bits, half or float");
    }
}

}  // namespace

ColorPicture oiio_read(const std::string& path) {
    // Colors as stored: multiplying by alpha would darken texels, and before decoding it would be wrong besides.
    OIIO::ImageSpec settings;
    settings["oiio:UnassociatedAlpha"] = 1;
    try {
        const auto input = OIIO::ImageInput::open(path, &settings);
        if (!input) throw file_error(path, "read", OIIO::geterror());
        return read_opened(path, *input);
    } catch (const std::bad_alloc&) {
        throw file_error(path, "read", std::string("not enough memory for a picture of its size"));
    }
}

void oiio_write(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint8_t>& bytes) {
    // Encoded in memory, so that only our own writing can meet a full disk.
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput sink(encoded);
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::UINT8);
    spec["oiio:ColorSpace"] = "sRGB";
    const auto output = OIIO::ImageOutput::create("png");
    if (!output) throw file_error(path, "write", OIIO::geterror());
    output->set_ioproxy(&sink);
    if (!output->open("preview.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, bytes.data()) ||
        !output->close())
        throw file_error(path, "write", output->geterror());
    write_file_atomically(path, std::string_view(reinterpret_cast<const char*>(encoded.data()), encoded.size()));
}

}  // namespace cistula
