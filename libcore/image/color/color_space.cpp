#include "image/color/color_space.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <stdexcept>

#include "cistula/numerics/real.h"

namespace cistula {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr ColorSpace spaces[] = {
    {"lin_rec709_scene", {0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}},
    {"lin_ap1_scene", {0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}},
    {"lin_ap0_scene", {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}},
    {"lin_rec2020_scene", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}},
    {"lin_p3d65_scene", {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}},
    {"lin_adobergb_scene", {0.640, 0.330}, {0.210, 0.710}, {0.150, 0.060}, {0.3127, 0.3290}},
};

/// Bradford's cone responses; columns.
const dmat3 cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);

/// XYZ of a chromaticity, Y = 1.
dvec3 xyz_of(const double (&xy)[2]) {
    return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]};
}

dmat3 primaries_of(const ColorSpace& space) {
    const auto primary = [](const double(&xy)[2]) { return dvec3(xy[0], xy[1], 1 - xy[0] - xy[1]); };
    return {primary(space.red), primary(space.green), primary(space.blue)};
}

/// How much of each primary makes white.
dvec3 amounts_of(const ColorSpace& space) {
    return glm::inverse(primaries_of(space)) * xyz_of(space.white);
}

/// RGB to XYZ, with Y = 1 for white (SMPTE RP 177).
dmat3 xyz_from(const ColorSpace& space) {
    const dmat3 primaries = primaries_of(space);
    const dvec3 amounts = amounts_of(space);
    return {primaries[0] * amounts[0], primaries[1] * amounts[1], primaries[2] * amounts[2]};
}

dmat3 adaptation(const double (&from)[2], const double (&to)[2]) {
    const dvec3 source = cones * xyz_of(from);
    const dvec3 target = cones * xyz_of(to);
    dmat3 gains(0.0);
    for (int i = 0; i < 3; ++i) gains[i][i] = target[i] / source[i];
    return glm::inverse(cones) * gains * cones;
}

bool all_positive(const dvec3& v) {
    return v.x > 0 && v.y > 0 && v.z > 0;
}

/// Whether matrices can be made of the numbers. Those of cameras' spaces are within 2, and their triangles larger than
/// 0.05.
bool makes_sense(const ColorSpace& space) {
    constexpr double most = 10;
    constexpr double least_area = 1e-4;
    for (const auto* xy : {space.red, space.green, space.blue, space.white})
        for (int i = 0; i < 2; ++i)
            if (!(magnitude(xy[i]) <= most)) return false;
    return space.white[1] > 0 && magnitude(glm::determinant(primaries_of(space))) >= 2 * least_area &&
           all_positive(amounts_of(space)) && all_positive(cones * xyz_of(space.white));
}

bool is_near(const ColorSpace& a, const ColorSpace& b) {
    constexpr double tolerance = 0.001;
    const auto near = [](const double(&p)[2], const double(&q)[2]) {
        return magnitude(p[0] - q[0]) <= tolerance && magnitude(p[1] - q[1]) <= tolerance;
    };
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

}  // namespace

std::span<const ColorSpace> color_spaces() {
    return spaces;
}

const ColorSpace* find_color_space(std::string_view id) {
    const auto found = std::find_if(std::begin(spaces), std::end(spaces), [&](const auto& s) { return s.id == id; });
    return found == std::end(spaces) ? nullptr : found;
}

ColorSpace color_space_of(const Chromaticities& c) {
    const ColorSpace space = {"", {c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}};
    if (!makes_sense(space))
        throw std::runtime_error(
            "its chromaticities are no color space: white must lie inside the triangle of red, green and blue");
    const auto known =
        std::find_if(std::begin(spaces), std::end(spaces), [&](const auto& s) { return is_near(s, space); });
    return known == std::end(spaces) ? space : *known;
}

dmat3 color_matrix(const ColorSpace& from, const ColorSpace& to) {
    return glm::inverse(xyz_from(to)) * adaptation(from.white, to.white) * xyz_from(from);
}

dmat3 profile_colorants(const ColorSpace& space) {
    constexpr double d50[2] = {0.9642 / (0.9642 + 1 + 0.8249), 1 / (0.9642 + 1 + 0.8249)};  // ICC.1:2022, 7.2.16
    return adaptation(space.white, d50) * xyz_from(space);
}

dvec3 luminance_weights(const ColorSpace& space) {
    const dmat3 xyz = xyz_from(space);
    return {xyz[0][1], xyz[1][1], xyz[2][1]};
}

}  // namespace cistula
