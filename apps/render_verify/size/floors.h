// Floors up to 1e9 times the size of what stands on them.
#pragma once

#include "apps/render_verify/size/views.h"

namespace cistula::verify::size {

template <Look look, Shape shape, PlatonicSolid... kinds>
struct OnFloor {
    static constexpr const char* exact = "floors of half-size 1e3 to 1e9: the picture of one of 512";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool float_warns = true;

    static void render(Stage& stage, Tally& tally) {
        for (const PlatonicSolid kind : {kinds...}) {
            std::vector<SceneDescription> scenes;
            for (const double half_size : {512.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9})
                scenes.push_back(lamp_lit(look, shape, kind, half_size));
            expect_alike(stage, tally, scenes);
        }
    }
};

struct FloorShadow : OnFloor<Look::shadow, Shape::planes, PlatonicSolid::dodecahedron, PlatonicSolid::tetrahedron> {
    static constexpr const char* name = "size/floor/shadow/planes";
};
struct FloorShadowOfMesh : OnFloor<Look::shadow, Shape::triangles, PlatonicSolid::icosahedron, PlatonicSolid::cube> {
    static constexpr const char* name = "size/floor/shadow/triangles";
};
struct FloorInBody : OnFloor<Look::reflection, Shape::planes, PlatonicSolid::dodecahedron, PlatonicSolid::cube> {
    static constexpr const char* name = "size/floor/reflection/planes";
};
struct FloorInMesh : OnFloor<Look::reflection, Shape::triangles, PlatonicSolid::octahedron> {
    static constexpr const char* name = "size/floor/reflection/triangles";
};
struct FloorMirror : OnFloor<Look::mirror, Shape::planes, PlatonicSolid::icosahedron> {
    static constexpr const char* name = "size/floor/mirror";
};
struct FloorGlass : OnFloor<Look::glass, Shape::planes, PlatonicSolid::cube, PlatonicSolid::octahedron> {
    static constexpr const char* name = "size/floor/glass/planes";
};
struct FloorGlassMesh : OnFloor<Look::glass, Shape::triangles, PlatonicSolid::cube> {
    static constexpr const char* name = "size/floor/glass/triangles";
};
struct FloorTexture : OnFloor<Look::texture, Shape::planes, PlatonicSolid::dodecahedron> {
    static constexpr const char* name = "size/floor/texture";
};

/// What float would show where it warns.
struct FloatOnFloor {
    static constexpr const char* name = "size/broken/float-on-a-floor-of-1e6";
    static constexpr const char* exact = "without the warning: in float the shadow of a unit body is cut";
    static constexpr Bound bound{Measure::failures, true, {20, 0}, "pixels"};

    static void render(Stage& stage, Tally& tally) {
        const auto film = [&](double half_size) {
            const SceneDescription scene =
                lamp_lit(Look::shadow, Shape::planes, PlatonicSolid::dodecahedron, half_size);
            return stage.render(scene, scene.film.width, scene.film.height);
        };
        expect_alike(tally, film(1e6), film(512));
    }
};

}  // namespace cistula::verify::size
