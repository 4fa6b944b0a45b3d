// What the header of an EXR file claims, compared with the bytes that the file has.
#pragma once

#include <string>

namespace cistula {

/// Throws std::runtime_error for a header that says more than the file's bytes can hold: the OpenEXR library takes the
/// memory for attributes and tables of chunks before it reads them. Says nothing of files that are no EXR or whose
/// header ends early, which the library refuses by itself. Layout: "OpenEXR File Layout", openexr.com.
void check_exr_header(const std::string& path);

}  // namespace cistula
