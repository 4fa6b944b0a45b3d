#include "image/exr/exr_checks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "base/shown_text.h"

namespace cistula {
namespace {

constexpr uint32_t magic = 20000630;
constexpr uint32_t several_parts = 0x1000;
constexpr size_t longest_name = 255;
constexpr int64_t offset_bytes = 8;  // of a chunk, in the table that precedes the pixels

/// A file of numbers, lowest byte first.
class HeaderBytes {
  public:
    explicit HeaderBytes(const std::string& path)
        : file_(path, std::ios::binary), size_(static_cast<int64_t>(std::filesystem::file_size(path))) {}

    int64_t size() const { return size_; }
    int64_t left() { return size_ - static_cast<int64_t>(file_.tellg()); }
    int64_t place() { return static_cast<int64_t>(file_.tellg()); }
    void go_to(int64_t place) { file_.seekg(place); }
    bool fails() const { return !file_; }

    uint32_t number() {
        std::array<unsigned char, 4> bytes{};
        file_.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        return bytes[0] | uint32_t{bytes[1]} << 8 | uint32_t{bytes[2]} << 16 | uint32_t{bytes[3]} << 24;
    }
    int32_t whole() { return static_cast<int32_t>(number()); }

    /// Text up to a zero byte; nothing if there is none in reach.
    std::optional<std::string> name() {
        std::string text;
        for (char c = 0; file_.get(c) && text.size() <= longest_name;) {
            if (c == 0) return text;
            text += c;
        }
        return std::nullopt;
    }

  private:
    std::ifstream file_;
    int64_t size_;
};

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("its header says that it has " + what + ", more than its bytes can hold; it is damaged");
}

/// The bytes of a value of each type that has a size of its own. The library reads so many, whatever the size that the
/// file says.
const std::map<std::string_view, int32_t> fixed_sizes = {{"box2i", 16},
                                                         {"box2f", 16},
                                                         {"chromaticities", 32},
                                                         {"compression", 1},
                                                         {"deepImageState", 1},
                                                         {"double", 8},
                                                         {"envmap", 1},
                                                         {"float", 4},
                                                         {"int", 4},
                                                         {"keycode", 28},
                                                         {"lineOrder", 1},
                                                         {"m33d", 72},
                                                         {"m33f", 36},
                                                         {"m44d", 128},
                                                         {"m44f", 64},
                                                         {"rational", 8},
                                                         {"tiledesc", 9},
                                                         {"timecode", 8},
                                                         {"v2d", 16},
                                                         {"v2f", 8},
                                                         {"v2i", 8},
                                                         {"v3d", 24},
                                                         {"v3f", 12},
                                                         {"v3i", 12}};

/// One header: its attributes up to an empty name.
class HeaderCheck {
  public:
    explicit HeaderCheck(HeaderBytes& bytes) : bytes_(bytes) {}

    /// False where the header ends early.
    bool run() {
        for (;;) {
            const std::optional<std::string> name = bytes_.name();
            if (!name) return false;
            if (name->empty()) break;
            const std::optional<std::string> type = bytes_.name();
            const int32_t size = bytes_.whole();
            if (!type || bytes_.fails()) return false;
            if (size < 0 || size > bytes_.left())
                fail("an attribute " + quoted(std::string_view(*name)) + " of " +
                     std::to_string(static_cast<uint32_t>(size)) + " bytes");
            const int64_t end = bytes_.place() + size;
            const auto fixed = fixed_sizes.find(*type);
            if (fixed != fixed_sizes.end() && size != fixed->second) fail_size(*name, *type);
            look_at(*name, *type, end);
            bytes_.go_to(end);
        }
        check_chunks();
        return true;
    }

  private:
    [[noreturn]] static void fail_size(const std::string& name, const std::string& type) {
        throw std::runtime_error("the attribute " + quoted(std::string_view(name)) +
                                 " of its header does not have the size of its type, " +
                                 quoted(std::string_view(type)) + "; it is damaged");
    }

    /// Channels up to an empty name: the library stops there, whatever the size that the file says. False where they do
    /// not end at `end`.
    bool channels_end_at(int64_t end) {
        constexpr int64_t bytes_after_name = 16;
        while (bytes_.place() < end) {
            const std::optional<std::string> channel = bytes_.name();
            if (!channel) return false;
            if (channel->empty()) return bytes_.place() == end;
            bytes_.go_to(bytes_.place() + bytes_after_name);
        }
        return false;
    }

