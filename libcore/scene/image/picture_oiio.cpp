// The part that reads pictures of the module that uses OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <climits>
#include <exception>
#include <new>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/file_bytes.h"
#include "scene/image/oiio_module.h"
#include "scene/image/oiio_view.h"
#include "scene/image/picture_damage.h"
#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

bool fail(const OiioHost& host, const std::string& reason) {
    host.failed(host.self, reason.empty() ? "OpenImageIO gives no reason; the file is damaged" : reason.c_str());
    return false;
}

/// Runs `work` and reports what it throws through `failed`.
template <class Work>
bool guarded(const OiioHost& host, Work work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        host.failed(host.self, "decoding it takes more memory than is allowed");
    } catch (const std::exception& error) {
        host.failed(host.self, error.what());
    } catch (...) {
        host.failed(host.self, "OpenImageIO threw an exception of an unknown kind");
    }
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

/// Reads some rows at a time, so that the whole picture is never in memory here, but for formats that have it there.
bool read_rows(OIIO::ImageInput& input, const OiioHost& host, int channels, OIIO::TypeDesc format) {
    const OIIO::ImageSpec spec = input.spec();
    const size_t texel = static_cast<size_t>(channels) * format.size(), row = texel * static_cast<size_t>(spec.width);
    constexpr size_t piece = 16 << 20;
    const int step = spec.tile_width > 0 ? spec.tile_height : static_cast<int>(std::clamp<size_t>(piece / row, 1, 256));
    if (step < 1) return fail(host, "its tiles have no height");
    std::vector<char> samples(row * static_cast<size_t>(std::min(step, spec.height)));
    for (int y = 0; y < spec.height; y += std::min(step, spec.height - y)) {
        const int first = spec.y + y, end = first + std::min(step, spec.height - y);
        const bool done = spec.tile_width > 0
                              ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, first, end, spec.z, spec.z + 1, 0,
                                                 channels, format, samples.data())
                              : input.read_scanlines(0, 0, first, end, spec.z, 0, channels, format, samples.data());
        if (!done || input.has_error()) return fail(host, input.geterror());  // some formats fail after true
        host.samples(host.self, samples.data(), static_cast<size_t>(end - first) * static_cast<size_t>(spec.width));
    }
    return true;
}

/// Gives the host the file's ICC profile.
void send_profile(const OIIO::ImageSpec& spec, const OiioHost& host) {
    const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
    if (profile && profile->type().basetype == OIIO::TypeDesc::UINT8)
        host.profile(host.self, profile->data(), static_cast<size_t>(profile->datasize()));
}

/// Whether a WebP file has colors that the library multiplies by alpha, in their codes: versions before 2.5 know no
/// other way. Those of opaque pixels stay what they are.
bool is_multiplied(OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    if (std::string_view(input.format_name()) != "webp" || spec.alpha_channel < 0) return false;
    if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) return false;
    std::vector<uint8_t> row(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels));
    for (int y = 0; y < spec.height; ++y) {
        if (!input.read_scanline(y, 0, OIIO::TypeDesc::UINT8, row.data()))
            return false;  // which is said when it is read
        for (auto at = static_cast<size_t>(spec.alpha_channel); at < row.size();
             at += static_cast<size_t>(spec.nchannels))
            if (row[at] != 255) return true;
    }
    return false;
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
    if (is_multiplied(input))
        return fail(host, "its colors are multiplied by their alpha when it is read; save it without alpha, or as PNG");
    const int channels = spec.nchannels < 3 ? 1 : 3;
    send_profile(spec, host);
    if (!host.begin(host.self, spec.width, spec.height, static_cast<uint32_t>(channels), type)) return false;
    const std::string damage = picture_damage(input.format_name(), path);
    return damage.empty() ? read_rows(input, host, channels, format) : fail(host, damage);
}

/// Sets the library's own limits, in case a format asks them before the size is seen here; versions differ in which of
/// them they know.
void limit_library(uint64_t left) {
    constexpr uint64_t most_stored_bytes = 32;  // of a texel: four doubles
    const uint64_t megabytes = left / texel_bytes * most_stored_bytes / (1 << 20) + 1;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::min<uint64_t>(megabytes, INT_MAX)));
    OIIO::attribute("limits:resolution", static_cast<int>(largest_picture_side));
    OIIO::attribute("threads", 1);
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
        limit_library(host->left);
        // Colors as stored: premultiplied colors would be darker, and wrong if multiplied before decoding from sRGB.
        OIIO::ImageSpec settings;
        settings["oiio:UnassociatedAlpha"] = 1;
        const auto input = OIIO::ImageInput::open(path, &settings);
        return input ? read_opened(*input, path, *host) : fail_to_open(*host, OIIO::geterror());
    });
}

}  // namespace
}  // namespace cistula

extern "C" __attribute__((visibility("default"))) const cistula::OiioModule* cistula_oiio_module_6() {
    static constexpr cistula::OiioModule module = {cistula::read, cistula::open_view, cistula::assumed_space,
                                                   cistula::apply_view, cistula::close_view};
    return &module;
}
