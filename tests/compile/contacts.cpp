// Which faces touch, whatever digits a file has and whatever the precision, and what is moved for it (docs/rules.md,
// 11).
#include "scene/compile/contacts/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>

#include "scene/compile/solids/placed_bodies.h"
#include "scene/compile/solids/smallest_part.h"
#include "scene/description/rotation.h"
#include "scene/readers/read_scene.h"
#include "testing/support/scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using test::dvec3;

enum : int { as_float = 0, exact = 17 };  // digits of coordinates, beside 6 to 9

double written(double x, int digits) {
    if (digits == as_float) return double(float(x));
    char text[40];
    std::snprintf(text, sizeof(text), "%.*g", digits, x);
    return std::atof(text);
}

/// Bodies that are turned and moved alike, then written with so many digits.
struct Bodies {
    Rotation rotation{dvec3(0)};
    dvec3 move{0};
    int digits = exact;
    SceneDescription scene = samples::empty_scene();

    Bodies() = default;
    Bodies(uint64_t seed, double off, int digits_of_all) : digits(digits_of_all) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> angle(-180, 180), place(-1, 1);
        rotation = Rotation({angle(random), angle(random), angle(random)});
        move = dvec3(place(random), place(random), place(random)) * off;
    }

    dvec3 placed(const dvec3& p) const {
        const dvec3 q = rotation(p) + move;
        return {written(q.x, digits), written(q.y, digits), written(q.z, digits)};
    }
    void add(const std::vector<dvec3>& vertices, const std::vector<std::array<uint32_t, 3>>& triangles) {
        TrianglesObject mesh;
        for (const dvec3& p : vertices) mesh.vertices.push_back(placed(p));
        mesh.triangles = triangles;
        test::add_object(scene, mesh, 0);
    }
    void quad(const dvec3& corner, const dvec3& a, const dvec3& b) {
        add({corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}});
    }
    /// A square of 2 x 2 times `half` at z = 0.
    void floor(double half = 3) { quad({-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}); }
    static std::vector<dvec3> corners(const dvec3& low, const dvec3& high) {
        std::vector<dvec3> all;
        for (int i = 0; i < 8; ++i)
            all.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
        return all;
    }
    static std::vector<std::array<uint32_t, 3>> sides() {
        return {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    }
    void box(const dvec3& low, const dvec3& high) { add(corners(low, high), sides()); }
    void cube(double half, const dvec3& base) {
        box(base + dvec3(-half, -half, 0), base + dvec3(half, half, 2 * half));
    }
};

/// Pairs of solids with faces in one plane.
std::set<std::pair<uint32_t, uint32_t>> touching(const Contacts& contacts) {
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    for (uint32_t a = 0; a < contacts.solids.size(); ++a)
        for (uint32_t b = a + 1; b < contacts.solids.size(); ++b)
            for (const PartOnPlane& x : contacts.solids[a].parts)
                for (const PartOnPlane& y : contacts.solids[b].parts)
                    if (x.plane == y.plane) pairs.insert({a, b});
    return pairs;
}

/// Six times the volume of a mesh, as given or as moved.
double volume(const SceneSource& source, uint32_t solid, bool moved) {
    const std::vector<dvec3>& points = source.bodies->contacts.solids[solid].points;
    const MeshSource& mesh = source.solids[solid].mesh;
    const auto at = [&](uint32_t i) {
        return moved && !points.empty() ? points[i] : source.bodies->normalization.point(mesh.vertices[i]);
    };
    double sum = 0;
    for (const auto& t : mesh.triangles) sum += dot(at(t[0]), cross(at(t[1]), at(t[2])));
    return sum;
}

