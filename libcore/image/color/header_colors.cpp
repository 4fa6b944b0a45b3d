#include "image/color/stated_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

#include "image/color/tiff_tags.h"

namespace cistula {
namespace {

/// The values of a tag of `count` numbers, RATIONAL or FLOAT; empty if there is none, or of another type or length.
std::vector<double> tag_values(const FileNumbers& file, uint64_t number, uint64_t count) {
    const std::optional<TiffTag> tag = find_tiff_tag(file, number);
    if (!tag || (tag->type != TiffTag::rational && tag->type != TiffTag::single) || tag->count != count) return {};
    std::vector<double> values;
    for (uint64_t place = tag->values; values.size() < count; place += tag->size) {
        if (tag->type == TiffTag::single)
            values.push_back(std::bit_cast<float>(static_cast<uint32_t>(file.at(place, 4))));
        else
            values.push_back(static_cast<double>(file.at(place, 4)) / static_cast<double>(file.at(place + 4, 4)));
    }
    return values;
}

std::optional<FileColors> colors_of_tiff(const FileNumbers& file) {
    constexpr uint64_t white_point = 318;
    constexpr uint64_t primaries = 319;
    constexpr uint64_t profile = 34675;
    const std::vector<double> colors = tag_values(file, primaries, 6);
    const std::vector<double> white = tag_values(file, white_point, 2);
    if (colors.empty() || find_tiff_tag(file, profile)) return std::nullopt;
    if (white.empty()) return unknown_colors("PrimaryChromaticities without a WhitePoint");
    FileColors stated;
    stated.chromaticities.emplace();
    for (size_t i = 0; i < 8; ++i) (*stated.chromaticities)[i] = static_cast<float>(i < 6 ? colors[i] : white[i - 6]);
    return stated;
}

std::optional<FileColors> colors_of_webp(const FileNumbers& file) {
    constexpr uint64_t most_chunks = 1000;
    constexpr uint64_t largest_profile = 16 << 20;
    uint64_t place = 12;
    for (uint64_t i = 0; i < most_chunks; ++i) {
        const std::string type = file.text(place, 4);
        const uint64_t size = file.at(place + 4, 4);
        if (type == "ICCP")
            return size > largest_profile ? unknown_colors(fmt::format("an ICC profile of {} bytes", size))
                                          : colors_of_profile(file.text(place + 8, size));
        if (type[0] == '\0') break;
        place += 8 + size + size % 2;
    }
    return std::nullopt;
}

std::optional<FileColors> colors_of_dpx(const FileNumbers& file) {
    constexpr const char* names[] = {"user defined",
                                     "printing density",
                                     "linear",
                                     "logarithmic",
                                     "unspecified video",
                                     "SMPTE 274M",
                                     "ITU-R 709-4",
                                     "ITU-R 601-5 B or G",
                                     "ITU-R 601-5 M",
                                     "NTSC",
                                     "PAL",
                                     "Z linear",
                                     "Z homogeneous"};
    const uint64_t transfer = file.at(801, 1);
    if (transfer == 2) return known_colors("linear");
    if (transfer == 0 || transfer == 4 || transfer >= std::size(names)) return std::nullopt;
    return unknown_colors(fmt::format("transfer characteristic {}", names[transfer]));
}

std::optional<FileColors> colors_of_tga(std::istream& file) {
    constexpr std::streamoff footer = 26;
    file.clear();
    file.seekg(0, std::ios::end);
    const std::streamoff size = file.tellg();
    if (size < footer) return std::nullopt;
    const FileNumbers numbers(file, true);
    const auto end = static_cast<uint64_t>(size - footer);
    if (numbers.text(end + 8, 16) != "TRUEVISION-XFILE") return std::nullopt;
    const uint64_t extension = numbers.at(end, 4);
    if (extension == 0 || numbers.at(extension, 2) < 482) return std::nullopt;
    const uint64_t over = numbers.at(extension + 478, 2);
    const uint64_t under = numbers.at(extension + 480, 2);
    if (over == 0 || under == 0) return std::nullopt;
    return colors_of_gamma(static_cast<double>(over) / static_cast<double>(under));
}

}  // namespace

FileColors unknown_colors(std::string name) {
    FileColors colors;
    colors.profile = std::move(name);
    return colors;
}

FileColors known_colors(std::string_view id) {
    FileColors colors;
    colors.id = id;
    return colors;
}

std::optional<FileColors> header_colors(std::istream& file) {
    using namespace std::string_view_literals;
    const std::string start = FileNumbers(file, false).text(0, 12);
    const std::string_view magic = std::string_view(start).substr(0, 4);
    const FileNumbers little(file, true), big(file, false);
    if (magic == "II*\0"sv || magic == "II+\0"sv) return colors_of_tiff(little);
    if (magic == "MM\0*"sv || magic == "MM\0+"sv) return colors_of_tiff(big);
    if (magic == "RIFF"sv && start.substr(8) == "WEBP") return colors_of_webp(little);
    if (magic == "SDPX"sv || magic == "XPDS"sv) return colors_of_dpx(big);  // it is a byte
    if (magic == "\x80\x2a\x5f\xd7"sv || magic == "\xd7\x5f\x2a\x80"sv)
        return unknown_colors("Cineon's printing density");
    return colors_of_tga(file);
}

}  // namespace cistula
