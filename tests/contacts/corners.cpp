// Lines into the corner of a pane and a floor, beside a cube that stands on the one and at the other: each meets the
// pane once, whichever of the two comes first (docs/rules.md, 11, line 11).
#include "testing/support/contacts/contact_walk.h"
#include "testing/support/intersectors.h"

namespace cistula {
namespace {

using namespace test;

/// Counts how often a ray tree meets a pane and a floor.
template <class Real>
struct CornerCounter {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const Scene& scene;
    const uint32_t pane, floor;
    size_t &at_pane, &at_floor;

    template <class E>
    Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = closest(ray);
        at_pane += hit.found() && key_solid(hit.key) == pane;
        at_floor += hit.found() && key_solid(hit.key) == floor;
        return hit;
    }
    Hit<Real> closest(const Ray<Real>& ray) const { return test::Brute<Real>{scene}.closest(ray); }
    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        return test::Brute<Real>{scene}.template transmittance<E>(shadow);
    }
};

/// Rays from random places to places within 2^-10 to 2^-57 of the corner, on either side of the cube.
template <class Real>
Ray<Real> ray_into_corner(const CompiledScene<Real>& compiled, const ContactScene& contact, Random& random) {
    const double beside = random.below(2) ? 1 : -1;
    const dvec3 off = random.in_cube(1) * std::ldexp(1.0, -10 - int(random.below(sizeof(Real) == 4 ? 20 : 48)));
    const dvec3 to = contact.place(dvec3(0.4, beside * random.between(0.5, 1.4), 0) + off);
    const dvec3 from = contact.place({0.4 + (random.below(2) ? 1 : -1) * random.between(0.1, 1),
                                      beside * random.between(0.5, 1.4), random.between(0.05, 1)});
    return ray_from(Vec3<Real>((from - compiled.center) * std::ldexp(1.0, compiled.scale)),
                    Vec3<Real>(normalized(to - from)));
}

template <class Real>
class CornerContacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(CornerContacts, Reals);

TYPED_TEST(CornerContacts, LinesMeetThePaneOnce) {
    using Real = TypeParam;
    using Counter = CornerCounter<Real>;
    Random random(11);
    size_t lines = 0, wrong = 0;
    for (int turn = 0; turn < 1000; ++turn) {
        ContactScene contact(turn % 8 == 0 ? Basis() : Basis::random(random), random.in_cube(1));
        const int mirror = add_material(contact.scene, 1), glazing = add_material(contact.scene, 0, 0.5);
        const uint32_t pane = random.below(2), floor = 1 - pane;
        if (pane == 0) contact.quad({0.4, -1.5, -1}, {0, 3, 0}, {0, 0, 2}, glazing);
        contact.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, mirror);
        if (pane == 1) contact.quad({0.4, -1.5, -1}, {0, 3, 0}, {0, 0, 2}, glazing);
        contact.cube(0, 0, 0, 0.8, 0, mirror, BodyKind::planes);
        const auto compiled = test::compile<Real>(contact.scene);
        const SceneView<Real> view = compiled->view();
        for (int i = 0; i < 200; ++i) {
            const Ray<Real> ray = ray_into_corner(*compiled, contact, random);
            size_t at_pane = 0, at_floor = 0;
            const Counter counter{view, pane, floor, at_pane, at_floor};
            trace_tree(view, counter, ray, 4);
            if (at_floor == 0) continue;
            ++lines;
            wrong += at_pane != 1;
        }
    }
    EXPECT_GT(lines, 190000u);
    EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace cistula
