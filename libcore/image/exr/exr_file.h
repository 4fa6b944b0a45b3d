// An open OpenEXR file of any number of parts, of which channels are read as they are wanted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "image/exr/exr.h"
#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// A channel of a part, and its values once they are read: width x height, row-major from the top left.
struct ExrChannel {
    using Type = StoredType;  // half, float_ or uint

    std::string name;
    Type type = Type::float_;
    // the file has one value for so many pixels, which all of them get
    int x_sampling = 1;
    int y_sampling = 1;
    std::vector<float> values;
    std::vector<uint32_t> numbers;  // those of a uint channel, exact; its values are rounded

    bool is_halved() const { return x_sampling == 2 && y_sampling == 2; }
};

/// Numbers of a level of a mip map or a rip map.
struct ExrLevel {
    int x = 0;
    int y = 0;
};

/// What a part's header says.
struct ExrPart {
    std::string name;  // files of one part need not have one
    // of the data window
    int width = 0;
    int height = 0;
    Compression compression = Compression::other;
    PixelRect data, display;
    std::vector<ExrLevel> levels;  // {0, 0} is the whole resolution, and first
    decltype(LayeredPicture::attributes) attributes;
    std::map<std::string, StoredAttribute> header;  // all attributes but those that windows and channels are
    std::map<std::string, std::string> packing;     // exr_packing
    std::vector<ExrChannel> channels;               // by name
};

/// The file stays open, so what is read is what the headers said.
class ExrFile {
  public:
    /// Reads the headers. Scan line and tiled parts. Throws Error (file); deep data is refused, and so is a
    /// first part with a `size_problem`.
    explicit ExrFile(const std::string& path, const SizeProblem& size_problem = {});
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    const std::vector<ExrPart>& parts() const { return parts_; }

    /// The values of channels of a part, in this order; both are numbers in parts(). Throws Error (file).
    std::vector<ExrChannel> read(size_t part, const std::vector<size_t>& channels) const;

    /// Those of a level, whose data window this is.
    std::vector<ExrChannel> read(size_t part, const std::vector<size_t>& channels, ExrLevel level,
                                 PixelRect& window) const;

    /// A picture whose texels have the values of the first channel as red, of the second as green, of the third as
    /// blue; those of subsampled channels in the first of their pixels alone. Throws Error (file).
    ColorPicture read_colors(size_t part, const std::vector<size_t>& channels) const;

    /// Whether all pixels are there. After those of parts of lines alone there must be nothing. Throws Error (file).
    bool is_complete() const;

  private:
    struct Open;

    std::string path_;
    int64_t headers_ = 0;  // their bytes
    std::unique_ptr<Open> file_;
    std::vector<ExrPart> parts_;
};

/// All of a file as it stands: parts, levels, channels and attributes; without `values` what its headers say, of whole
/// resolutions. Throws Error (file); deep data is refused.
StoredFile read_stored_exr(const std::string& path, bool values = true);

/// Makes R, G and B of texels that hold RY = (R - Y) / Y, Y and BY = (B - Y) / Y. A channel that `is_halved` holds in
/// the texels of even x and y alone; the others are filtered from these as OpenEXR's RgbaInputFile does, and colors
/// that this made more saturated than their neighbors are desaturated, as there. In double, so that the same file gives
/// the same bits with every version of that library. `weights` are the shares of R, G and B in Y.
void colors_from_chroma(ColorPicture& picture, const bool (&is_halved)[3], const glm::dvec3& weights);

}  // namespace cistula
