#include "scene/film/color_space.h"

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace cistula {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr ColorSpace spaces[] = {
    {"lin_rec709_scene", {0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}},
    {"lin_ap1_scene", {0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}},
    {"lin_ap0_scene", {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}},
    {"lin_rec2020_scene", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}},
};

/// XYZ of a chromaticity, Y = 1.
dvec3 xyz_of(const double (&xy)[2]) {
    return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]};
}

/// RGB to XYZ, with Y = 1 for white (SMPTE RP 177).
dmat3 xyz_from(const ColorSpace& space) {
    const auto primary = [](const double(&xy)[2]) { return dvec3(xy[0], xy[1], 1 - xy[0] - xy[1]); };
    const dmat3 primaries(primary(space.red), primary(space.green), primary(space.blue));
    const dvec3 amounts = glm::inverse(primaries) * xyz_of(space.white);
    return {primaries[0] * amounts[0], primaries[1] * amounts[1], primaries[2] * amounts[2]};
}

dmat3 adaptation(const double (&from)[2], const double (&to)[2]) {
    // Columns; cone responses of Bradford's model.
    const dmat3 cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);
    const dvec3 source = cones * xyz_of(from), target = cones * xyz_of(to);
    dmat3 gains(0.0);
    for (int i = 0; i < 3; ++i) gains[i][i] = target[i] / source[i];
    return glm::inverse(cones) * gains * cones;
}

}  // namespace

std::span<const ColorSpace> color_spaces() {
    return spaces;
}

const ColorSpace* find_color_space(std::string_view id) {
    const auto found = std::find_if(std::begin(spaces), std::end(spaces), [&](const auto& s) { return s.id == id; });
    return found == std::end(spaces) ? nullptr : found;
}

dmat3 color_matrix(const ColorSpace& from, const ColorSpace& to) {
    return glm::inverse(xyz_from(to)) * adaptation(from.white, to.white) * xyz_from(from);
}

}  // namespace cistula
