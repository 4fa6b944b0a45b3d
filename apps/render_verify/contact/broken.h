// Cases without the contact rule: what it is for must be seen.
#pragma once

#include <memory>

#include "apps/render_verify/contact/apart.h"
#include "apps/render_verify/contact/blocks.h"
#include "apps/render_verify/contact/decals.h"
#include "apps/render_verify/contact/invisible.h"
#include "apps/render_verify/contact/optical.h"
#include "apps/render_verify/contact/shadows.h"
#include "testing/reference_renderers.h"

namespace cistula::verify::contact {

/// A film of a scene in which no plane is shared.
template <class Real>
Film film_without_contacts(const SceneDescription& scene, const FrameSettings& settings, int frame) {
    std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    compiled->shared_planes.clear();
    for (auto* numbers :
         {&compiled->slab_planes, &compiled->triangle_planes, &compiled->near_planes, &compiled->plane_solids})
        numbers->clear();
    for (Solid& solid : compiled->solids) solid.near_count = 0;
    Film film;
    RenderProgress progress;
    make_host_renderer<Real>(compiled, HostIntersector::brute)
        ->render(camera_at(scene.camera, frame), settings, film, progress);
    return film;
}

/// A case without the contact rule, on the plain loop whatever the intersector.
template <class Case>
struct Without {
    static constexpr const char* exact = "without shared planes the case fails";
    static constexpr Bound bound = must_fail(5, "pixels");

    static void render(Stage& stage, Tally& tally) {
        Stage without(true, stage.precision, stage.intersector,
                      stage.in_double() ? film_without_contacts<double> : film_without_contacts<float>);
        Case::render(without, tally);
    }
};
/// Cases that measure fail where a pixel is beyond their bound.
template <class Case>
struct WithoutMeasured : Without<Case> {
    static constexpr Bound bound{Measure::worst, true, {0.01, 0.01}, "of 1"};
};

struct BrokenInvisible : WithoutMeasured<InvisibleOnFloor> {
    static constexpr const char* name = "contact/broken/invisible/on-a-floor";
};
struct BrokenInvisibleInCorner : WithoutMeasured<InvisibleInCorner> {
    static constexpr const char* name = "contact/broken/invisible/in-a-corner";
};
struct BrokenBlocks : Without<EightBlocks> {
    static constexpr const char* name = "contact/broken/blocks";
};
struct BrokenOptical : Without<OpticalContact> {
    static constexpr const char* name = "contact/broken/optical";
};
struct BrokenDecals : Without<DecalsOnFloor> {
    static constexpr const char* name = "contact/broken/decals";
};
struct BrokenDecalsOnSolid : Without<DecalsOnSolid> {
    static constexpr const char* name = "contact/broken/decals/on-a-solid";
};
struct BrokenTintedShadow : WithoutMeasured<TintedShadow> {
    static constexpr const char* name = "contact/broken/tinted-shadow";
};
struct BrokenApart : Without<ApartOnFloor> {
    static constexpr const char* name = "contact/broken/apart/on-a-floor";
};
struct BrokenApartStack : Without<ApartStack> {
    static constexpr const char* name = "contact/broken/apart/stack";
};

}  // namespace cistula::verify::contact