/// Holds what no contact may do: turn a body, put its faces beyond rounding of their plane, or two opposite faces of
/// one closed body into one plane.
void expect_sound(const SceneSource& source) {
    const Contacts& contacts = source.bodies->contacts;
    const double extent = source.bodies->normalization.extent;
    for (uint32_t i = 0; i < source.solids.size(); ++i) {
        const SolidContacts& solid = contacts.solids[i];
        if (!solid.points.empty() && source.solids[i].closed) {
            EXPECT_NEAR(volume(source, i, true) / volume(source, i, false), 1, 0.01) << i;
        }
        std::vector<int> along(contacts.planes.size(), 0);
        for (const PartOnPlane& part : solid.parts) {
            const ContactPlane& plane = contacts.planes[part.plane];
            const auto& t = source.solids[i].mesh.triangles[part.part];
            dvec3 corner[3];
            for (int c = 0; c < 3; ++c)
                corner[c] = solid.points.empty()
                                ? source.bodies->normalization.point(source.solids[i].mesh.vertices[t[size_t(c)]])
                                : solid.points[t[size_t(c)]];
            for (const dvec3& p : corner)
                EXPECT_LE(std::abs(dot(plane.normal, p - plane.middle)), 0x1p-50 * extent) << "solid " << i;
            if (!source.solids[i].closed) continue;
            const int side = dot(plane.normal, cross(corner[1] - corner[0], corner[2] - corner[0])) > 0 ? 1 : -1;
            EXPECT_NE(along[part.plane], -side) << "opposite faces of solid " << i;
            along[part.plane] = side;
        }
    }
}

SceneSource gathered(const Bodies& bodies) {
    SceneSource source = gather_scene(bodies.scene);
    expect_sound(source);
    return source;
}

TEST(Contacts, CubesStandOnTheirFloorHoweverTheyAreWritten) {
    for (const double half : {0.5, 0.05})
        for (const int digits : {7, 8, 9, int(as_float), int(exact)})
            for (uint64_t seed = 0; seed < 40; ++seed) {
                Bodies bodies(seed, 0, digits);
                bodies.floor();
                bodies.cube(half, {0.3, 0.2, 0});
                const SceneSource source = gathered(bodies);
                ASSERT_EQ(touching(source.bodies->contacts).size(), 1u)
                    << "half edge " << half << ", digits " << digits << ", seed " << seed;
                EXPECT_TRUE(source.bodies->contacts.near.empty());
                ASSERT_EQ(source.bodies->convex.size(), 1u) << "planes give the cube in either precision";
            }
}

TEST(Contacts, WhatIsExactIsNotMoved) {
    Bodies bodies;
    bodies.floor();
    bodies.cube(0.5, {0.25, 0.5, 0});
    bodies.cube(0.25, {0.25, 0.5, 1});
    const SceneSource source = gathered(bodies);
    EXPECT_EQ(touching(source.bodies->contacts), (std::set<std::pair<uint32_t, uint32_t>>{{0, 1}, {1, 2}}));
    EXPECT_EQ(source.bodies->contacts.farthest_move, 0);
}

TEST(Contacts, CornersHolesRowsDecalsAndTilesTouch) {
    for (uint64_t seed = 0; seed < 12; ++seed)
        for (const int digits : {7, 9, int(as_float), int(exact)}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", digits " << digits);
            Bodies corner(seed, 1, digits);
            corner.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
            corner.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4});
            corner.quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0});
            corner.box({0, 0, 0}, {1, 1, 1});
            for (uint32_t wall = 0; wall < 3; ++wall)
                EXPECT_EQ(touching(gathered(corner).bodies->contacts).count({wall, 3}), 1u) << wall;

            Bodies decal(seed, 1, digits);
            decal.box({-1, -1, -1}, {1, 1, 1});
            decal.quad({-0.5, -0.4, 1}, {1, 0, 0}, {0, 0.8, 0});
            EXPECT_EQ(touching(gathered(decal).bodies->contacts).size(), 1u);

            Bodies row(seed, 1, digits);
            row.floor(5);
            for (int i = 0; i < 8; ++i) row.box({0.31 * i, -0.3, 0}, {0.31 * (i + 1), 0.3, 0.2});
            const auto pairs = touching(gathered(row).bodies->contacts);
            for (uint32_t i = 1; i <= 8; ++i) EXPECT_EQ(pairs.count({0, i}), 1u) << "box " << i << " on the floor";
            EXPECT_EQ(gathered(row).bodies->contacts.planes.size(), 11u) << "the floor, 7 walls, and 3 that all share";
        }
}

