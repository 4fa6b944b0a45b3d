// Ray trees in scenes of cubes and sheets that stand on, lie on and touch one another: every line is inside the bodies
// that it should be inside, no sheet is passed, and shadow rays cross what lies in their way.
#include "testing/support/contacts/contact_walk.h"

namespace cistula {
namespace {

using namespace test;

const Arrangement arrangements[] = {
    {"a cube on a floor",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.cube(0, 0, 0, 0.8, any_turn(r), glass, kind());
     }},
    {"a cube on a decal on a floor",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         const double a = r.between(0, 6.28), c = std::cos(a), n = std::sin(a);
         s.quad({0.1, 0.05, 0}, {0.6 * c, 0.6 * n, 0}, {-0.5 * n, 0.5 * c, 0}, paper);
         s.cube(0, 0, 0, 0.8, any_turn(r), glass, kind());
     }},
    {"two cubes side by side on a floor",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         const bool smaller = r.below(2) == 1;
         s.cube(-0.3, 0, 0, 0.6, 0, glass, kind());
         s.cube(smaller ? 0.2 : 0.3, smaller ? 0.05 : 0, 0, smaller ? 0.4 : 0.6, 0, clear, kind());
     }},
    {"a cube over the floor's edge",
     [](ContactScene& s, Random& r, const auto& kind) {
         s.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, paper);
         s.cube(0, 0, 0, 0.8, any_turn(r), glass, kind());
     }},
    {"a cube across two overlapping quads",
     [](ContactScene& s, Random& r, const auto& kind) {
         s.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, paper);
         s.quad({0, -2, 0}, {2, 0, 0}, {0, 4, 0}, paper);
         s.cube(0, 0, 0, 0.8, any_turn(r), glass, kind());
     }},
    {"a cube in a corner of the room",
     [](ContactScene& s, Random&, const auto& kind) {
         s.quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, paper);
         s.quad({0, 0, 0}, {0, 2, 0}, {0, 0, 2}, paper);
         s.quad({0, 0, 0}, {2, 0, 0}, {0, 0, 2}, paper);
         s.cube(0.4, 0.4, 0, 0.8, 0, glass, kind());
     }},
    {"cubes that share an edge",
     [](ContactScene& s, Random&, const auto& kind) {
         add_floor(s, paper);
         s.cube(-0.3, 0, 0, 0.6, 0, glass, kind());
         s.cube(0.2, 0, 0.6, 0.4, 0, clear, kind());
     }},
    {"cubes that share a corner",
     [](ContactScene& s, Random&, const auto& kind) {
         add_floor(s, paper);
         s.cube(-0.3, -0.3, 0, 0.6, 0, glass, kind());
         s.cube(0.2, 0.2, 0.6, 0.4, 0, clear, kind());
     }},
    {"a stack",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.quad({-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0}, paper);
         s.cube(0, 0, 0, 0.8, any_turn(r), glass, kind());
         s.cube(0.05, -0.02, 0.8, 0.5, any_turn(r), clear, kind());
         s.cube(0, 0.02, 1.3, 0.3, any_turn(r), glass, kind());
     }},
    {"a label on a face",
     [](ContactScene& s, Random& r, const auto& kind) {
         s.cube(0, 0, -0.8, 0.8, 0, glass, kind());
         s.quad({-0.3, -0.1, 0}, {0.5, 0, 0}, {0, 0.3, 0}, paper);
         s.quad({-0.1, -0.4, 0}, {0.2, 0, 0}, {0, 0.5 + 0.2 * r.unit(), 0}, paper);
     }},
    {"a block of eight",
     [](ContactScene& s, Random&, const auto& kind) {
         add_floor(s, paper);
         for (int i = 0; i < 8; ++i)
             s.cube(i & 1 ? 0.2 : -0.2, i & 2 ? 0.2 : -0.2, i & 4 ? 0.4 : 0, 0.4, 0, i % 3 ? glass : clear, kind());
     }},
};

template <class Real>
class Contacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Contacts, Reals);

/// The faults of walks through all kinds of scenes.
template <class Real>
size_t faults(BodyKind other) {
    const ContactCounts all = walk_all<Real>(arrangements, other);
    EXPECT_GT(all.lines, 2000000u);
    EXPECT_GT(all.shadows, 500000u);
    return all.faults();
}

TYPED_TEST(Contacts, SolidsAndSheetsHaveNoFault) {
    EXPECT_EQ(faults<TypeParam>(BodyKind::planes), 0u);
}

TYPED_TEST(Contacts, ConvexMeshesHaveNoFault) {
    for (const Arrangement& arrangement : arrangements) {
        Random random(7);
        const ContactScene scene = arranged(arrangement, random, BodyKind::convex_mesh);
        const auto compiled = test::compile<TypeParam>(scene.scene);
        for (const Solid& solid : compiled->solids) EXPECT_NE(solid.kind, SolidKind::mesh) << arrangement.name;
    }
    EXPECT_LE(faults<TypeParam>(BodyKind::convex_mesh), 1u);  // of 24 million lines one was wrong
}

/// Two of three cubes are meshes.
TYPED_TEST(Contacts, MeshesHaveFewFaults) {
    EXPECT_LE(faults<TypeParam>(BodyKind::mesh), 30u);
}

}  // namespace
}  // namespace cistula
