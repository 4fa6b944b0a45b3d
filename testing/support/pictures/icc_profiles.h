// ICC profiles made in memory, of a matrix and curves.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "image/color/color_encoding.h"
#include "testing/support/byte_order.h"

namespace cistula::test {

/// s15Fixed16Number.
inline std::string fixed_number(double value) {
    return big_endian(static_cast<uint32_t>(static_cast<int32_t>(std::lround(value * 65536))), 4);
}

/// A parametricCurveType of a kind of 0 to 4.
inline std::string parametric_curve(uint32_t kind, const std::vector<double>& parameters) {
    std::string text = "para" + big_endian(0, 4) + big_endian(kind, 2) + big_endian(0, 2);
    for (const double value : parameters) text += fixed_number(value);
    return text;
}

/// A curveType of one gamma, in 256ths.
inline std::string gamma_curve(uint32_t gamma) {
    return "curv" + big_endian(0, 4) + big_endian(1, 4) + big_endian(gamma, 2);
}

/// A curveType of so many places of a curve.
inline std::string sampled_curve(Curve curve, uint32_t count) {
    std::string text = "curv" + big_endian(0, 4) + big_endian(count, 4);
    for (uint32_t i = 0; i < count; ++i)
        text += big_endian(static_cast<uint32_t>(std::lround(65535 * curve(i / double(count - 1)))), 2);
    return text;
}

/// A description as version 2 has it, or in UTF-16 as version 4.
inline std::string description_2(const std::string& name) {
    return "desc" + big_endian(0, 4) + big_endian(static_cast<uint32_t>(name.size()) + 1, 4) + name + '\0';
}
inline std::string description_4(const std::string& name) {
    std::string text = "mluc" + big_endian(0, 4) + big_endian(1, 4) + big_endian(12, 4) + "enUS" +
                       big_endian(2 * static_cast<uint32_t>(name.size()), 4) + big_endian(28, 4);
    for (const char c : name) text += std::string(1, '\0') + c;
    return text;
}

using ProfileTags = std::vector<std::pair<std::string, std::string>>;

/// A profile of these tags, for pictures of a kind ("RGB ", "GRAY", "CMYK").
inline std::string icc_profile(const std::string& kind, const ProfileTags& tags) {
    std::string table = big_endian(static_cast<uint32_t>(tags.size()), 4), elements;
    const size_t first = 128 + 4 + 12 * tags.size();
    for (const auto& [signature, element] : tags) {
        table += signature + big_endian(static_cast<uint32_t>(first + elements.size()), 4) +
                 big_endian(static_cast<uint32_t>(element.size()), 4);
        elements += element + std::string((4 - element.size() % 4) % 4, '\0');
    }
    std::string header(128, '\0');
    header.replace(0, 4, big_endian(static_cast<uint32_t>(first + elements.size()), 4));
    header.replace(8, 4, big_endian(0x02400000, 4));
    header.replace(12, 12, "mntr" + kind + "XYZ ");
    header.replace(36, 4, "acsp");
    header.replace(68, 12, big_endian(0xf6d6, 4) + big_endian(0x10000, 4) + big_endian(0xd32d, 4));  // D50
    return header + table + elements;
}

/// The tags of a space's colorants, and one curve for all three.
inline ProfileTags matrix_tags(const ColorSpace& space, const std::string& curve, const std::string& name) {
    const glm::dmat3 colorants = profile_colorants(space);
    ProfileTags tags = {{"desc", description_2(name)}};
    const char* const letters[] = {"r", "g", "b"};
    for (int i = 0; i < 3; ++i) {
        std::string xyz = "XYZ " + big_endian(0, 4);
        for (int k = 0; k < 3; ++k) xyz += fixed_number(colorants[i][k]);
        tags.push_back({std::string(letters[i]) + "XYZ", xyz});
        tags.push_back({std::string(letters[i]) + "TRC", curve});
    }
    return tags;
}

}  // namespace cistula::test
