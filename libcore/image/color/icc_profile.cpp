#include "image/color/stated_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cistula/numerics/elementary.h"
#include "cistula/numerics/real.h"
#include "image/color/color_encoding.h"
#include "image/color/tiff_tags.h"

namespace cistula {
namespace {

constexpr double light_tolerance = 0.002;
constexpr double xyz_tolerance = 0.002;
constexpr size_t header_bytes = 128;
constexpr size_t tag_bytes = 12;

/// Big-endian numbers of a part of a profile; zeros beyond its end.
class ProfileBytes {
  public:
    explicit ProfileBytes(std::string_view bytes) : bytes_(bytes) {}

    size_t size() const { return bytes_.size(); }
    std::string_view text(size_t at, size_t size) const {
        return at < bytes_.size() ? bytes_.substr(at, size) : std::string_view();
    }
    uint32_t unsigned_number(size_t at, size_t size) const { return big_endian(bytes_, at, size); }
    /// s15Fixed16Number.
    double fixed(size_t at) const { return static_cast<int32_t>(unsigned_number(at, 4)) / 65536.0; }

  private:
    std::string_view bytes_;
};

/// The element of a tag; empty: there is none, or not within the profile.
ProfileBytes tag(std::string_view profile, std::string_view signature) {
    const ProfileBytes whole(profile);
    const size_t room = profile.size() < header_bytes + 4 ? 0 : (profile.size() - header_bytes - 4) / tag_bytes;
    const size_t count = std::min<size_t>(whole.unsigned_number(header_bytes, 4), room);
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = header_bytes + 4 + tag_bytes * i;
        if (whole.text(entry, 4) != signature) continue;
        const size_t offset = whole.unsigned_number(entry + 4, 4);
        const size_t size = whole.unsigned_number(entry + 8, 4);
        if (offset > profile.size() || size > profile.size() - offset) break;
        return ProfileBytes(profile.substr(offset, size));
    }
    return ProfileBytes({});
}

/// Light for a number of 0 to 1 by a curveType or a parametricCurveType; not a number for anything else.
double light_of(const ProfileBytes& curve, double x) {
    if (curve.text(0, 4) == "curv") {
        const size_t count = curve.unsigned_number(8, 4);
        if (count == 0) return x;
        if (count > (curve.size() - std::min<size_t>(curve.size(), 12)) / 2) return elementary::not_a_number;
        if (count == 1) return elementary::pow(x, curve.unsigned_number(12, 2) / 256.0);
        const double place = x * static_cast<double>(count - 1);
        const size_t first = std::min(static_cast<size_t>(place), count - 2);
        const double low = curve.unsigned_number(12 + 2 * first, 2);
        const double high = curve.unsigned_number(14 + 2 * first, 2);
        return (low + (high - low) * (place - static_cast<double>(first))) / 65535;
    }
    constexpr size_t parameters[] = {1, 3, 4, 5, 7};
    const uint32_t kind = curve.unsigned_number(8, 2);
    if (curve.text(0, 4) != "para" || kind >= std::size(parameters) || curve.size() < 12 + 4 * parameters[kind])
        return elementary::not_a_number;
    const auto p = [&](size_t i) { return curve.fixed(12 + 4 * i); };
    const double g = p(0);
    if (kind == 0) return elementary::pow(x, g);
    const double base = p(1) * x + p(2);
    if (kind == 1) return base >= 0 ? elementary::pow(base, g) : 0;
    if (kind == 2) return base >= 0 ? elementary::pow(base, g) + p(3) : p(3);
    if (kind == 3) return x >= p(4) ? elementary::pow(base, g) : p(3) * x;
    return x >= p(4) ? elementary::pow(base, g) + p(5) : p(3) * x + p(6);
}

bool is_curve(const ProfileBytes& curve, Curve wanted) {
    constexpr int steps = 64;
    for (int i = 0; i <= steps; ++i) {
        const double x = static_cast<double>(i) / steps;
        if (!(magnitude(light_of(curve, x) - wanted(x)) <= light_tolerance)) return false;
    }
    return true;
}

/// Whether the profile's colorants are those of a space.
bool has_primaries(std::string_view profile, const ColorSpace& space) {
    const glm::dmat3 expected = profile_colorants(space);
    const char* const names[] = {"rXYZ", "gXYZ", "bXYZ"};
    for (int i = 0; i < 3; ++i) {
        const ProfileBytes xyz = tag(profile, names[i]);
        if (xyz.text(0, 4) != "XYZ " || xyz.size() < 20) return false;
        for (int k = 0; k < 3; ++k)
            if (!(magnitude(xyz.fixed(8 + 4 * static_cast<size_t>(k)) - expected[i][k]) <= xyz_tolerance)) return false;
    }
    return true;
}

/// The encoding that the profile is; null: none.
const ColorEncoding* encoding_of_profile(std::string_view profile) {
    const ProfileBytes whole(profile);
    if (whole.text(36, 4) != "acsp") return nullptr;
    for (const char* table : {"A2B0", "A2B1", "A2B2", "D2B0", "D2B1"})  // which come before a matrix
        if (tag(profile, table).size() != 0) return nullptr;
    std::vector<ProfileBytes> curves;
    const bool is_gray = whole.text(16, 4) == "GRAY";
    if (is_gray)
        curves = {tag(profile, "kTRC")};
    else if (whole.text(16, 4) == "RGB " && whole.text(20, 4) == "XYZ ")
        curves = {tag(profile, "rTRC"), tag(profile, "gTRC"), tag(profile, "bTRC")};
    if (curves.empty()) return nullptr;
    for (const ColorEncoding& encoding : color_encodings)
        if ((is_gray || has_primaries(profile, *find_color_space(encoding.space))) &&
            std::all_of(curves.begin(), curves.end(),
                        [&](const ProfileBytes& curve) { return is_curve(curve, encoding.curve); }))
            return &encoding;
    return nullptr;
}

/// The profile's description, in ASCII.
std::string profile_name(std::string_view profile) {
    const ProfileBytes description = tag(profile, "desc");
    std::string name;
    if (description.text(0, 4) == "desc") {
        name = description.text(12, description.unsigned_number(8, 4));
        name.resize(std::min(name.find('\0'), name.size()));
    } else if (description.text(0, 4) == "mluc") {
        const size_t size = description.unsigned_number(20, 4);
        const size_t offset = description.unsigned_number(24, 4);
        for (size_t i = 0; i + 1 < size && offset + i + 1 < description.size(); i += 2) {
            const uint32_t code = description.unsigned_number(offset + i, 2);
            name += code < 0x80 ? static_cast<char>(code) : '?';
        }
    }
    constexpr size_t longest = 80;
    return name.empty() ? "without a name" : name.substr(0, longest);
}

}  // namespace

FileColors colors_of_profile(std::string_view bytes) {
    FileColors colors;
    if (const ColorEncoding* encoding = encoding_of_profile(bytes))
        colors.id = encoding->name;
    else
        colors.profile = profile_name(bytes);
    return colors;
}

}  // namespace cistula