TEST(Contacts, ABoxStandsOnAMeshOfManySquares) {
    for (const int digits : {7, int(exact)}) {
        Bodies bodies(5, 1, digits);
        std::vector<dvec3> vertices;
        std::vector<std::array<uint32_t, 3>> triangles;
        const uint32_t n = 60;
        for (uint32_t j = 0; j <= n; ++j)
            for (uint32_t i = 0; i <= n; ++i) vertices.push_back({-3 + 6.0 * i / n, -3 + 6.0 * j / n, 0});
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i < n; ++i) {
                const uint32_t a = j * (n + 1) + i;
                triangles.push_back({a, a + 1, a + n + 2});
                triangles.push_back({a, a + n + 2, a + n + 1});
            }
        bodies.add(vertices, triangles);
        bodies.box({-0.6, -0.6, 0}, {0.6, 0.6, 1});
        const SceneSource source = gathered(bodies);
        EXPECT_EQ(source.bodies->contacts.planes.size(), 1u);
        EXPECT_EQ(touching(source.bodies->contacts).size(), 1u);
    }
}

/// Adds triangles around a tip, over or under a circle of radius 1 around (x, 0, 0); if `closed`, as many below it.
void add_fan(Bodies& bodies, uint32_t n, double x, double height, bool closed = false) {
    std::vector<dvec3> vertices{{x, 0, height}, {x, 0, 0}};
    std::vector<std::array<uint32_t, 3>> triangles;
    for (uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * i / n;
        const uint32_t next = 2 + (i + 1) % n;
        vertices.push_back({x + std::cos(angle), std::sin(angle), 0});
        triangles.push_back({0, 2 + i, next});
        if (closed) triangles.push_back({1, next, 2 + i});
    }
    bodies.add(vertices, triangles);
}

