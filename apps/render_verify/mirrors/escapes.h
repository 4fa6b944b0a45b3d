// A ray reflected inside a closed solid stays inside: convex solids by state, meshes by the origins of new lines.
#pragma once

#include "apps/render_verify/mirrors/bounces_inside.h"

namespace cistula::verify::mirrors {

// 20 parts of 3,000 paths of 100 bounces: 6 million.
struct EscapesPlanes : BouncesInside {
    static constexpr const char* name = "mirrors/escapes/planes";
    static constexpr const char* exact =
        "a bounce inside one of five solids ends on another face, at most 64 u M outside";
    static constexpr Bound bound = no_failures("bounces");
    static void plan(Plan& plan) { plan_planes<EscapesPlanes>(plan, Start::as_rendered, 3000, 300); }
};

// 10 parts of 4,060 paths of 99 bounces: 4 million.
struct EscapesMeshes : BouncesInside {
    static constexpr const char* name = "mirrors/escapes/meshes";
    static constexpr const char* exact =
        "a bounce inside a torus, star or bumpy sphere ends on another triangle, inside by parity";
    static constexpr Bound bound = no_failures("bounces");
    static void plan(Plan& plan) { plan_meshes<EscapesMeshes>(plan, Start::as_rendered, 4060, 200); }
};

/// Lines that start inside a mesh on no face, as the camera's do and those that go straight on.
struct FirstLines : BouncesInside {
    static constexpr const char* name = "mirrors/escapes/camera-in-mesh";
    static constexpr const char* exact = "a line that starts inside a mesh, on no face, first meets a face from within";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_meshes<FirstLines>(plan, Start::as_rendered, 100000, 20000); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Hit<Real> hit = intersector.closest(anew(setup, draw));
        tally.expect(hit.found() && key_kind(hit.key) == CrossingKind::leave);
    }
};

struct EscapesByEpsilon : BouncesInside {
    static constexpr const char* name = "mirrors/broken/escapes-by-epsilon";
    static constexpr const char* exact =
        "an epsilon in the place of state lets rays out at edges, which must be caught";
    static constexpr Bound bound = must_fail(1000, "bounces");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_planes<EscapesByEpsilon>(plan, Start::epsilon, 3000, 100); }
};

struct EscapesByFaceAlone : BouncesInside {
    static constexpr const char* name = "mirrors/broken/escapes-without-apex";
    static constexpr const char* exact =
        "meshes whose lines start on the face, which alone is left out, must be caught";
    static constexpr Bound bound = must_fail(50, "bounces");
    static void plan(Plan& plan) { plan_meshes<EscapesByFaceAlone>(plan, Start::face_left_out, 4000, 100); }
};

}  // namespace cistula::verify::mirrors
