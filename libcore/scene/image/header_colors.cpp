#include "scene/image/header_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

#include "scene/image/file_numbers.h"
#include "scene/image/icc_profile.h"
#include "scene/image/stated_colors.h"

namespace cistula {
namespace {

using Numbers = FileNumbers;

/// A list of `count` numbers of a tag's RATIONAL or FLOAT; empty if it has another type or length.
std::vector<double> tag_values(const Numbers& file, uint64_t entry, bool is_big, uint64_t count) {
    constexpr uint64_t rational = 5, single = 11;
    const uint64_t type = file.at(entry + 2, 2), stated = file.at(entry + 4, is_big ? 8 : 4);
    if ((type != rational && type != single) || stated != count) return {};
    const uint64_t first = is_big ? file.at(entry + 12, 8) : file.at(entry + 8, 4);
    std::vector<double> values;
    for (uint64_t i = 0; i < count; ++i) {
        if (type == single) {
            const auto bits = static_cast<uint32_t>(file.at(first + 4 * i, 4));
            values.push_back(static_cast<double>(std::bit_cast<float>(bits)));
        } else {
            const uint64_t over = file.at(first + 8 * i, 4), under = file.at(first + 8 * i + 4, 4);
            values.push_back(static_cast<double>(over) / static_cast<double>(under));
        }
    }
    return values;
}

std::optional<FileColors> colors_of_tiff(const Numbers& file) {
    constexpr uint64_t white_point = 318, primaries = 319, profile = 34675, most_entries = 4096;
    const bool is_big = file.at(2, 2) == 43;
    const uint64_t directory = is_big ? file.at(8, 8) : file.at(4, 4), entries = file.at(directory, is_big ? 8 : 2);
    std::vector<double> white, colors;
    for (uint64_t i = 0; i < std::min(entries, most_entries); ++i) {
        const uint64_t entry = directory + (is_big ? 8 + 20 * i : 2 + 12 * i);
        const uint64_t tag = file.at(entry, 2);
        if (tag == profile) return std::nullopt;
        if (tag == white_point) white = tag_values(file, entry, is_big, 2);
        if (tag == primaries) colors = tag_values(file, entry, is_big, 6);
    }
    if (colors.empty()) return std::nullopt;
    if (white.empty()) return unknown_colors("PrimaryChromaticities without a WhitePoint");
    FileColors stated;
    stated.chromaticities.emplace();
    for (size_t i = 0; i < 8; ++i) (*stated.chromaticities)[i] = static_cast<float>(i < 6 ? colors[i] : white[i - 6]);
    return stated;
}

std::optional<FileColors> colors_of_webp(const Numbers& file) {
    constexpr uint64_t most_chunks = 1000, largest_profile = 16 << 20;
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

std::optional<FileColors> colors_of_dpx(const Numbers& file) {
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
    const Numbers numbers(file, true);
    const auto end = static_cast<uint64_t>(size - footer);
    if (numbers.text(end + 8, 16) != "TRUEVISION-XFILE") return std::nullopt;
    const uint64_t extension = numbers.at(end, 4);
    if (extension == 0 || numbers.at(extension, 2) < 482) return std::nullopt;
    const uint64_t over = numbers.at(extension + 478, 2), under = numbers.at(extension + 480, 2);
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
    const std::string start = Numbers(file, false).text(0, 12);
    const std::string_view magic = std::string_view(start).substr(0, 4);
    const Numbers little(file, true), big(file, false);
    if (magic == "II*\0"sv || magic == "II+\0"sv) return colors_of_tiff(little);
    if (magic == "MM\0*"sv || magic == "MM\0+"sv) return colors_of_tiff(big);
    if (magic == "RIFF"sv && start.substr(8) == "WEBP") return colors_of_webp(little);
    if (magic == "SDPX"sv || magic == "XPDS"sv) return colors_of_dpx(big);  // it is a byte
    if (magic == "\x80\x2a\x5f\xd7"sv || magic == "\xd7\x5f\x2a\x80"sv)
        return unknown_colors("Cineon's printing density");
    return colors_of_tga(file);
}

}  // namespace cistula
