#include "scene/description/platonic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "cistula/numerics/vec.h"
#include "scene/description/rotation.h"

namespace cistula {
namespace {

constexpr double ulps = 4e-16;

class Platonic : public ::testing::TestWithParam<int> {
  protected:
    const Polyhedron& shape() const { return platonic_shape(static_cast<PlatonicSolid>(GetParam())); }
};

struct Numbers {
    size_t vertices, edges, faces, planes, sides;
    double inradius;
};
const Numbers numbers[] = {{4, 6, 4, 4, 3, 1.0 / 3},
                           {8, 12, 6, 3, 4, 0.57735026918962576451},
                           {6, 12, 8, 4, 3, 0.57735026918962576451},
                           {20, 30, 12, 6, 5, 0.79465447229176612296},
                           {12, 30, 20, 10, 3, 0.79465447229176612296}};

TEST_P(Platonic, HasItsNumbersOfVerticesEdgesAndFaces) {
    const Numbers& n = numbers[GetParam()];
    EXPECT_EQ(shape().vertices.size(), n.vertices);
    EXPECT_EQ(shape().edges.size(), n.edges);
    EXPECT_EQ(shape().faces.size(), n.faces);
    EXPECT_EQ(shape().planes.size(), n.planes);
    EXPECT_NEAR(shape().inradius, n.inradius, ulps);
    for (const auto& face : shape().faces) EXPECT_EQ(face.vertices.size(), n.sides);
}

TEST_P(Platonic, CircumradiusIsOne) {
    for (const auto& p : shape().vertices) EXPECT_NEAR(length(p), 1, ulps);
}

TEST_P(Platonic, EdgesAreEquallyLongAndDistinct) {
    std::set<std::array<uint32_t, 2>> distinct;
    const auto side = [&](const auto& e) {
        return length(shape().vertices[e.vertices[0]] - shape().vertices[e.vertices[1]]);
    };
    for (const auto& edge : shape().edges) {
        EXPECT_NEAR(side(edge), side(shape().edges[0]), ulps);
        EXPECT_LT(edge.vertices[0], edge.vertices[1]);
        distinct.insert(edge.vertices);
    }
    EXPECT_EQ(distinct.size(), shape().edges.size());
}

TEST_P(Platonic, EveryEdgeJoinsTwoFacesInOppositeDirections) {
    std::map<std::array<uint32_t, 2>, uint32_t> directed;
    for (const auto& face : shape().faces)
        for (size_t i = 0; i < face.vertices.size(); ++i)
            EXPECT_TRUE(
                directed.insert({{face.vertices[i], face.vertices[(i + 1) % face.vertices.size()]}, face.id}).second);
    EXPECT_EQ(directed.size(), 2 * shape().edges.size());
    for (const auto& edge : shape().edges) {
        std::array<uint32_t, 2> faces = {directed.at({edge.vertices[0], edge.vertices[1]}),
                                         directed.at({edge.vertices[1], edge.vertices[0]})};
        std::sort(faces.begin(), faces.end());
        EXPECT_EQ(faces, edge.faces);
    }
}

TEST_P(Platonic, FacesAreCounterClockwiseSeenFromOutside) {
    for (const auto& face : shape().faces) {
        glm::dvec3 sum{0};
        for (size_t i = 0; i < face.vertices.size(); ++i)
            sum += cross(shape().vertices[face.vertices[i]],
                         shape().vertices[face.vertices[(i + 1) % face.vertices.size()]]);
        EXPECT_NEAR(dot(normalized(sum), face.normal), 1, ulps);
    }
}

TEST_P(Platonic, PlanesHoldTheirFacesAndNothingIsBeyond) {
    for (const auto& face : shape().faces) {
        const auto& planes = shape().planes[face.id / 2];
        EXPECT_EQ(face.normal, face.id % 2 ? planes.normal : -planes.normal);
        EXPECT_NEAR(length(planes.normal), 1, ulps);
        EXPECT_EQ(planes.low == -INFINITY, GetParam() == 0);
        for (uint32_t i = 0; i < shape().vertices.size(); ++i) {
            const double distance = dot(face.normal, shape().vertices[i]);
            const bool on = std::count(face.vertices.begin(), face.vertices.end(), i) > 0;
            EXPECT_LT(distance, shape().inradius + (on ? ulps : -0.1));
            if (on) {
                EXPECT_NEAR(distance, shape().inradius, ulps);
            }
        }
    }
}

TEST_P(Platonic, TrianglesFillTheVolume) {
    double volume = 0;
    for (const auto& t : triangulated(shape()))
        volume += dot(shape().vertices[t[0]], cross(shape().vertices[t[1]], shape().vertices[t[2]])) / 6;
    const double known[] = {8 / (9 * std::sqrt(3.0)), 8 / (3 * std::sqrt(3.0)), 4.0 / 3, 2.7851638631226250,
                            2.5361507101204093};
    EXPECT_NEAR(volume, known[GetParam()], 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Solids, Platonic, ::testing::Range(0, 5), [](const auto& solid) {
    return std::string(platonic_name(static_cast<PlatonicSolid>(solid.param)));
});

TEST(PlatonicOrientation, OctahedronsVerticesLieOnTheAxes) {
    for (const auto& p : platonic_shape(PlatonicSolid::octahedron).vertices)
        EXPECT_EQ(std::abs(p.x) + std::abs(p.y) + std::abs(p.z), 1);
}

TEST(Rotation, RightAnglesAreExact) {
    EXPECT_EQ(Rotation({90, 0, 0})({1, 2, 3}), glm::dvec3(1, -3, 2));
    EXPECT_EQ(Rotation({0, 90, 0})({1, 2, 3}), glm::dvec3(3, 2, -1));
    EXPECT_EQ(Rotation({0, 0, 90})({1, 2, 3}), glm::dvec3(-2, 1, 3));
    EXPECT_EQ(Rotation({-270, 360, 720})({1, 2, 3}), glm::dvec3(1, -3, 2));
    EXPECT_EQ(Rotation({90, 90, 0})({1, 2, 3}), Rotation({0, 90, 0})(Rotation({90, 0, 0})({1, 2, 3})));
}

TEST(Rotation, OtherAnglesAgreeWithTheLibrary) {
    for (double degrees = -1000; degrees < 1000; degrees += 7.3) {
        const SineCosine sc = sine_cosine_of_degrees(degrees);
        EXPECT_NEAR(sc.sine, std::sin(degrees * M_PI / 180), 1e-14);
        EXPECT_NEAR(sc.cosine, std::cos(degrees * M_PI / 180), 1e-14);
    }
}

}  // namespace
}  // namespace cistula
