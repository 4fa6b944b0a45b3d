// An open OpenEXR file of any number of parts, of which channels are read as they are wanted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/image/picture.h"

namespace cistula {

/// A channel of a part, and its values once they are read: width x height, row-major from the top left.
struct ExrChannel {
    enum class Type { half, float_, uint };

    std::string name;
    Type type = Type::float_;
    bool is_halved = false;  // the file has one value for two by two pixels, which all of them get
    std::vector<float> values;
    std::vector<uint32_t> numbers;  // those of a uint channel, exact; its values are rounded
};

/// What a part's header says.
struct ExrPart {
    std::string name;           // files of one part need not have one
    int width = 0, height = 0;  // of the data window
    int full_height = 0;        // of the display window
    decltype(LayeredPicture::attributes) attributes;
    std::vector<ExrChannel> channels;  // by name
};

/// The file stays open, so what is read is what the headers said.
class ExrFile {
  public:
    /// Reads the headers. Scan line and tiled parts. Throws Error(ExitCode::file); deep data is refused.
    explicit ExrFile(const std::string& path);
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    const std::vector<ExrPart>& parts() const { return parts_; }

    /// The values of channels of a part, in this order; both are numbers in parts(). Throws Error(ExitCode::file).
    std::vector<ExrChannel> read(size_t part, const std::vector<size_t>& channels) const;

  private:
    struct Open;

    std::string path_;
    std::unique_ptr<Open> file_;
    std::vector<ExrPart> parts_;
};

}  // namespace cistula
