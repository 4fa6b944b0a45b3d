// Ray trees in scenes of bodies that touch, turned and moved at random, whose every line is compared with what is true.
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "cistula/transport/ray_tree.h"
#include "testing/support/contacts/ideal_contact.h"
#include "testing/support/intersectors.h"

namespace cistula::test {

/// A kind of scene; the second argument draws what is free in it.
struct Arrangement {
    const char* name;
    std::function<void(ContactScene&, Random&, const std::function<BodyKind()>&)> build;
};

inline void add_floor(ContactScene& scene, int material, double half = 2) {
    scene.quad({-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}, material);
}

inline double any_turn(Random& random) {
    return random.below(4) == 0 ? 0 : random.between(0, 6.28);
}

/// Two boxes in the shape of an L of the sides 0.8, 0.4 thick.
inline std::vector<BlockShape> ell(double low) {
    return {{{-0.4, -0.2, low}, {0.4, 0.2, low + 0.4}}, {{-0.4, -0.2, low}, {0, 0.2, low + 0.8}}};
}

inline constexpr int glass = 0, clear = 1, paper = 2;

/// A point on a body, most often at an edge, a corner or the contact plane, moved by anything from nothing to its size.
inline dvec3 target_in(const ContactScene& scene, Random& random) {
    const auto& body = scene.bodies[random.below(uint32_t(scene.bodies.size()))];
    dvec3 p(0);
    const auto share = [&] { return random.below(3) == 0 ? random.unit() : double(random.below(2)); };
    if (body.sheet) {
        p = body.corner + body.along * share() + body.across * share();
    } else {
        const auto& part = body.parts[random.below(uint32_t(body.parts.size()))];
        for (size_t axis = 0; axis < 3; ++axis) {
            const double low = -part.offsets[2 * axis], high = part.offsets[2 * axis + 1];
            p += part.normals[2 * axis + 1] * (low + (high - low) * share());
        }
    }
    if (random.below(4) != 0) p += random.in_cube(1) * std::ldexp(1.0, -int(random.below(28)));
    return p;
}

struct NothingSeen {
    template <class Hit, class Normal>
    void surface(const Hit&, const Normal&) const {}
    template <class Scene, class Light, class Line>
    void light(const Scene&, const Light&, const Line&) const {}
};

/// Traces a ray's tree, of whose light nothing is kept. Returns its flags.
template <class Real, class Intersector>
uint32_t trace_tree(const SceneView<Real>& view, const Intersector& intersector, const Ray<Real>& ray, int depth) {
    using Stack = BranchStack<Branch<Real>>;
    TreeSettings settings;
    settings.depth = depth;
    settings.fixed_scale = 0x1p60f;
    settings.fixed_unit = 0x1p-60f;
    PixelRecord record{};
    uint32_t flags = 0;
    PixelSums<Real> sums(settings, view, record, flags);
    PixelRays traced;
    typename Stack::Storage storage;
    Stack stack(storage);
    RayTree<Real, Effects<all_effects>, Intersector, Stack>(view, intersector, settings.depth, sums, traced, stack)
        .trace(ray, NothingSeen());
    return flags;
}

/// Traces the trees of `rays` primary rays from random places.
template <class Real>
ContactCounts walk(const ContactScene& contact, Random& random, int rays) {
    ContactCounts counts;
    const auto compiled = compile_scene<Real>(contact.scene);
    const SceneView<Real> view = compiled->view();
    const Brute<Real> brute{view};
    using Checked = CheckedIntersector<Real, Brute<Real>>;
    Checked checked(*compiled, contact.bodies, brute, counts);
    checked.target = [&] { return target_in(contact, random); };
    const double factor = std::ldexp(1.0, compiled->scale);
    const double tolerance = 512 * double(RealTraits<Real>::unit) * double(compiled->extent) / factor;
    for (int i = 0; i < rays; ++i) {
        const dvec3 middle = contact.place({0, 0, 0.3});
        dvec3 from = middle + random.direction() * random.between(0.1, 3);
        Ray<Real> ray;
        ray.origin = Vec3<Real>((from - compiled->center) * factor);
        from = dvec3(Vec3<double>(ray.origin)) / factor + compiled->center;
        bool clear_of_all = true;
        for (uint32_t b = 0; b < contact.bodies.size(); ++b) {
            const auto& body = contact.bodies[b];
            if (body.sheet) {
                clear_of_all &= magnitude(dot(body.sheet_normal(), from - body.corner)) > tolerance;
            } else {
                const double depth = body.depth(from);
                clear_of_all &= magnitude(depth) > tolerance;
                if (depth > 0) ray.media.add(b, 1);
            }
        }
        if (!clear_of_all) continue;
        ray.direction = Vec3<Real>(normalized(target_in(contact, random) - from));
        EXPECT_EQ(trace_tree(view, checked, ray, 6), 0u);
    }
    return counts;
}

/// Bodies are planes, but `other` two times in three.
inline ContactScene arranged(const Arrangement& arrangement, Random& random, BodyKind other) {
    const bool straight = random.below(8) == 0;
    ContactScene scene(straight ? Basis() : Basis::random(random), random.in_cube(random.below(2) ? 1 : 0.1));
    add_material(scene.scene, 0.2, 0.5, dvec3(1), 1.5);
    add_material(scene.scene, 0.2, 0.5, dvec3(1), 1.0);
    add_material(scene.scene, 0.2, 0.5);
    arrangement.build(scene, random,
                      [&] { return other != BodyKind::planes && random.below(3) != 0 ? other : BodyKind::planes; });
    for (int i = 0; i < 2; ++i) add_light(scene.scene, scene.place(random.direction() * 3.5));
    return scene;
}

/// Walks through 40 scenes of every kind, prints what was counted and returns the sum.
template <class Real, size_t count>
ContactCounts walk_all(const Arrangement (&arrangements)[count], BodyKind other, int turns = 40) {
    ContactCounts all;
    for (const Arrangement& arrangement : arrangements) {
        Random random(7);
        ContactCounts sum;
        for (int turn = 0; turn < turns; ++turn) {
            const ContactScene scene = arranged(arrangement, random, other);
            sum.add(walk<Real>(scene, random, 250));
        }
        std::printf(
            "%-6s %-38s lines %7zu shadows %7zu | media %zu passed %zu off %zu earlier %zu shadow %zu gaps %zu\n",
            RealTraits<Real>::name, arrangement.name, sum.lines, sum.shadows, sum.media, sum.passed, sum.false_sheet,
            sum.later, sum.shaded, sum.gaps);
        all.add(sum);
    }
    return all;
}

}  // namespace cistula::test