    /// Reads what the library takes memory by, and what it reads by another size than the attribute's own.
    void look_at(const std::string& name, const std::string& type, int64_t end) {
        if (type == "chlist") {
            if (!channels_end_at(end)) fail_size(name, type);
        } else if (type == "floatvector") {
            if ((end - bytes_.place()) % 4 != 0) fail_size(name, type);
        } else if (type == "stringvector") {
            while (bytes_.place() + 4 <= end) {
                const int32_t size = bytes_.whole();
                if (size < 0 || bytes_.place() + size > end)
                    fail("a text too long in " + quoted(std::string_view(name)));
                bytes_.go_to(bytes_.place() + size);
            }
            if (bytes_.place() != end) fail_size(name, type);
        } else if (type == "preview") {
            const int64_t width = bytes_.number();
            const int64_t height = bytes_.number();
            if (width != 0 && height > (end - bytes_.place()) / 4 / width) fail("a preview too large");
            if (bytes_.place() + 4 * width * height != end) fail_size(name, type);
        } else if (type == "idmanifest") {
            if (bytes_.number() / 2048 > static_cast<uint32_t>(end - bytes_.place())) fail("a manifest too large");
        } else if (name == "dataWindow" && type == "box2i") {
            const int64_t left = bytes_.whole();
            const int64_t top = bytes_.whole();
            const int64_t right = bytes_.whole();
            const int64_t bottom = bytes_.whole();
            width_ = right - left + 1;
            height_ = bottom - top + 1;
        } else if (name == "tiles" && type == "tiledesc") {
            tile_width_ = bytes_.number();
            tile_height_ = bytes_.number();
        }
    }

    /// Chunks have an offset each in the file: tiles, or at most 256 lines.
    void check_chunks() const {
        if (width_ <= 0 || height_ <= 0) return;
        constexpr int64_t most_lines = 256;
        const int64_t lines = tile_height_ > 0 ? tile_height_ : most_lines;
        const int64_t columns = tile_width_ > 0 ? (width_ + tile_width_ - 1) / tile_width_ : 1;
        const int64_t rows = (height_ + lines - 1) / lines;
        if (columns > bytes_.size() / offset_bytes / rows)
            fail(std::to_string(width_) + "x" + std::to_string(height_) + " pixels");
    }

    HeaderBytes& bytes_;
    int64_t width_ = 0;
    int64_t height_ = 0;
    int64_t tile_width_ = 0;
    int64_t tile_height_ = 0;
};

constexpr int largest_tile_side = 8192;  // the library holds a whole tile in memory, as its header says

void limit_sizes() {
    static const bool once = [] {
        Imf::Header::setMaxImageSize(static_cast<int>(largest_picture_side), static_cast<int>(largest_picture_side));
        Imf::Header::setMaxTileSize(largest_tile_side, largest_tile_side);
        return true;
    }();
    (void)once;
}

}  // namespace

int64_t check_exr_header(const std::string& path) {
    HeaderBytes bytes(path);
    if (bytes.number() != magic) return 0;
    const bool has_parts = (bytes.number() & several_parts) != 0;
    do {
        if (!HeaderCheck(bytes).run()) return 0;
        const int64_t place = bytes.place();
        if (!has_parts) return place;
        const std::optional<std::string> next = bytes.name();
        if (!next) return 0;
        if (next->empty()) return place + 1;  // an empty header ends the list
        bytes.go_to(place);
    } while (!bytes.fails());
    return 0;
}

int64_t check_before_opening(const std::string& path) {
    limit_sizes();
    return check_exr_header(path);
}

void check_claim(const Imf::Header& header, const std::string& path) {
    // Deflate packs 1,032 to 1 at most, RLE and PIZ less; DWA does so after it took one value in 64.
    double packing = 1032;
    if (header.compression() == Imf::NO_COMPRESSION) packing = 1;
    if (header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION)
        packing = 64 * 1032;
    const Imath::Box2i& window = header.dataWindow();
    const double width = static_cast<double>(window.max.x) - window.min.x + 1;
    const double height = static_cast<double>(window.max.y) - window.min.y + 1;
    double bytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytes += width * height * (channel.channel().type == Imf::HALF ? 2 : 4) /
                 (static_cast<double>(channel.channel().xSampling) * channel.channel().ySampling);
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    if (bytes > packing * size)
        throw std::runtime_error("it says that it has " + std::to_string(static_cast<int64_t>(width)) + "x" +
                                 std::to_string(static_cast<int64_t>(height)) +
                                 " pixels, more than its bytes can hold; it is damaged");
}

}  // namespace cistula
