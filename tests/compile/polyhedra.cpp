// Convex bodies of names, planes and points: what they are made of, and what is refused.
#include "scene/description/polyhedron.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "testing/support/expect_error.h"
#include "testing/support/scene.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Expects faces with their corners in their planes and all others behind, and edges that close the body.
void expect_sound(const Polyhedron& body, double off = 4e-15) {
    SCOPED_TRACE(body.name);
    EXPECT_EQ(body.vertices.size() + body.faces.size(), body.edges.size() + 2);
    uint32_t last = 0;
    for (const auto& face : body.faces) {
        const auto& planes = body.planes[face.id / 2];
        EXPECT_TRUE(&face == body.faces.data() || face.id > last);
        last = face.id;
        EXPECT_EQ(face.normal, face.id % 2 ? planes.normal : -planes.normal);
        const double offset = face.id % 2 ? planes.high : -planes.low;
        dvec3 area(0);
        for (size_t i = 0; i < face.vertices.size(); ++i)
            area +=
                cross(body.vertices[face.vertices[i]], body.vertices[face.vertices[(i + 1) % face.vertices.size()]]);
        EXPECT_GT(dot(normalized(area), face.normal), 1 - 1e-12);
        for (uint32_t i = 0; i < body.vertices.size(); ++i) {
            const double beyond = dot(face.normal, body.vertices[i]) - offset;
            const bool on = std::count(face.vertices.begin(), face.vertices.end(), i) > 0;
            EXPECT_LT(beyond, on ? off * body.reach : -1e-6 * body.inradius);
            if (on) {
                EXPECT_GT(beyond, -off * body.reach);
            }
        }
    }
    for (const auto& edge : body.edges)
        for (const uint32_t face : edge.faces) {
            const auto found =
                std::find_if(body.faces.begin(), body.faces.end(), [&](const auto& f) { return f.id == face; });
            ASSERT_NE(found, body.faces.end());
            for (const uint32_t end : edge.vertices)
                EXPECT_EQ(std::count(found->vertices.begin(), found->vertices.end(), end), 1);
        }
}

/// The number of faces by their number of corners: "8x3 6x8".
std::string faces_of(const Polyhedron& body) {
    std::map<size_t, int> count;
    for (const auto& face : body.faces) ++count[face.vertices.size()];
    std::string text;
    for (const auto& [corners, faces] : count) text += fmt::format("{}{}x{}", text.empty() ? "" : " ", faces, corners);
    return text;
}

TEST(Polyhedra, ArchimedeanSolidsHaveTheirFacesAndEqualEdges) {
    const std::pair<const char*, const char*> solids[] = {{"truncated-tetrahedron", "4x3 4x6"},
                                                          {"cuboctahedron", "8x3 6x4"},
                                                          {"truncated-cube", "8x3 6x8"},
                                                          {"truncated-octahedron", "6x4 8x6"},
                                                          {"rhombicuboctahedron", "8x3 18x4"},
                                                          {"truncated-cuboctahedron", "12x4 8x6 6x8"},
                                                          {"snub-cube", "32x3 6x4"},
                                                          {"icosidodecahedron", "20x3 12x5"},
                                                          {"truncated-dodecahedron", "20x3 12x10"},
                                                          {"truncated-icosahedron", "12x5 20x6"},
                                                          {"rhombicosidodecahedron", "20x3 30x4 12x5"},
                                                          {"truncated-icosidodecahedron", "30x4 20x6 12x10"},
                                                          {"snub-dodecahedron", "80x3 12x5"}};
    for (const auto& [name, faces] : solids) {
        const auto body = archimedean_body(name);
        EXPECT_EQ(body->name, name);
        EXPECT_EQ(faces_of(*body), faces) << name;
        expect_sound(*body);
        for (const dvec3& p : body->vertices) EXPECT_NEAR(length(p), 1, 4e-16);
        const auto side = [&](const auto& edge) {
            return length(body->vertices[edge.vertices[0]] - body->vertices[edge.vertices[1]]);
        };
        for (const auto& edge : body->edges) EXPECT_NEAR(side(edge), side(body->edges[0]), 1e-14) << name;
    }
}

