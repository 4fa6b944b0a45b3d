// Ray trees in scenes of closed meshes that are not convex and stand on, lie on and touch sheets, solids and one
// another.
#include "testing/support/contacts/contact_walk.h"

namespace cistula {
namespace {

using namespace test;

using Shape = std::vector<BlockShape>;

Shape channel(double low) {
    return {{{-0.5, -0.2, low}, {0.5, 0.2, low + 0.2}},
            {{-0.5, -0.2, low}, {-0.2, 0.2, low + 0.6}},
            {{0.2, -0.2, low}, {0.5, 0.2, low + 0.6}}};
}
Shape table() {
    Shape shape{{{-0.5, -0.4, 0.5}, {0.5, 0.4, 0.6}}};
    for (const double x : {-0.5, 0.4})
        for (const double y : {-0.4, 0.3}) shape.push_back({{x, y, 0}, {x + 0.1, y + 0.1, 0.6}});
    return shape;
}
Shape stair() {
    return {
        {{-0.6, -0.3, 0}, {0.6, 0.3, 0.2}}, {{-0.6, -0.3, 0}, {0.2, 0.3, 0.4}}, {{-0.6, -0.3, 0}, {-0.2, 0.3, 0.6}}};
}
/// Six walls around a cavity of the sides 1.6, 1.6 and 1.
Shape room() {
    return {{{-1, -1, -0.2}, {1, 1, 0}},    {{-1, -1, 1}, {1, 1, 1.2}},       {{-1, -1, -0.2}, {-0.8, 1, 1.2}},
            {{0.8, -1, -0.2}, {1, 1, 1.2}}, {{-1, -1, -0.2}, {1, -0.8, 1.2}}, {{-1, 0.8, -0.2}, {1, 1, 1.2}}};
}
const Arrangement mesh_arrangements[] = {
    {"an L on a floor",
     [](ContactScene& s, Random& r, const auto&) {
         add_floor(s, paper);
         s.blocks(0, 0, any_turn(r), ell(0), glass);
     }},
    {"an L on a cube",
     [](ContactScene& s, Random& r, const auto& kind) {
         s.cube(0, 0, -1.2, 1.2, any_turn(r), clear, kind());
         s.blocks(0, 0, any_turn(r), ell(0), glass);
     }},
    {"an L over an edge, on a decal",
     [](ContactScene& s, Random& r, const auto&) {
         s.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, paper);
         s.quad({-0.3, -0.1, 0}, {0.5, 0.1, 0}, {-0.1, 0.5, 0}, paper);
         s.blocks(0, 0, any_turn(r), ell(0), glass);
     }},
    {"a cube in an L",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.blocks(0, 0, 0, ell(0), r.below(2) != 0 ? glass : clear);
         s.cube(0.2, 0, 0.4, 0.4, 0, clear, kind());
     }},
    {"a cube in a U",
     [](ContactScene& s, Random&, const auto& kind) {
         add_floor(s, paper);
         s.blocks(0, 0, 0, channel(0), glass);
         s.cube(0, 0, 0.2, 0.4, 0, clear, kind());
     }},
    {"cubes on and under a table",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.blocks(0, 0, 0, table(), glass);
         s.cube(0.1, 0, 0, r.below(2) != 0 ? 0.5 : 0.4, 0, clear, kind());
         s.cube(-0.1, 0.1, 0.6, 0.3, any_turn(r), clear, kind());
     }},
    {"cubes on a stair",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.blocks(0, 0, 0, stair(), glass);
         s.cube(0.4, 0.1, 0.2, 0.4, 0, clear, kind());
         s.cube(-0.4, 0, 0.6, 0.3, any_turn(r), clear, kind());
         s.quad({-0.1, -0.2, 0.4}, {0.2, 0, 0}, {0, 0.3, 0}, paper);
     }},
    {"a cube in a corner of a room",
     [](ContactScene& s, Random&, const auto& kind) {
         s.blocks(0, 0, 0, room(), glass);
         s.cube(-0.5, -0.5, 0, 0.6, 0, clear, kind());
         s.quad({-0.8, -0.4, 0.2}, {0, 0.6, 0}, {0, 0, 0.4}, paper);
     }},
    {"two L that fill a block",
     [](ContactScene& s, Random&, const auto&) {
         add_floor(s, paper);
         s.blocks(0, 0, 0, ell(0), glass);
         s.blocks(0, 0, 0, {{{0, -0.2, 0.4}, {0.4, 0.2, 1.2}}, {{-0.4, -0.2, 0.8}, {0.4, 0.2, 1.2}}}, clear);
     }},
    {"a stack of U, L and cube",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         s.blocks(0, 0, any_turn(r), channel(0), glass);
         s.blocks(0, 0, any_turn(r), ell(0.6), clear);
         s.cube(-0.2, 0, 1.4, 0.3, any_turn(r), glass, kind());
     }},
    {"a block of four, each of two",
     [](ContactScene& s, Random& r, const auto& kind) {
         add_floor(s, paper);
         for (int i = 0; i < 4; ++i) {
             const double x = i & 1 ? 0.2 : -0.2, y = i & 2 ? 0.2 : -0.2;
             s.blocks(x, y, 0, three_quarters(0.4, 0), i % 3 ? glass : clear);
             s.cube(x + 0.1, y + 0.1, 0, 0.2, 0, r.below(2) != 0 ? glass : clear, kind());
         }
     }},
};

template <class Real>
class MeshContacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(MeshContacts, Reals);

TYPED_TEST(MeshContacts, HaveFewFaults) {
    const ContactCounts all = walk_all<TypeParam>(mesh_arrangements, BodyKind::mesh);
    EXPECT_GT(all.lines, 2000000u);
    EXPECT_GT(all.shadows, 500000u);
    EXPECT_LE(all.faults(), 30u);
}

}  // namespace
}  // namespace cistula
