// What all that reads pictures through OpenImageIO has in common. Private to its module.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <new>
#include <string>

namespace cistula {

/// What OpenImageIO says of a failure, or that it says nothing.
inline std::string reason_or_none(const std::string& reason) {
    return reason.empty() ? "OpenImageIO gives no reason; the file is damaged" : reason;
}

/// Runs `work` and reports what it throws through `host.failed`. Host: OiioHost or OiioStoredHost.
template <class Host, class Work>
bool guarded(const Host& host, Work work) noexcept {
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

/// Settings with which colors come as they are stored: not multiplied by alpha.
OIIO::ImageSpec as_stored();

/// Sets the library's own limits, in case a format asks them before the size is seen here; versions differ in which of
/// them they know.
void limit_library(uint64_t texels);

/// Reads a subimage at a level, some rows at a time, so that the whole picture is never in memory here, but for formats
/// that have it there. `take(values, texels)` gets them. Returns why it fails, or nothing.
std::string read_rows(OIIO::ImageInput& input, int subimage, int level, int channels, OIIO::TypeDesc format,
                      const std::function<void(const void*, size_t)>& take);

/// Whether a WebP file has colors that the library multiplies by alpha, in their codes: versions before 2.5 know no
/// other way. Those of opaque pixels stay what they are.
bool is_multiplied(OIIO::ImageInput& input);

inline constexpr const char* multiplied_reason =
    "its colors are multiplied by their alpha when it is read; save it without alpha, or as PNG";

}  // namespace cistula