TEST(Polyhedra, BodiesOverPolygons) {
    const auto body = [](PolygonBody kind, int sides) {
        const Polyhedron made = body_over_polygon(kind, sides, 2, 3);
        expect_sound(made);
        for (const dvec3& p : made.vertices) {
            EXPECT_EQ(magnitude(p.z), 1.5);
            EXPECT_NEAR(std::hypot(p.x, p.y), kind == PolygonBody::pyramid && p.z > 0 ? 0 : 2, 1e-15);
        }
        EXPECT_EQ(made.vertices[0], dvec3(2, 0, -1.5));
        return made;
    };
    EXPECT_EQ(faces_of(body(PolygonBody::prism, 6)), "6x4 2x6");
    EXPECT_EQ(body(PolygonBody::prism, 254).planes.size(), 128u);  // in pairs
    EXPECT_EQ(faces_of(body(PolygonBody::prism, 3)), "2x3 3x4");
    EXPECT_EQ(faces_of(body(PolygonBody::antiprism, 5)), "10x3 2x5");
    EXPECT_EQ(faces_of(body(PolygonBody::antiprism, 127)), "254x3 2x127");
    EXPECT_EQ(faces_of(body(PolygonBody::pyramid, 4)), "4x3 1x4");
    EXPECT_EQ(body(PolygonBody::pyramid, 255).faces.size(), 256u);
    EXPECT_ERROR(body_over_polygon(PolygonBody::antiprism, 128, 1, 1), ExitCode::usage,
                 "the body has 258 faces; expected at most 256; give it as a mesh");
}

TEST(Polyhedra, BoxesAreExact) {
    const Polyhedron box = box_body({0.3, 2, 5});
    expect_sound(box, 1e-300);
    EXPECT_EQ(box.planes.size(), 3u);
    EXPECT_EQ(box.planes[0].high, 0.15);
    EXPECT_EQ(box.planes[0].low, -0.15);
    for (const dvec3& p : box.vertices)
        EXPECT_EQ(dvec3(magnitude(p.x), magnitude(p.y), magnitude(p.z)), dvec3(0.15, 1, 2.5));
}

std::vector<BodyPlane> cube_planes() {
    return {{{1, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{0, 3, 0}, 3}, {{0, -0.5, 0}, 0.5}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}};
}

TEST(Polyhedra, PlanesThatBoundNothingAreLeftOut) {
    std::vector<BodyPlane> planes = cube_planes();
    EXPECT_EQ(body_of_planes("c", planes).warning, "");
    // One touches a corner, one an edge, one a face; one is farther out, one is there twice.
    planes.insert(planes.begin() + 2, {{{1, 1, 1}, 3}, {{1, 1, 0}, 2}, {{2, 0, 0}, 2}, {{1, 1, 0}, 9}, {{0, 3, 0}, 3}});
    const Polyhedron body = body_of_planes("c", planes);
    expect_sound(body);
    EXPECT_EQ(faces_of(body), "6x4");
    EXPECT_EQ(body.planes.size(), 3u);
    EXPECT_EQ(body.warning, "5 of the planes bound nothing and are left out: 2, 3, 4, 5, 7");
}

