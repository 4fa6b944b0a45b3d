// OpenEXR files: written with layers and atomically; read for comparisons, for --resume and as textures.
#pragma once

#include <climits>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "image/picture/picture.h"

namespace cistula {

struct FileColors;

/// The first bytes of every OpenEXR file.
inline constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";

/// Writes a scan line file. Equal pictures give equal files: no dates, nothing of the machine or
/// the number of threads: those of TBB for zip and zips, for others OpenEXR's, `most_threads` at most. Half channels
/// round to nearest even. Attributes: string, int, double, 16 floats -> m44f, 8 floats named "chromaticities" ->
/// chromaticities (red, green, blue, white xy), other lengths -> floatvector, Ratio -> rational; "screenWindowWidth" ->
/// float. Throws Error: `file` if it cannot be written, `interrupted` if it is not done half a second after `stop` was
/// given; std::invalid_argument if the picture is inconsistent or an attribute has a name that OpenEXR reserves
/// ("compression", "version", ...).
void write_exr(const std::string& path, const LayeredPicture& picture, int most_threads = INT_MAX,
               StopSignal stop = {});

/// Writes a file of several parts, or of one as above; their names and attributes are in their own headers.
void write_exr(const std::string& path, const std::vector<PicturePart>& parts, int most_threads = INT_MAX,
               StopSignal stop = {});

/// Sets the number of OpenEXR's threads, which belong to the whole process: for programs, never called by libraries. 0,
/// the default: each caller of write_exr compresses by itself. Not while a file is written or read.
void set_exr_threads(int threads);

/// Reads all channels as floats, in the order of the file (by name), with the attributes of the types that write_exr
/// writes; float attributes become doubles. Scan line and tiled files of one part. Throws Error (file).
LayeredPicture read_exr(const std::string& path);

/// Reads files of one or several parts, in the order of the file.
std::vector<PicturePart> read_exr_parts(const std::string& path);

/// Reads what the headers of files say: parts without values.
std::vector<PicturePart> read_exr_headers(const std::string& path);

/// True for an OpenEXR file in which every chunk of pixels is present, and where these are lines, nothing else; false
/// for anything else, also if there is no file.
bool exr_is_complete(const std::string& path);

/// Why a picture of a width and a height is refused; empty if it is not.
using SizeProblem = std::function<std::string(int64_t width, int64_t height)>;

/// Reads the numbers of a texture from the data window, of the first part; half, float or uint: R, G and B; or one
/// channel, Y or the only one, which is gray; or luminance and chroma (Y, RY, BY), by the file's chromaticities.
/// `colors` becomes what the file says of its colors. Memory for pixels is taken after `size_problem` has seen their
/// size. Throws Error (file).
ColorPicture read_exr_texture(const std::string& path, const SizeProblem& size_problem = {},
                              FileColors* colors = nullptr);

}  // namespace cistula
