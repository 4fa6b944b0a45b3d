// What plan_shadows leaves out no shadow ray would have met, and it leaves out most.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "cistula/shading/lighting.h"
#include "cistula/traversal/brute.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/constant_scene.h"
#include "testing/support/shipped_scenes.h"

namespace cistula {
namespace {

template <class Real>
class ShadowPlans : public ::testing::Test {
  public:
    using Small = ConstantScene<Real>;
    using Intersector = BruteIntersector<Real, SingleInterior, Small>;
    using E = Effects<clear_bodies>;

    /// Compiles the scene with and without a shadow plan; false if it does not fit a ConstantScene.
    bool load(const SceneDescription& description) {
        compiled_ = compile_scene<Real>(description);
        const SceneView<Real> view = compiled_->view();
        planned_ = constant_scene(view);
        blind_ = constant_scene(view);
        if (!planned_) return false;
        blind_->plan.clear(blind_->convex.size, blind_->clusters.size);
        return true;
    }

    /// Shadow rays from whatever rays of all directions meet, from both sides of it. How many were compared.
    int compare_rays(std::mt19937_64& random, int count) {
        std::uniform_real_distribution<double> in_cube(-1, 1);
        const auto vector = [&] {
            return Vec3<Real>(Real(in_cube(random)), Real(in_cube(random)), Real(in_cube(random)));
        };
        const Intersector blind{*blind_}, planned{*planned_};
        int compared = 0;
        for (int i = 0; i < count; ++i) {
            Ray<Real, SingleInterior> ray;
            ray.origin = vector() * blind_->extent;
            ray.direction = normalized(vector());
            for (uint32_t s = 0; s < blind_->solids.size; ++s)
                if (blind_->solids[s].kind == SolidKind::convex &&
                    inside_convex(*blind_, blind_->solids[s], ray.origin))
                    ray.media.cross(true, false, s);
            const Hit<Real> hit = first_hit(blind, ray);
            if (!hit.found()) continue;
            const Surface<Real> s = surface_at<Real, E>(*blind_, ray, hit);
            compared += compare(blind, planned, s, hit, ray.media);
            // The other side of the face.
            SingleInterior beyond = ray.media;
            const CrossingKind kind = key_kind(hit.key);
            if (!beyond.cross(kind == CrossingKind::enter, kind == CrossingKind::leave, key_solid(hit.key))) continue;
            Surface<Real> back = s;
            back.normal = -s.normal;
            back.viewer_side = far_side<E>(*blind_, hit, s.point, s.normal);
            compared += compare(blind, planned, back, hit, beyond);
        }
        return compared;
    }

    const ShadowPlan& plan() const { return planned_->plan; }
    uint32_t lights() const { return planned_->lights.size; }
    uint32_t solids() const { return planned_->solids.size; }

  private:
    /// Called: inlined, GCC takes the lack of a solid for an index out of bounds.
    [[gnu::noinline]] static Hit<Real> first_hit(const Intersector& intersector, const Ray<Real, SingleInterior>& ray) {
        return intersector.closest(ray);
    }

    static int compare(const Intersector& blind, const Intersector& planned, const Surface<Real>& s,
                       const Hit<Real>& hit, const SingleInterior& media) {
        int compared = 0;
        for (uint32_t l = 0; l < blind.scene.lights.size; ++l) {
            const auto share = [&](const Intersector& intersector) {
                const Light<Real>& light = intersector.scene.lights[l];
                const Vec3<Real> to_light = light.position - s.viewer_side;
                const Real distance = length(to_light);
                const ShadowRay<Real, SingleInterior> shadow{spawned(s.viewer_side, to_light / distance, hit, media),
                                                             distance, &light};
                return intersector.template transmittance<E>(shadow);
            };
            if (!(dot(s.normal, blind.scene.lights[l].position - s.viewer_side) > incidence<Real> * blind.scene.extent))
                continue;
            EXPECT_EQ(share(planned), share(blind)) << "light " << l << ", solid " << key_solid(hit.key);
            ++compared;
        }
        return compared;
    }

    std::shared_ptr<const CompiledScene<Real>> compiled_;
    std::unique_ptr<Small> blind_, planned_;
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ShadowPlans, Reals);

TYPED_TEST(ShadowPlans, ChangeNoShareInTheScenes) {
    std::mt19937_64 random(1);
    int loaded = 0;
    for (const char* name :
         {"benchmark", "platonic", "infinity", "seed", "hard/lights-on-edges", "hard/tiny-beside-unit"}) {
        if (!this->load(test::shipped_scene(name))) continue;
        ++loaded;
        EXPECT_GT(this->compare_rays(random, 100000), 5000) << name;
    }
    EXPECT_GE(loaded, 3);
}

/// Solids and sheets close together and through one another, with lights among them, in them and close to their faces.
TYPED_TEST(ShadowPlans, ChangeNoShareInCrowds) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> at(-1, 1);
    const PlatonicSolid shapes[] = {PlatonicSolid::cube, PlatonicSolid::octahedron, PlatonicSolid::dodecahedron,
                                    PlatonicSolid::icosahedron};
    int loaded = 0, compared = 0;
    for (int n = 0; n < 60; ++n) {
        SceneDescription scene = test::shipped_scene("benchmark");
        const int material = scene.objects[0].material;
        scene.objects.resize(0);
        for (int i = 0; i < 5; ++i) {
            SolidObject solid;
            solid.solid = shapes[random() % std::size(shapes)];
            solid.center = {at(random), at(random), at(random)};
            solid.radius = 0.1 + 0.3 * std::abs(at(random));
            scene.objects.push_back({"", material, solid, ""});
        }
        for (int i = 0; i < 2; ++i) {
            TrianglesObject sheet;
            for (int c = 0; c < 3; ++c) sheet.vertices.push_back({at(random), at(random), at(random)});
            sheet.triangles.push_back({0, 1, 2});
            scene.objects.push_back({"", material, sheet, ""});
        }
        scene.lights.resize(4, scene.lights[0]);
        for (LightDescription& light : scene.lights)
            light.position = {1.2 * at(random), 1.2 * at(random), 1.2 * at(random)};
        if (!this->load(scene)) continue;
        ++loaded;
        compared += this->compare_rays(random, 20000);
    }
    EXPECT_GT(loaded, 10);
    EXPECT_GT(compared, 100000);
}

TYPED_TEST(ShadowPlans, LeaveOutMostOfWhatThereIs) {
    ASSERT_TRUE(this->load(test::shipped_scene("benchmark")));
    int near = 0;
    for (uint32_t l = 0; l < this->lights(); ++l) {
        EXPECT_EQ(this->plan().beyond[l], 7u) << "both lights are outside of all three solids";
        for (uint32_t s = 0; s < 3; ++s) near += std::popcount(this->plan().near[s][l]);
    }
    EXPECT_LE(near, 5) << "of 3 solids, 2 lights, 2 other solids and a floor";
}

}  // namespace
}  // namespace cistula
