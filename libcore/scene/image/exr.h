// OpenEXR files: written with layers, whole or not at all; read back for comparisons, for --resume and as textures.
#pragma once

#include <string>

#include "scene/image/picture.h"

namespace cistula {

/// Writes a scan line file with ZIP compression. Equal pictures become equal files: no dates, no trace of the machine
/// or of the number of threads (see set_exr_threads). Half channels round to nearest even. Attributes:
/// string, int, double, 16 floats -> m44f, 8 floats named "chromaticities" -> chromaticities (red, green, blue, white
/// xy), other lengths -> floatvector. Throws Error(ExitCode::file) if it cannot be written, std::invalid_argument if
/// the picture is inconsistent or an attribute's name is one that OpenEXR keeps for itself ("compression", "version",
/// ...).
void write_exr(const std::string& path, const LayeredPicture& picture);

/// OpenEXR's own threads, for the whole process and all files together: they compress what callers of write_exr write,
/// a few for each file. 0, as at the start: every caller compresses by itself. Not while a file is written or read.
void set_exr_threads(int threads);

/// All channels as floats, in the order of the file (by name), with the attributes of the types that write_exr writes,
/// float among the doubles. Scan line and tiled files, one part. Throws Error(ExitCode::file).
LayeredPicture read_exr(const std::string& path);

/// True if it is an OpenEXR file in which every chunk of pixels is present. False for whatever else, no file included.
bool exr_is_complete(const std::string& path);

/// R, G, B, or Y alone, of the data window; half, float or uint. Throws Error(ExitCode::file).
ColorPicture read_exr_texture(const std::string& path);

}  // namespace cistula
