#include "image/color/stated_colors.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "cistula/numerics/portable.h"
#include "image/color/color_encoding.h"
#include "image/color/tiff_tags.h"

namespace cistula {
namespace {

/// The chunks of a PNG that say something of its colors; empty: there is none.
struct PngChunks {
    std::string cicp, gama, chrm;
    bool srgb = false;
    bool profile = false;
};

PngChunks read_chunks(std::istream& file) {
    PngChunks found;
    constexpr int most_chunks = 1000;
    for (int i = 0; i < most_chunks; ++i) {
        std::string head(8, '\0');
        if (!file.read(head.data(), 8)) break;
        const std::string_view type = std::string_view(head).substr(4);
        if (type == "IDAT" || type == "IEND") break;
        const uint32_t size = big_endian(head, 0);
        std::string* const kept = type == "cICP"   ? &found.cicp
                                  : type == "gAMA" ? &found.gama
                                  : type == "cHRM" ? &found.chrm
                                                   : nullptr;
        const uint32_t right_size = type == "cHRM" ? 32 : 4;
        if (kept && size == right_size) {
            kept->resize(size);
            if (!file.read(kept->data(), size)) break;
            file.ignore(4);
        } else {
            found.srgb |= type == "sRGB";
            found.profile |= type == "iCCP";
            file.seekg(std::streamoff{size} + 4, std::ios::cur);
        }
    }
    return found;
}

/// Code points of ITU-T H.273: primaries, curve, matrix, and whether the range is full.
FileColors colors_of_cicp(std::string_view code) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(code[i]); };
    if (byte(2) == 0 && byte(3) == 1) {
        const bool rec709 = byte(0) == 1;
        const bool p3 = byte(0) == 12;
        const bool rec2020 = byte(0) == 9;
        constexpr int srgb = 13;
        constexpr int linear = 8;
        if (byte(1) == srgb && rec709) return known_colors("srgb");
        if (byte(1) == srgb && p3) return known_colors("srgb_p3d65_scene");
        if (byte(1) == linear && rec709) return known_colors("lin_rec709_scene");
        if (byte(1) == linear && p3) return known_colors("lin_p3d65_scene");
        if (byte(1) == linear && rec2020) return known_colors("lin_rec2020_scene");
    }
    return unknown_colors(fmt::format("cICP {} {} {} {}", byte(0), byte(1), byte(2), byte(3)));
}

/// Chromaticities together with what a gamma says.
FileColors with_primaries(FileColors colors, const Chromaticities& chromaticities) {
    if (!colors.profile.empty()) return colors;
    ColorSpace space;
    try {
        space = color_space_of(chromaticities);
    } catch (const std::runtime_error& problem) {
        return unknown_colors(fmt::format("cHRM: {}", problem.what()));
    }
    if (space.id == "lin_rec709_scene") return colors;
    // What is taken for sRGB's curve in other primaries is Adobe RGB's in its own.
    const Curve curve = !colors.id.empty()                 ? find_color_encoding(colors.id)->curve
                        : space.id == "lin_adobergb_scene" ? find_color_encoding("g22_adobergb_scene")->curve
                                                           : find_color_encoding("srgb")->curve;
    for (const ColorEncoding& encoding : color_encodings)
        if (encoding.space == space.id && encoding.curve == curve) return known_colors(encoding.name);
    if (!colors.id.empty()) return unknown_colors(fmt::format("{} with primaries of other spaces", colors.id));
    colors.chromaticities = chromaticities;
    return colors;
}

std::optional<FileColors> colors_of_png(std::istream& file) {
    const PngChunks chunks = read_chunks(file);
    if (!chunks.cicp.empty()) return colors_of_cicp(chunks.cicp);
    if (chunks.profile) return std::nullopt;
    if (chunks.srgb) return known_colors("srgb");
    FileColors colors;
    if (const uint32_t gamma = big_endian(chunks.gama, 0); gamma != 0) colors = colors_of_gamma(100000.0 / gamma);
    if (chunks.chrm.empty()) return colors;
    Chromaticities chromaticities;  // the file has white first
    for (size_t i = 0; i < 8; ++i)
        chromaticities[i] = static_cast<float>(big_endian(chunks.chrm, 4 * ((i + 2) % 8)) / 100000.0);
    return with_primaries(std::move(colors), chromaticities);
}

/// Whether a file is a Radiance picture that does not begin as such, which is read all the same.
bool names_radiance(std::istream& file) {
    std::string start(1 << 16, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    const std::string header = start.substr(0, start.find("\n\n"));
    return header.starts_with("FORMAT=32-bit_rle_") || header.find("\nFORMAT=32-bit_rle_") != std::string::npos;
}

/// Lines up to an empty one.
std::optional<FileColors> colors_of_radiance(std::istream& file) {
    std::string start(1 << 20, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<size_t>(file.gcount()));
    std::istringstream lines(start);
    std::optional<FileColors> colors;
    const auto stated = [&]() -> FileColors& { return colors ? *colors : colors.emplace(); };
    for (std::string line; std::getline(lines, line) && !line.empty();) {
        std::istringstream numbers(line.substr(line.find('=') + 1));
        numbers.imbue(std::locale::classic());
        if (line.starts_with("FORMAT=") && line.find("xyze") != std::string::npos) stated().profile = line;
        if (line.starts_with("PRIMARIES=")) {
            Chromaticities chromaticities;
            for (float& number : chromaticities) numbers >> number;
            if (numbers)
                stated().chromaticities = chromaticities;
            else
                stated().profile = line;
        }
        const bool is_of_all = line.starts_with("EXPOSURE=");
        if (!is_of_all && !line.starts_with("COLORCORR=")) continue;
        double factor = 1;
        for (int c = 0; c < 3; ++c) {
            if ((c == 0 || !is_of_all) && !(numbers >> factor)) factor = NAN;
            stated().factors[static_cast<size_t>(c)] *= factor;
        }
    }
    return colors;
}

}  // namespace

std::optional<FileColors> stated_colors(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string start(8, '\0');
    file.read(start.data(), 8);
    if (start == "\x89PNG\r\n\x1a\n") return colors_of_png(file);
    file.clear();
    file.seekg(0);
    const bool is_radiance = start.starts_with("#?") || names_radiance(file);
    file.clear();
    file.seekg(0);
    return is_radiance ? colors_of_radiance(file) : header_colors(file);
}

FileColors colors_of_gamma(double gamma) {
    constexpr double tolerance = 0.03;
    const auto is = [&](double known_gamma) { return magnitude(gamma - known_gamma) <= tolerance; };
    if (is(1)) return known_colors("linear");
    if (is(1.8)) return known_colors("g18_rec709_scene");
    if (is(2.4)) return known_colors("g24_rec709_scene");
    if (is(2.2)) return FileColors();
    return unknown_colors(fmt::format("gamma {:.4g}", gamma));
}

}  // namespace cistula
