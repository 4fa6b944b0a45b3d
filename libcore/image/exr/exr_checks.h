// What is checked of an OpenEXR file before its pixels are read, for all of its readers. Private to image/.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <cerrno>
#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "base/file_bytes.h"

namespace cistula {

/// Whether one of the library's exceptions says that there is too little memory, be it what a thread of it threw.
inline bool lacks_memory(const std::exception& failure) {
    return errno == ENOMEM || std::string_view(failure.what()) == std::bad_alloc().what();
}

/// Runs `read`; the library's exceptions become an Error that names the file, or std::bad_alloc.
template <class Read>
auto with_file_errors(const std::string& path, Read read) {
    errno = 0;
    try {
        return read();
    } catch (const Error&) {
        if (errno == ENOMEM) throw std::bad_alloc();  // the library takes what it could not read for missing
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (lacks_memory(failure)) throw std::bad_alloc();
        throw file_error(path, "read", std::string(failure.what()));
    }
}

/// What has to be done before the library opens a file, so that a damaged header cannot make it allocate huge arrays:
/// its limits are set, and check_exr_header, whose number it returns.
int64_t check_before_opening(const std::string& path);

/// Throws std::runtime_error for a header that says more than the file's bytes can hold: the OpenEXR library takes the
/// memory for attributes and tables of chunks before it reads them. Says nothing of files that are no EXR or whose
/// header ends early, which the library refuses by itself. Returns the bytes of all headers, 0 for these. Layout:
/// "OpenEXR File Layout", openexr.com.
int64_t check_exr_header(const std::string& path);

/// Throws for a header that says more pixels than a file of its size can hold, before memory is taken for them.
void check_claim(const Imf::Header& header, const std::string& path);

}  // namespace cistula