/// Around a tip every triangle comes near every other: two fans have 360,000 pairs, more than are allowed here, of
/// which few touch.
TEST(Contacts, FansApartAreNoCrowd) {
    const auto contacts_of = [](const Bodies& bodies) {
        const SceneSource source = gathered(bodies);
        const PlacedBodies& placed = *source.bodies;
        return find_contacts(source, placed.normalization, {}, placed.sizes, {.touching = 340'000});
    };
    for (const double height : {0.0, 1.0}) {
        Bodies bodies;
        for (const double x : {-2.0, 2.0}) add_fan(bodies, 600, x, height);
        EXPECT_TRUE(contacts_of(bodies).planes.empty());
        bodies.quad({-2.1, 0.2, height == 0 ? 0 : -1}, {0.2, 0, 0}, {0, 0.2, 0});
        const auto pairs = touching(contacts_of(bodies));
        EXPECT_EQ(pairs.size(), height == 0 ? 1u : 0u) << "only what lies on a flat one touches it";
    }
}

/// Pairs of boxes are limited, those of one sheet and those of two bodies, of which none touch.
TEST(Contacts, PairsOfBoxesAreLimited) {
    Bodies sheets, tips;
    for (const double x : {-2.0, 2.0}) add_fan(sheets, 600, x, 1);
    for (const double height : {1.0, -1.0}) {
        add_fan(tips, 900, height > 0 ? 0 : 0.01, height, true);
        for (dvec3& p : std::get<TrianglesObject>(tips.scene.objects.back().shape).vertices) p.z -= height;
    }
    for (const Bodies* bodies : {&sheets, &tips}) {
        const SceneSource source = gathered(*bodies);
        const PlacedBodies& placed = *source.bodies;
        const auto find = [&](const ContactLimits& limits) {
            return find_contacts(source, placed.normalization, {}, placed.sizes, limits);
        };
        EXPECT_NO_THROW(find({}));
        EXPECT_NO_THROW(find({.touching = 0, .boxes = 20'000'000}));
        samples::expect_error([&] { find({.boxes = 1'000'000}); }, ExitCode::usage,
                              (bodies == &sheets ? "/objects/1" : "/objects/0") +
                                  std::string(": more than 1 million pairs of faces come near one another"));
    }
}

TEST(Contacts, GapsOfAThousandthOfABodyStay) {
    for (const double edge : {1.0, 0.1, 0.01, 1e-3, 1e-4})
        for (const int digits : {9, int(exact)})
            for (uint64_t seed = 0; seed < 20; ++seed) {
                Bodies bodies(seed, 0, digits);
                bodies.floor();
                bodies.cube(edge / 2, {0.2, 0.3, 1.2e-3 * edge});
                if (digits == 9 && edge < 1e-2) continue;  // the gap is no more than the rounding
                EXPECT_TRUE(touching(gathered(bodies).bodies->contacts).empty())
                    << "edge " << edge << ", digits " << digits << ", seed " << seed;
            }
}

TEST(Contacts, NearPairsAreToldWithTheKeyThatJoinsThem) {
    Bodies bodies;
    bodies.floor();
    bodies.cube(0.5, {0, 0, 2e-5});
    const SceneSource source = gathered(bodies);
    const Contacts& contacts = source.bodies->contacts;
    EXPECT_TRUE(contacts.planes.empty());
    ASSERT_EQ(contacts.near.size(), 1u);
    EXPECT_EQ(contact_warnings(source, source.bodies->normalization, contacts).front(),
              "/objects/1: o1 and /objects/0: o0 have faces that are 2e-05 apart and do not touch; "
              "\"contact\": 2.2e-05 joins them");
    bodies.scene.contact = 2.2e-5;
    const SceneSource joined = gathered(bodies);
    EXPECT_EQ(touching(joined.bodies->contacts).size(), 1u);
    EXPECT_TRUE(joined.bodies->contacts.near.empty());
}

TEST(Contacts, AContactOfZeroJoinsOnlyWhatRoundingPartsAndWarnsOfNothing) {
    Bodies bodies;
    bodies.floor();
    bodies.cube(0.5, {0, 0, 1e-7});
    EXPECT_EQ(touching(gathered(bodies).bodies->contacts).size(), 1u);
    bodies.scene.contact = 0;
    const SceneSource source = gathered(bodies);
    EXPECT_TRUE(source.bodies->contacts.planes.empty());
    EXPECT_TRUE(contact_warnings(source, source.bodies->normalization, source.bodies->contacts).empty());
    Bodies exactly;
    exactly.floor();
    exactly.cube(0.5, {0, 0, 0});
    exactly.scene.contact = 0;
    EXPECT_EQ(touching(gathered(exactly).bodies->contacts).size(), 1u);
}

TEST(Contacts, AKeyJoinsNoBodyOverAThousandthOfItsThickness) {
    Bodies bodies;
    bodies.floor();
    bodies.cube(0.5, {0, 0, 2e-3});
    bodies.cube(0.5, {1.5, 0, 2e-4});
    bodies.scene.contact = 0.01;
    EXPECT_EQ(touching(gathered(bodies).bodies->contacts), (std::set<std::pair<uint32_t, uint32_t>>{{0, 2}}));
}

TEST(Contacts, AFilmBetweenPlatesAndAThinShellKeepTheirThickness) {
    Bodies plates;
    plates.box({-1, -1, -0.5}, {1, 1, 0});
    plates.box({-1.5, -1.5, 0}, {1.5, 1.5, 1e-7});
    plates.box({-0.8, -0.8, 1e-7}, {0.8, 0.8, 0.5});
    const SceneSource source = gathered(plates);
    EXPECT_EQ(touching(source.bodies->contacts), (std::set<std::pair<uint32_t, uint32_t>>{{0, 1}, {1, 2}}));
    EXPECT_EQ(volume(source, 1, true), volume(source, 1, false));
}

TEST(Contacts, OfAChainOfTilesOnlyTheNearestAreJoined) {
    Bodies tiles;
    const double step = 3e-6;
    for (int i = 0; i < 20; ++i) tiles.box({0.3 * i, 0, -0.2}, {0.3 * (i + 1), 0.3, step * 0.3 * i});
    tiles.box({0.3 * 14 + 0.05, 0.05, step * 0.3 * 14}, {0.3 * 14 + 0.25, 0.25, 0.3});
    const SceneSource source = gathered(tiles);
    for (uint32_t i = 0; i + 1 < 20; ++i)
        EXPECT_EQ(touching(source.bodies->contacts).count({i, i + 1}), 1u) << "their sides, " << i;
    EXPECT_EQ(touching(source.bodies->contacts).count({14, 20}), 1u) << "the box on its tile";
}

TEST(Contacts, AGapThatFloatWouldCloseTakesDouble) {
    Bodies bodies;
    bodies.floor();
    bodies.cube(0.0005, {0.2, 0.3, 2e-6});  // below tau, above 2^-10 of the cube's thickness
    const SceneSource source = gathered(bodies);
    EXPECT_TRUE(source.bodies->contacts.planes.empty());
    const SmallestPart part = smallest_part(source);
    EXPECT_LT(part.share, least_share(Precision::single_));
    EXPECT_EQ(part.what, "/objects/1: o1: its distance from /objects/0");
}

/// Two bodies whose faces lie at no distance or up to a hundredth apart, then a third one that comes near neither.
class ThreeBodies {
  public:
    explicit ThreeBodies(uint64_t seed) : random_(seed) {
        const int digits[] = {7, 9, as_float, exact, exact};
        turned_ = pick(3) != 0;
        bodies_ = Bodies(turned_ ? seed : 0, pick(2) * between_powers(-2, 2), digits[pick(5)]);
        if (!turned_) bodies_.rotation = Rotation(dvec3(0));
        gap_ = pick(4) == 0 ? 0 : between_powers(-9, -2);
        add_below(pick(5));
        add_above(pick(3));
    }

    /// Adds a body of any size, as far as that and the others' sizes and more.
    void add_third() {
        const double size = between_powers(-3, 3);
        const dvec3 way = bodies_.rotation(normalized(dvec3(between(-0.7, 0.7), between(-0.7, 0.7), 1)));
        const dvec3 center = bodies_.move + way * (2 * (size + size_) + between_powers(-2, 11.5));
        if (pick(2) == 0) {
            test::add_object(bodies_.scene, SphereObject{center, size}, 0);
        } else {
            test::add_solid(bodies_.scene, PlatonicSolid::cube, center, size, dvec3(between(0, 90), between(0, 90), 0));
        }
    }
    const SceneDescription& scene() const { return bodies_.scene; }

  private:
    int pick(int count) { return int(random_() % uint64_t(count)); }
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    double between_powers(double low, double high) { return std::pow(10, between(low, high)); }

    void add_below(int kind) {
        const double half = between_powers(-1, 1);
        size_ += half;
        const dvec3 normal = bodies_.rotation(dvec3(0, 0, 1));
        if (kind == 0) bodies_.floor(half);
        if (kind == 1) bodies_.box({-half, -half, -0.7 * half}, {half, half, 0});
        if (kind == 2) test::add_object(bodies_.scene, DiskObject{bodies_.placed(dvec3(0)), normal, half}, 0);
        if (kind == 3)
            test::add_object(bodies_.scene, DiskObject::plane(normal, dot(normal, bodies_.placed(dvec3(0)))), 0);
        if (kind == 4) add_cube(-half, half);
    }
    void add_above(int kind) {
        const double half = between_powers(-1, 1);
        size_ += half;
        if (kind == 0) bodies_.box({-half, -0.6 * half, gap_}, {half, half, gap_ + 0.3 * half});
        if (kind == 1) bodies_.quad({-half, -0.6 * half, gap_}, {1.7 * half, 0, 0}, {0, 2 * half, 0});
        if (kind == 2) add_cube(gap_ + half, half);
    }
    /// A described cube with its middle at (0, 0, z), as turned as the others are about the vertical axis alone.
    void add_cube(double z, double half) {
        const dvec3 rotation = turned_ ? dvec3(0) : dvec3(0, 0, between(0, 90));
        test::add_solid(bodies_.scene, PlatonicSolid::cube, bodies_.placed({0, 0, z}), half * std::sqrt(3.0), rotation);
    }

    std::mt19937_64 random_;
    Bodies bodies_;
    bool turned_ = false;
    double gap_ = 0, size_ = 0;
};

/// The parts of two solids on planes that both have, as numbers.
std::set<std::pair<uint32_t, uint32_t>> parts_in_contact(const Contacts& contacts) {
    std::set<std::pair<uint32_t, uint32_t>> parts;
    for (const PartOnPlane& x : contacts.solids[0].parts)
        for (const PartOnPlane& y : contacts.solids[1].parts)
            if (x.plane == y.plane) parts.insert({x.part, y.part});
    return parts;
}

TEST(Contacts, WhatComesNearNeitherOfTwoBodiesChangesNoContactOfTheirs) {
    size_t touching = 0, apart = 0, refused = 0;
    for (uint64_t seed = 0; seed < 4000; ++seed) {
        ThreeBodies bodies(seed);
        const SceneSource two = gather_scene(bodies.scene());
        const auto parts = parts_in_contact(two.bodies->contacts);
        ++(parts.empty() ? apart : touching);
        bodies.add_third();
        try {
            const SceneSource three = gather_scene(bodies.scene());
            ASSERT_EQ(parts_in_contact(three.bodies->contacts), parts) << seed;
        } catch (const Error& error) {
            ++refused;
            const std::string what = error.what();
            ASSERT_TRUE(what.find("/objects/1: o1 is ") != std::string::npos &&
                        what.find("/objects/0: ") != std::string::npos &&
                        what.find("double precision does not hold that gap") != std::string::npos)
                << seed << ": " << what;
            const auto number_after = [&](const char* text) {
                return std::atof(what.c_str() + what.find(text) + std::strlen(text));
            };
            ASSERT_LE(number_after(": o1 is "), 0x1p-47 * number_after(" that reaches ")) << seed << ": " << what;
        }
    }
    EXPECT_GT(touching, 1000u);
    EXPECT_GT(apart, 1000u);
    EXPECT_GT(refused, 10u);
}

TEST(Contacts, ABodyThatFliesOffLaterChangesNone) {
    const auto film = [](const std::string& moon) {
        return read_scene_text(R"({"materials": {"m": {}}, "lights": [{"position": [0, 0, 9]}], "objects": [
            {"solid": "box", "size": [2, 1, 1], "center": [0, 0, 0], "material": "m"},
            {"solid": "box", "size": [2, 1, 1], "center": [0, 1.0004, 0], "material": "m"},
            {"solid": "sphere", "radius": 1, "material": "m", "center": )" +
                                   moon + "}]}",
                               "film.json", "");
    };
    const SceneSource source = gather_scene(film(R"({"keys": [[0, [9, 0, 0]], [9, [9000, 0, 0]]]})"));
    EXPECT_TRUE(source.bodies->contacts.planes.empty());
    EXPECT_EQ(smallest_part(source).what.rfind("/objects/1: its distance from /objects/0", 0), 0u)
        << smallest_part(source).what;
    try {
        gather_scene(film(R"({"keys": [[0, [9, 0, 0]], [9, [1e12, 0, 0]]]})"));
        ADD_FAILURE() << "refused: double holds no gap of 4e-4 so far out";
    } catch (const Error& error) {
        EXPECT_EQ(
            std::string(error.what()),
            "frame 0: film.json: /objects/1: object1 is 0.0004 from /objects/0: object0, and double precision does "
            "not hold that gap in a scene that reaches 5e+11 far; bring what is far away nearer, or close the gap");
    }
}

/// A lies on C's face from above, B from below it, and what parts A from B is more than their own tolerance.
TEST(Contacts, AThirdBodyJoinsNoTwoThatLieOverOneAnotherApart) {
    Bodies bodies;
    bodies.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0});
    bodies.box({-1, -1, 4e-5}, {1, 1, 1});
    bodies.box({-1, -1, -1}, {1, 1, -3e-5});
    EXPECT_EQ(touching(gathered(bodies).bodies->contacts), (std::set<std::pair<uint32_t, uint32_t>>{{0, 2}}));
    Bodies beside;
    beside.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0});
    beside.box({-1, -1, 4e-5}, {1, 1, 1});
    beside.box({2, -1, -1}, {4, 1, -3e-5});
    EXPECT_EQ(touching(gathered(beside).bodies->contacts),
              (std::set<std::pair<uint32_t, uint32_t>>{{0, 1}, {0, 2}, {1, 2}}));
}

