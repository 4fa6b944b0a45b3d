// What is far away makes the scene large: a solid, a sun, the origin of the coordinates.
#pragma once

#include "apps/render_verify/size/views.h"

namespace cistula::verify::size {

/// A solid at 1e7, in one direction and of one angular size with one at 1e5.
template <Look look>
struct FarSolid {
    static constexpr const char* exact = "a solid of 1e5 at 1e7: the picture with one of 1e3 at 1e5";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool float_warns = true;

    static void render(Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double far : {1e5, 1e7}) {
            scenes.push_back(lamp_lit(look, Shape::planes, PlatonicSolid::icosahedron, 20));
            add_object(scenes.back(), solid_object(PlatonicSolid::dodecahedron, {0, far, far / 100}, far / 100), 1);
        }
        expect_alike(stage, tally, scenes);
    }
};
struct FarSolidShadow : FarSolid<Look::shadow> {
    static constexpr const char* name = "size/far-solid/shadow";
};
struct FarSolidReflection : FarSolid<Look::reflection> {
    static constexpr const char* name = "size/far-solid/reflection";
};
struct FarSolidTexture : FarSolid<Look::texture> {
    static constexpr const char* name = "size/far-solid/texture";
};

/// A sun at 1e12, in one direction and of one angular size with one at 1e6.
template <Look look, bool seen = false>
struct Sun {
    static constexpr const char* exact = "a seen light of 5e10 at 1e12: the picture with one of 5e4 at 1e6";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool float_warns = true;

    static void render(Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double far : {1e6, 1e12}) {
            SceneDescription scene = view(look, Shape::planes, PlatonicSolid::dodecahedron, 20);
            const glm::dvec3 way = glm::dvec3(0.4, -0.5, 0.75) * far;
            add_light(scene, way).radius = 0.05 * far;
            if (seen) scene.camera.target = scene.camera.position + way;
            scenes.push_back(scene);
        }
        expect_alike(stage, tally, scenes);
    }
};
struct SunShadow : Sun<Look::shadow> {
    static constexpr const char* name = "size/sun/shadow";
};
struct SunReflection : Sun<Look::reflection> {
    static constexpr const char* name = "size/sun/reflection";
};
struct SunTexture : Sun<Look::texture> {
    static constexpr const char* name = "size/sun/texture";
};
struct SunSeen : Sun<Look::shadow, true> {
    static constexpr const char* name = "size/sun/seen";
};

/// A scene at 1e7 from the origin of its coordinates: no part of it is small beside its extent.
template <Look look>
struct AtOffset {
    static constexpr const char* exact = "a scene at 1e7 and -1e7: the picture of the one at the origin";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double offset : {0.0, 1e7, -1e7}) {
            const glm::dvec3 by(offset, -0.7 * offset, 0.3 * offset);
            SceneDescription scene = lamp_lit(look, Shape::planes, PlatonicSolid::dodecahedron, 20);
            for (ObjectDescription& object : scene.objects) {
                if (auto* solid = std::get_if<SolidObject>(&object.shape)) solid->center += by;
                if (auto* quad = std::get_if<TrianglesObject>(&object.shape))
                    for (glm::dvec3& p : quad->vertices) p += by;
            }
            for (LightDescription& light : scene.lights) light.position += by;
            scene.camera.position += by;
            scene.camera.target += by;
            scenes.push_back(scene);
        }
        expect_alike(stage, tally, scenes);
    }
};
struct OffsetShadow : AtOffset<Look::shadow> {
    static constexpr const char* name = "size/offset/shadow";
};
struct OffsetReflection : AtOffset<Look::reflection> {
    static constexpr const char* name = "size/offset/reflection";
};
struct OffsetTexture : AtOffset<Look::texture> {
    static constexpr const char* name = "size/offset/texture";
};

}  // namespace cistula::verify::size
