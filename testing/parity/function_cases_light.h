// Function parity, lighting and camera: Phong, camera rays, textures, visible lights, origins of rays that leave a
// triangle.
#pragma once

#include "cistula/lights/visible_light.h"
#include "cistula/model/camera.h"
#include "cistula/model/texture.h"
#include "cistula/shading/phong.h"
#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

template <class Real>
struct PhongCase : CaseOf<Real, 3> {
    static constexpr const char* name = "phong";
    struct Input {
        Material<Real> material;
        Light<Real> light;
        Vec3<Real> color, normal, to_light, to_viewer;
        Real n_l, distance;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.color = Vec3<Real>(Real(0.5)) + draw.in_cube<Real>(Real(0.5));
        in.material.diffuse = draw.unit<Real>();
        in.material.specular = Vec3<Real>(Real(0.5)) + draw.in_cube<Real>(Real(0.5));
        in.material.integer_exponent = draw.one_in(2) ? draw.between(0, 200) : -1;
        in.material.exponent = magnitude(draw.scaled<Real>(-4, 10));
        in.light.intensity = Vec3<Real>(Real(1)) + draw.in_cube<Real>(Real(1));
        in.light.clamp_distance = draw.one_in(2) ? Real(0) : magnitude(draw.scaled<Real>(-20, 2));
        in.normal = draw.direction<Real>();
        in.to_light = draw.direction<Real>();
        in.to_viewer = draw.direction<Real>();
        if (draw.one_in(2))  // where the highlight is
            in.to_viewer = renormalized(along(-in.to_light, Real(2) * dot(in.to_light, in.normal), in.normal));
        in.n_l = magnitude(dot(in.normal, in.to_light));
        in.distance = magnitude(draw.scaled<Real>(-20, 4));
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.vec(phong<Real, Effects<all_effects>>(in.material, in.color, in.light, in.normal, in.to_light, in.to_viewer,
                                                  in.n_l, in.distance));
    }
};

struct CameraCase : CaseOf<double, 3> {
    static constexpr const char* name = "camera_direction";
    struct Input {
        Camera camera;
        double x, y;
        int width, height;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.camera.position = Vec3<double>(0.0);
        in.camera.forward = draw.direction<double>();
        Vec3<double> right = cross(in.camera.forward, draw.direction<double>());
        const double size = length(right);
        right = size > 0x1p-20 ? right / size : Vec3<double>(1.0, 0.0, 0.0);
        in.camera.right = right;
        in.camera.up = cross(right, in.camera.forward);
        in.camera.tan_half_width = draw.one_in(4) ? 1.0 : magnitude(draw.scaled<double>(-12, draw.one_in(4) ? 39 : 6));
        in.width = draw.between(1, 8192);
        in.height = draw.between(1, 8192);
        in.x = draw.between(0, 16 * in.width) * 0.0625;
        in.y = draw.between(0, 16 * in.height) * 0.0625;
        if (draw.one_in(4)) in.x = in.width * draw.unit<double>();
        if (draw.one_in(8)) in.y = in.height * 0.5;
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.vec(camera_direction(in.camera, in.x, in.y, in.width, in.height));
    }
};

