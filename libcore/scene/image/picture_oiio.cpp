// The module that uses OpenImageIO; nothing else links that library.
#include <OpenImageIO/imageio.h>

#include <exception>
#include <new>
#include <string>

#include "scene/base/file_bytes.h"
#include "scene/image/picture_oiio_module.h"

namespace cistula {
namespace {

bool fail(const OiioHost& host, const std::string& reason) {
    host.failed(host.self, reason.c_str());
    return false;
}

/// Runs `work` and reports what it throws through `failed`.
template <class Work>
bool guarded(const OiioHost& host, Work work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        host.failed(host.self, "not enough memory for a picture of its size");
    } catch (const std::exception& error) {
        host.failed(host.self, error.what());
    } catch (...) {
        host.failed(host.self, "OpenImageIO threw an exception of an unknown kind");
    }
    return false;
}

bool read_opened(OIIO::ImageInput& input, const OiioHost& host) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > largest_picture_side || spec.height > largest_picture_side)
        return fail(host, "its size is " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                              "; width and height of a texture are 1 to " + std::to_string(largest_picture_side));
    if (spec.depth > 1 || spec.deep || spec.nchannels < 1)
        return fail(host, "it is no flat picture; a texture has one color per pixel");
    OiioSamples type = OiioSamples::float32;
    OIIO::TypeDesc format = OIIO::TypeDesc::FLOAT;
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            type = OiioSamples::uint8;
            format = OIIO::TypeDesc::UINT8;
            break;
        case OIIO::TypeDesc::UINT16:
            type = OiioSamples::uint16;
            format = OIIO::TypeDesc::UINT16;
            break;
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE:
            break;
        default:
            return fail(host, std::string("its samples are of type ") + spec.format.c_str() +
                                  "; a texture has 8 or 16 bits, half or float");
    }
    const int channels = spec.nchannels < 3 ? 1 : 3;
    void* const samples = host.room(host.self, static_cast<uint32_t>(spec.width), static_cast<uint32_t>(spec.height),
                                    static_cast<uint32_t>(channels), type);
    if (!samples) return false;
    return input.read_image(0, 0, 0, channels, format, samples) || fail(host, input.geterror());
}

bool read(const char* path, const OiioHost* host) noexcept {
    return guarded(*host, [&] {
        // Colors as stored: premultiplied colors would be darker, and wrong if multiplied before decoding from sRGB.
        OIIO::ImageSpec settings;
        settings["oiio:UnassociatedAlpha"] = 1;
        const auto input = OIIO::ImageInput::open(path, &settings);
        return input ? read_opened(*input, *host) : fail(*host, OIIO::geterror());
    });
}

}  // namespace
}  // namespace cistula

extern "C" __attribute__((visibility("default"))) const cistula::OiioModule* cistula_oiio_module_2() {
    static constexpr cistula::OiioModule module = {cistula::read};
    return &module;
}
