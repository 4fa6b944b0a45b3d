#include "image/exr/exr_header.h"

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <string_view>
#include <utility>

namespace cistula {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers in EXR files begin with their lowest byte");

/// A stream into memory.
class MemoryStream : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}

    void write(const char bytes[], int count) override {
        const auto size = static_cast<size_t>(count);
        if (place_ + size > bytes_.size()) bytes_.resize(place_ + size);
        std::copy(bytes, bytes + count, bytes_.begin() + static_cast<std::ptrdiff_t>(place_));
        place_ += size;
    }
    uint64_t tellp() override { return place_; }
    void seekp(uint64_t at) override { place_ = static_cast<size_t>(at); }

    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
    size_t place_ = 0;
};

/// Numbers with blanks between, each the shortest text that reads back as the same.
template <class Number>
std::string numbers_text(std::string_view bytes) {
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    std::copy_n(bytes.data(), numbers.size() * sizeof(Number), reinterpret_cast<char*>(numbers.data()));
    return fmt::format("{}", fmt::join(numbers, " "));
}

std::string text_of(std::string_view type, std::string_view bytes) {
    static const std::set<std::string_view> floats = {"float", "floatvector", "box2f", "v2f",
                                                      "v3f",   "m33f",        "m44f",  "chromaticities"};
    static const std::set<std::string_view> doubles = {"double", "v2d", "v3d", "m33d", "m44d"};
    static const std::set<std::string_view> wholes = {"int", "box2i", "v2i", "v3i", "keycode"};
    if (type == "string") return std::string(bytes);
    if (type == "rational" && bytes.size() == 8)
        return numbers_text<int32_t>(bytes.substr(0, 4)) + "/" + numbers_text<uint32_t>(bytes.substr(4));
    if (floats.count(type) > 0) return numbers_text<float>(bytes);
    if (doubles.count(type) > 0) return numbers_text<double>(bytes);
    if (wholes.count(type) > 0) return numbers_text<int32_t>(bytes);
    constexpr size_t shown_bytes = 32;
    const std::string_view first = bytes.substr(0, shown_bytes);
    std::string text = fmt::format("{} byte{}:", bytes.size(), bytes.size() == 1 ? "" : "s");
    for (const char byte : first) text += fmt::format(" {:02x}", static_cast<unsigned char>(byte));
    return text + (bytes.size() > first.size() ? " ..." : "");
}

/// What is said elsewhere: windows, channels, names, and how the pixels are packed.
bool is_said_elsewhere(std::string_view name) {
    static const std::set<std::string_view> names = {"channels", "dataWindow",  "displayWindow",      "name",
                                                     "type",     "compression", "lineOrder",          "tiles",
                                                     "version",  "chunkCount",  "dwaCompressionLevel"};
    return names.count(name) > 0;
}

}  // namespace

std::map<std::string, StoredAttribute> exr_header_values(const Imf::Header& header) {
    std::map<std::string, StoredAttribute> values;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        if (is_said_elsewhere(entry.name())) continue;
        MemoryStream stream;
        entry.attribute().writeValueTo(stream, Imf::EXR_VERSION);
        const std::string type = entry.attribute().typeName();
        const std::string bytes = stream.take();
        values[entry.name()] = {type, bytes, text_of(type, bytes)};
    }
    return values;
}

std::map<std::string, std::string> exr_packing(const Imf::Header& header) {
    std::map<std::string, std::string> packing;
    constexpr std::pair<Imf::Compression, const char*> others[] = {
        {Imf::PXR24_COMPRESSION, "pxr24"}, {Imf::B44_COMPRESSION, "b44"}, {Imf::B44A_COMPRESSION, "b44a"}};
    const Compression compression = compression_of(header.compression());
    packing["compression"] = compression != Compression::other
                                 ? std::string(compression_names[static_cast<size_t>(compression)])
                                 : fmt::format("number {}", static_cast<int>(header.compression()));
    for (const auto& [number, name] : others)
        if (number == header.compression()) packing["compression"] = name;
    const Imf::LineOrder order = header.lineOrder();
    packing["order of lines"] = order == Imf::INCREASING_Y ? "downward" : order == Imf::DECREASING_Y ? "upward" : "any";
    packing["tiles"] = header.hasTileDescription()
                           ? fmt::format("{}x{}", header.tileDescription().xSize, header.tileDescription().ySize)
                           : "none";
    return packing;
}

Compression compression_of(Imf::Compression compression) {
    const auto found = std::find(std::begin(compressions), std::end(compressions), compression);
    return found == std::end(compressions) ? Compression::other
                                           : static_cast<Compression>(found - std::begin(compressions));
}

ExrAttributes read_attributes(const Imf::Header& header) {
    ExrAttributes attributes;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        const std::string name = entry.name();
        // Every file has these, and every part.
        if (name == "pixelAspectRatio" || (name == "screenWindowWidth" && header.screenWindowWidth() == 1)) continue;
        if (name == "name" || name == "type" || name == "chunkCount") continue;
        const Imf::Attribute& attribute = entry.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
            attributes[name] = text->value();
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
            attributes[name] = whole->value();
        } else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
            attributes[name] = number->value();
        } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
            attributes[name] = static_cast<double>(single->value());
        } else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
            attributes[name] = Ratio{ratio->value().n, ratio->value().d};
        } else if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute)) {
            attributes[name] = std::vector<float>(list->value());
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            const float* first = matrix->value().getValue();
            attributes[name] = std::vector<float>(first, first + 16);
        } else if (const auto* colors = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
            const Imf::Chromaticities& c = colors->value();
            attributes[name] =
                std::vector<float>{c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
        }
    }
    return attributes;
}

}  // namespace cistula
