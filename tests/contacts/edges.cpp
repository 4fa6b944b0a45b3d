// Ray trees in scenes of bodies that touch along an edge alone: no two of their faces lie in one plane there, so that
// nothing is shared (docs/rules.md, 11).
#include "testing/support/contacts/contact_walk.h"

namespace cistula {
namespace {

using namespace test;

const double diagonal = std::sqrt(0.5);  // cosine and sine of an eighth of a turn
const double eighth = std::acos(diagonal);

const Arrangement of_cubes[] = {
    {"upright cubes that share an edge",
     [](ContactScene& s, Random&, const auto& kind) {
         s.cube(0, 0, 0, 0.8, 0, glass, kind());
         const double c = std::cos(0.3), n = std::sin(0.3);
         s.cube(0.4 + 0.4 * (c - n), 0.4 + 0.4 * (c + n), 0.1, 0.8, 0.3, clear, kind());
     }},
    {"a cube whose edge lies on a face",
     [](ContactScene& s, Random&, const auto& kind) {
         s.cube(0, 0, 0, 0.8, 0, glass, kind());
         s.cube(0.1, 0.4 + 0.8 * diagonal, 0.1, 0.8, eighth, clear, kind());
     }},
};

const Arrangement of_meshes[] = {
    {"two L that share an edge",
     [](ContactScene& s, Random&, const auto&) {
         s.blocks(0, 0, 0, ell(0), glass);
         s.blocks(0.4 + 0.2 * diagonal, 0.2 + 0.6 * diagonal, eighth, ell(-0.1), clear);
     }},
    {"an L whose edge lies on a face",
     [](ContactScene& s, Random& r, const auto& kind) {
         if (r.below(2) != 0)
             s.blocks(0, 0, 0, ell(0), glass);
         else
             s.cube(0, -0.2, -0.1, 0.8, 0, glass, kind());
         s.blocks(0.2 * diagonal, 0.2 + 0.6 * diagonal, eighth, ell(-0.1), clear);
     }},
};

template <class Real>
class EdgeContacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(EdgeContacts, Reals);

TYPED_TEST(EdgeContacts, OfSolidsHaveFewFaults) {
    const ContactCounts all = walk_all<TypeParam>(of_cubes, BodyKind::planes);
    EXPECT_GT(all.lines, 400000u);
    EXPECT_LE(all.faults(), 30u);
}

TYPED_TEST(EdgeContacts, OfMeshesHaveFewFaults) {
    // Faults come by scenes: of 4.9 million lines in 800 scenes 2,937 in float and 1,780 in double, of a tenth up to
    // 344.
    const ContactCounts all = walk_all<TypeParam>(of_meshes, BodyKind::mesh, 160);
    EXPECT_GT(all.lines, 1600000u);
    EXPECT_LE(all.faults(), 1300u);
}

}  // namespace
}  // namespace cistula