/// A large body that touches A alone carries A neither onto B nor past it.
TEST(Contacts, NoFaceIsMovedOntoOrPastAnother) {
    for (const double step : {2e-5, 3e-5}) {
        Bodies bodies;
        bodies.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        bodies.quad({0.2, 0.2, 2e-5}, {0.5, 0, 0}, {0, 0.5, 0});
        bodies.box({1, -500, step}, {1001, 500, 1000});
        EXPECT_TRUE(touching(gathered(bodies).bodies->contacts).empty()) << step;
    }
}

/// A turned body's box along the axes reaches over others that are far from it.
TEST(Contacts, FacesOfOnePlaneThatLieApartDoNotTouch) {
    const auto solids = [](const std::string& third) {
        return gather_scene(
            read_scene_text(R"({"materials": {"m": {}}, "lights": [{"position": [0, 0, 9]}], "objects": [
            {"solid": "box", "size": [1, 1, 1], "center": [0, 0, -0.5], "material": "m"},
            {"solid": "box", "size": [1, 1, 2e-4], "center": [0, 0, 1.0025e-4], "material": "m"})" +
                                third + "]}",
                            "apart.json", ""));
    };
    const std::string slab = R"(, {"solid": "box", "size": [1000, 1000, 1000], "rotate": [0, 0, 45], "material": "m",
                                   "center": [512, 512, -499.9999976]})";
    const auto two = parts_in_contact(solids("").bodies->contacts);
    EXPECT_FALSE(two.empty());
    EXPECT_EQ(parts_in_contact(solids(slab).bodies->contacts), two);
}

