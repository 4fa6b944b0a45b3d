// The part that reads pictures of the module that uses OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <regex>
#include <string>

#include "scene/image/oiio_input.h"
#include "scene/image/oiio_module.h"
#include "scene/image/oiio_view.h"
#include "scene/image/picture_damage.h"
#include "scene/image/stored_oiio.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

bool fail(const OiioHost& host, const std::string& reason) {
    host.failed(host.self, reason_or_none(reason).c_str());
    return false;
}

/// The type of samples that the host gets for those of a file; false if they are of another kind.
bool sample_type(const OIIO::ImageSpec& spec, OiioSamples& type, OIIO::TypeDesc& format) {
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            type = OiioSamples::uint8;
            format = OIIO::TypeDesc::UINT8;
            return true;
        case OIIO::TypeDesc::UINT16:
            type = OiioSamples::uint16;
            format = OIIO::TypeDesc::UINT16;
            return true;
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE:
            type = OiioSamples::float32;
            format = OIIO::TypeDesc::FLOAT;
            return true;
        default:
            return false;
    }
}

/// Gives the host the file's ICC profile.
void send_profile(const OIIO::ImageSpec& spec, const OiioHost& host) {
    const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
    if (profile && profile->type().basetype == OIIO::TypeDesc::UINT8)
        host.profile(host.self, profile->data(), static_cast<size_t>(profile->datasize()));
}

bool read_opened(OIIO::ImageInput& input, const char* path, const OiioHost& host) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.depth > 1 || spec.deep || spec.nchannels < 1)
        return fail(host, "it is no flat picture; a texture has one color per pixel");
    OiioSamples type;
    OIIO::TypeDesc format;
    if (!sample_type(spec, type, format))
        return fail(host, std::string("its samples are of type ") + spec.format.c_str() +
                              "; a texture has 8 or 16 bits, half or float");
    if (is_multiplied(input)) return fail(host, multiplied_reason);
    const int channels = spec.nchannels < 3 ? 1 : 3;
    send_profile(spec, host);
    if (!host.begin(host.self, spec.width, spec.height, static_cast<uint32_t>(channels), type)) return false;
    std::string problem = picture_damage(input.format_name(), path);
    if (problem.empty())
        problem = read_rows(input, 0, 0, channels, format,
                            [&](const void* samples, size_t texels) { host.samples(host.self, samples, texels); });
    return problem.empty() || fail(host, problem);
}

/// Versions from 2.5 on refuse pictures beyond limit_library's limits in words of their own, which end with the size:
/// "60000x60000". The host says it in its words, if it is too large for it, too.
bool fail_to_open(const OiioHost& host, const std::string& reason) {
    const std::regex size("([0-9]{1,9})x([0-9]{1,9})");
    std::smatch last;
    for (auto at = std::sregex_iterator(reason.begin(), reason.end(), size); at != std::sregex_iterator(); ++at)
        last = *at;
    if (!last.empty() && reason.find("exceed") != std::string::npos &&
        !host.begin(host.self, std::stoll(last[1]), std::stoll(last[2]), 3, OiioSamples::uint8))
        return false;
    return fail(host, reason);
}

bool read(const char* path, const OiioHost* host) noexcept {
    return guarded(*host, [&] {
        limit_library(host->left / texel_bytes);
        // Premultiplied colors would be darker, and wrong if multiplied before decoding from sRGB.
        const OIIO::ImageSpec settings = as_stored();
        const auto input = OIIO::ImageInput::open(path, &settings);
        return input ? read_opened(*input, path, *host) : fail_to_open(*host, OIIO::geterror());
    });
}

}  // namespace
}  // namespace cistula

extern "C" __attribute__((visibility("default"))) const cistula::OiioModule* cistula_oiio_module_7() {
    static constexpr cistula::OiioModule module = {cistula::read,          cistula::read_stored, cistula::open_view,
                                                   cistula::assumed_space, cistula::apply_view,  cistula::close_view};
    return &module;
}