template <class Real>
struct TextureCase : CaseOf<Real, 3> {
    static constexpr const char* name = "texture";
    struct Input {
        Texture texture;
        Vec3<float> texels[16];
        Vec2<Real> uv;
    };
    CISTULA_HD static Real coordinate(Draw& draw, uint32_t size) {
        switch (draw.below(5)) {
            case 0:
                return draw.near(Real(draw.between(1, 64)) / Real(2 * size), 2);  // sides and centers of texels
            case 1:
                return Real(draw.between(-64, 64)) / Real(2 * size);
            case 2:
                return draw.scaled<Real>(-40, 40);
            case 3:
                return draw.any<Real>();
            default:
                return draw.centered<Real>(Real(3));
        }
    }
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.texture.width = draw.below(4) + 1;
        in.texture.height = draw.below(4) + 1;
        in.texture.first_texel = 0;
        in.texture.filter = draw.one_in(4) ? TextureFilter::nearest : TextureFilter::bilinear;
        for (TextureWrap& wrap : in.texture.wrap)
            wrap = draw.one_in(2) ? TextureWrap::repeat : TextureWrap(draw.below(3));
        for (double& repeat : in.texture.repeat) repeat = draw.one_in(2) ? 1.0 : draw.scaled<double>(-4, 4);
        for (Vec3<float>& texel : in.texels) texel = Vec3<float>(0.5f) + draw.in_cube<float>(0.5f);
        in.uv.x = coordinate(draw, in.texture.width);
        in.uv.y = coordinate(draw, in.texture.height);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene;
        scene.texels = {in.texels, 16};
        out.vec(texture_at(scene, in.texture, in.uv));
    }
};

/// Case: two spheres, often at equal distances, and a ray that passes near their outlines.
template <class Real>
struct VisibleLightCase : CaseOf<Real, 2> {
    static constexpr const char* name = "seen_light";
    struct Input {
        VisibleLight<Real> lights[2];
        Ray<Real> ray;
        Real limit;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        for (VisibleLight<Real>& light : in.lights) {
            light.center = draw.in_cube<Real>(Real(1));
            light.radius = magnitude(draw.scaled<Real>(-16, -1));
            light.radiance = Vec3<Real>(Real(1));
        }
        if (draw.one_in(4)) in.lights[1] = in.lights[0];
        const VisibleLight<Real>& aimed = in.lights[draw.below(2)];
        in.ray.origin = draw.in_cube<Real>(Real(3));
        if (draw.one_in(8)) in.ray.origin = along(aimed.center, aimed.radius, draw.direction<Real>());
        Vec3<Real> target = aimed.center;
        const Real off = draw.one_in(2) ? draw.unit<Real>() : draw.near(Real(1), 8);
        target = along(target, off * aimed.radius, draw.direction<Real>());
        in.ray.direction = draw.one_in(8) ? draw.direction<Real>() : normalized(target - in.ray.origin);
        if (draw.one_in(4)) in.ray.after = {draw.unit<Real>() * Real(4), 1};
        in.limit = draw.one_in(2) ? RealTraits<Real>::infinity : draw.unit<Real>() * Real(4);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene;
        scene.visible_lights = {in.lights, 2};
        const VisibleLightHit<Real> hit = closest_visible_light(scene, in.ray, in.limit);
        out.real(hit.t);
        out.bits(hit.light);
    }
};

/// Case: origins of rays that leave a triangle.
template <class Real>
struct ApexCase : CaseOf<Real, 6> {
    static constexpr const char* name = "apex";
    struct Input {
        Vec3<Real> corner[3];
        Real u, v, height;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        const int size = draw.one_in(2) ? 0 : draw.between(-60, 0);
        for (Vec3<Real>& corner : in.corner) corner = draw.in_cube<Real>(two_to<Real>(size));
        if (draw.one_in(8)) in.corner[2] = in.corner[0] + (in.corner[1] - in.corner[0]) * Real(3);  // no area
        in.u = draw.unit<Real>();
        in.v = (Real(1) - in.u) * draw.unit<Real>();
        in.height = magnitude(draw.scaled<Real>(-40, -1));
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const Vec3<Real> ab = in.corner[1] - in.corner[0], ac = in.corner[2] - in.corner[0];
        const Vec3<Real> normal = triangle_normal(ab, ac);
        const Vec3<Real> point = along(along(in.corner[0], in.u, ab), in.v, ac);
        const Vec3<Real> centroid = (in.corner[0] + in.corner[1] + in.corner[2]) * Real(1.0 / 3.0);
        out.vec(normal);
        out.vec(Apex<Real>::of(centroid, normal, in.height, Real(1.5)).from(point));
    }
};

}  // namespace cistula::parity