/// The distance of a box on a card from the card's other side is the card's thickness, and no gap.
TEST(Contacts, AThicknessIsNoGap) {
    const SceneSource source = gather_scene(read_scene_text(
        R"({"materials": {"m": {}}, "lights": [{"position": [0, 0, 9]}], "objects": [
            {"solid": "box", "size": [4, 4, 0.001], "center": [0, 0, -0.0005], "material": "m"},
            {"solid": "box", "size": [1, 1, 1], "center": [0, 0, 0.5], "material": "m"},
            {"solid": "sphere", "radius": 1e12, "center": [0, 0, 0], "material": "m"}]})",
        "card.json", ""));
    EXPECT_EQ(touching(source.bodies->contacts), (std::set<std::pair<uint32_t, uint32_t>>{{0, 1}}));
}

TEST(Contacts, DisksAndBallsThatDoubleMakesPointsOfAreRefused) {
    for (const char* small : {R"("disk": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1})",
                              R"("solid": "sphere", "radius": 1, "center": [0, 0, 0])"})
        try {
            gather_scene(read_scene_text(std::string(R"({"materials": {"m": {}}, "objects": [{"material": "m", )") +
                                             small +
                                             R"(}, {"solid": "box", "size": [1e17, 1e17, 1e17], "center": [1e17, 0, 0],
                                                   "material": "m"}]})",
                                         "far.json", ""));
            ADD_FAILURE() << small;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind("far.json: /objects/0: so small beside the scene", 0), 0u)
                << error.what();
        }
}

