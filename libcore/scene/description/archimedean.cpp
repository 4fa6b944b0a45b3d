#include <cmath>

#include "scene/description/polyhedron.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The signs that coordinates take, by the number of those that are negative.
enum class Signs { all, even, odd };

/// Adds the cyclic permutations of a point's coordinates, with the swapped ones all six, with these signs. Each point
/// is there once.
void add_permuted(std::vector<dvec3>& points, const dvec3& p, bool swapped, Signs taken) {
    for (int order = 0; order < (swapped ? 6 : 3); ++order) {
        const dvec3 turned(p[order % 3], p[(order % 3 + (order < 3 ? 1 : 2)) % 3],
                           p[(order % 3 + (order < 3 ? 2 : 1)) % 3]);
        for (int signs = 0; signs < 8; ++signs) {
            dvec3 point = turned;
            bool odd = false;
            for (int axis = 0; axis < 3; ++axis)
                if (signs >> axis & 1) point[axis] = 0 - point[axis], odd = !odd;
            if (taken != Signs::all && odd != (taken == Signs::odd)) continue;
            if (std::find(points.begin(), points.end(), point) == points.end()) points.push_back(point);
        }
    }
}

/// Corners by the coordinates that Coxeter's and Conway's tables have, in any size.
std::vector<dvec3> archimedean_corners(std::string_view name) {
    const double root = std::sqrt(2.0);
    const double g = (1 + std::sqrt(5.0)) / 2;  // golden ratio
    constexpr double t = 1.8392867552141612;    // tribonacci constant: t^3 = t^2 + t + 1
    constexpr double x = 1.7155614996973678;    // x^3 - 2 x = g
    std::vector<dvec3> points;
    const auto swapped = [&](double a, double b, double c, Signs signs = Signs::all) {
        add_permuted(points, {a, b, c}, true, signs);
    };
    const auto cyclic = [&](double a, double b, double c, Signs signs = Signs::all) {
        add_permuted(points, {a, b, c}, false, signs);
    };
    if (name == "truncated-tetrahedron") swapped(1, 1, 3, Signs::even);
    if (name == "cuboctahedron") swapped(0, 1, 1);
    if (name == "truncated-cube") swapped(root - 1, 1, 1);
    if (name == "truncated-octahedron") swapped(0, 1, 2);
    if (name == "rhombicuboctahedron") swapped(1, 1, 1 + root);
    if (name == "truncated-cuboctahedron") swapped(1, 1 + root, 1 + 2 * root);
    if (name == "snub-cube") cyclic(1, 1 / t, t, Signs::odd), cyclic(1, t, 1 / t, Signs::even);
    if (name == "icosidodecahedron") cyclic(0, 0, 2 * g), cyclic(1, g, g * g);
    if (name == "truncated-dodecahedron") cyclic(0, 1 / g, 2 + g), cyclic(1 / g, g, 2 * g), cyclic(g, 2, g + 1);
    if (name == "truncated-icosahedron") cyclic(0, 1, 3 * g), cyclic(1, 2 + g, 2 * g), cyclic(g, 2, 2 * g + 1);
    if (name == "rhombicosidodecahedron") cyclic(1, 1, g * g * g), cyclic(g * g, g, 2 * g), cyclic(2 + g, 0, g * g);
    if (name == "truncated-icosidodecahedron") {
        cyclic(1 / g, 1 / g, 3 + g), cyclic(2 / g, g, 1 + 2 * g), cyclic(1 / g, g * g, 3 * g - 1);
        cyclic(2 * g - 1, 2, 2 + g), cyclic(g, 3, 2 * g);
    }
    if (name == "snub-dodecahedron") {
        const double a = x - 1 / x;
        const double b = x * g + g * g + g / x;
        cyclic(2 * a, 2, 2 * b, Signs::odd);
        cyclic(a + b / g + g, -a * g + b + 1 / g, a / g + b * g - 1, Signs::odd);
        cyclic(a + b / g - g, a * g - b + 1 / g, a / g + b * g + 1, Signs::odd);
        cyclic(-a / g + b * g + 1, -a + b / g - g, a * g + b - 1 / g, Signs::odd);
        cyclic(-a / g + b * g - 1, a - b / g - g, a * g + b + 1 / g, Signs::odd);
    }
    return points;
}

}  // namespace

std::shared_ptr<const Polyhedron> archimedean_body(std::string_view name) {
    std::vector<dvec3> corners = archimedean_corners(name);
    for (dvec3& p : corners) p = normalized(p);
    auto body = std::make_shared<Polyhedron>(hull_of(name, corners));
    body->half_unit = 0;  // by formula
    return body;
}

}  // namespace cistula