TEST(Polyhedra, PlanesThatMakeNoBodyAreRefused) {
    std::vector<BodyPlane> open = cube_planes();
    open.pop_back();
    EXPECT_ERROR(body_of_planes("c", open), ExitCode::usage,
                 "the planes leave the body open toward [0, 0, -1]; add a plane that faces there");
    const std::vector<BodyPlane> parallel = {{{1, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{2, 0, 0}, 5}, {{-1, 0, 0}, 4}};
    EXPECT_ERROR(body_of_planes("c", parallel), ExitCode::usage,
                 "the planes are parallel and leave the body open; add planes across them");
    std::vector<BodyPlane> empty = cube_planes();
    empty[1].offset = -2;  // beyond the other face
    EXPECT_ERROR(body_of_planes("c", empty), ExitCode::usage,
                 "no point lies on the inner side of all planes; normals point outward: inside of [x, y, z, d] the "
                 "normal times the point is at most d");
    for (const double off : {0.0, 1e-9}) {
        empty[1].offset = off - 1;
        EXPECT_ERROR(body_of_planes("c", empty), ExitCode::usage,
                     "the body is flat, or nearly so; give one with an inside");
    }
    test::Random random(1);
    std::vector<BodyPlane> many;
    for (int i = 0; i < 257; ++i) many.push_back({random.direction(), 1});
    EXPECT_ERROR(body_of_planes("c", many), ExitCode::usage,
                 "the body has 257 faces; expected at most 256; give it as a mesh");
    many.pop_back();
    const Polyhedron most = body_of_planes("c", many);
    EXPECT_EQ(most.faces.size(), 256u);
    EXPECT_NEAR(most.inradius, 1, 1e-9);
}

/// A number as it is with so many digits.
double with_digits(double number, int digits) {
    return std::stod(fmt::format("{:.{}g}", number, digits));
}
dvec3 with_digits(const dvec3& p, int digits) {
    return {with_digits(p.x, digits), with_digits(p.y, digits), with_digits(p.z, digits)};
}

TEST(Polyhedra, DigitsMakeNoFacesOrCorners) {
    for (const char* name :
         {"icosidodecahedron", "snub-dodecahedron", "rhombicosidodecahedron", "truncated-icosahedron"})
        for (const int digits : {7, 9, 12, 17}) {
            const auto body = archimedean_body(name);
            std::vector<BodyPlane> planes;
            std::vector<dvec3> points;
            for (const auto& face : body->faces) {
                const auto& pair = body->planes[face.id / 2];
                const double offset = face.id % 2 ? pair.high : -pair.low;
                planes.push_back({with_digits(face.normal, digits), with_digits(offset, digits)});
            }
            for (const dvec3& p : body->vertices) points.push_back(with_digits(p, digits));
            EXPECT_EQ(faces_of(body_of_planes("c", planes)), faces_of(*body)) << name << " " << digits;
            EXPECT_EQ(faces_of(hull_of("c", points)), faces_of(*body)) << name << " " << digits;
        }
}

TEST(Polyhedra, HullsHaveTheCornersAloneAndTheirOwnOrder) {
    std::vector<dvec3> grid;
    for (int i = 0; i < 125; ++i) grid.push_back(0.1 * dvec3(i % 5, i / 5 % 5, i / 25));
    const Polyhedron cube = hull_of("c", grid);
    expect_sound(cube);
    EXPECT_EQ(faces_of(cube), "6x4");
    EXPECT_EQ(cube.planes.size(), 3u);
    const Polyhedron again = hull_of("c", grid);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(cube.planes[i].normal, again.planes[i].normal);
    const std::string remedy = "; give corners of a body with an inside";
    EXPECT_ERROR(hull_of("c", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 0}}), ExitCode::usage,
                 "the points lie in one plane, or nearly so" + remedy);
    test::Random random(2);
    std::vector<dvec3> ball;
    for (int i = 0; i < 1000; ++i) ball.push_back(random.direction());
    EXPECT_ERROR(hull_of("c", ball), ExitCode::usage,
                 "the hull has more than 256 faces; leave out points that are no corners, or give it as a mesh");
}

/// A compiled scene of one solid with lights on its edges.
TEST(Polyhedra, LightsLieOnBothFacesOfTheirEdges) {
    for (const char* name : {"cuboctahedron", "snub-dodecahedron"}) {
        SceneDescription scene;
        test::add_material(scene);
        SolidObject solid;
        solid.body = archimedean_body(name);
        solid.rotation = {20, 30, 40};
        solid.edge_lights.count = 2;
        test::add_object(scene, solid, 0);
        const auto compiled = test::compile<double>(scene);
        ASSERT_EQ(compiled->lights.size(), 2 * solid.body->edges.size());
        for (size_t i = 0; i < compiled->lights.size(); ++i) {
            const auto& light = compiled->lights[i];
            ASSERT_EQ(light.incident_count, 2u);
            const auto& edge = solid.body->edges[i / 2];
            for (uint32_t k = 0; k < 2; ++k)
                EXPECT_EQ(compiled->incidents[light.first_incident + k].face, edge.faces[k]) << name;
        }
    }
}

}  // namespace
}  // namespace cistula