/// At its keys a box is far from another, over which it passes between them.
TEST(Contacts, TheSmallestGapBetweenTwoKeysTakesDouble) {
    const auto part = [](const std::string& height) {
        return smallest_part(gather_scene(read_scene_text(
            R"({"materials": {"m": {}}, "lights": [{"position": [0, 0, 9]}], "objects": [
            {"solid": "box", "size": [2, 2, 1], "center": [0, 0, -0.5], "material": "m"},
            {"solid": "box", "size": [1, 1, 1], "material": "m", "center": {"keys": [[0, [-7, 0, )" +
                height + "]], [10, [7, 0, " + height + "]]]}}]}",
            "film.json", "")));
    };
    EXPECT_GT(part("0.6").share, least_share(Precision::single_));
    EXPECT_EQ(part("0.6").what, "/objects/1: its inradius at frame 0");
    EXPECT_LT(part("0.500005").share, least_share(Precision::single_));
    EXPECT_EQ(part("0.500005").what, "/objects/1: its distance from /objects/0 at frame 4");
}

TEST(Contacts, DescribedBoxesOfSevenDigitsTouch) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(10, 20), side(0.1, 1);
    for (int i = 0; i < 200; ++i) {
        const double z = place(random), low = side(random), high = side(random);
        const auto ends_in_zeros = [](double x) { return std::remainder(std::round(x * 1e5), 100) == 0; };
        if (ends_in_zeros(z - low / 2) || ends_in_zeros(z + high / 2)) continue;  // 5 digits say nothing of 7
        const auto box = [&](double center, double size) {
            return R"({"solid": "box", "material": "m", "size": [1, 1, )" + std::to_string(written(size, 7)) +
                   R"(], "center": [3, 4, )" + std::to_string(written(center, 7)) + "]}";
        };
        const SceneDescription scene =
            read_scene_text(R"({"materials": {"m": {}}, "lights": [{"position": [0, 0, 30]}], "objects": [)" +
                                box(z - low / 2, low) + ", " + box(z + high / 2, high) + "]}",
                            "boxes.json", "");
        EXPECT_EQ(gather_scene(scene).bodies->contacts.planes.size(), 5u) << "four sides, and where they touch, " << i;
    }
}

template <class Real>
class ContactsOf : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ContactsOf, Precisions);

TYPED_TEST(ContactsOf, LightsOfAnyDigitsLieOnTheirFace) {
    for (const int digits : {7, int(as_float), int(exact)})
        for (uint64_t seed = 0; seed < 20; ++seed) {
            Bodies bodies(seed, 1, digits);
            bodies.box({-3, -3, -0.5}, {3, 3, 0});
            LightDescription light;
            light.position = bodies.placed({1, 0.5, 0});
            bodies.scene.lights.push_back(light);
            EXPECT_EQ(compile_scene<TypeParam>(bodies.scene)->incidents.size(), 1u)
                << "digits " << digits << ", seed " << seed;
        }
}

}  // namespace
}  // namespace cistula
