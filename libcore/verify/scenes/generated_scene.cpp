#include "verify/scenes/generated_scene.h"

#include <algorithm>
#include <utility>

#include "image/reader/picture_reader.h"
#include "render/renderer.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "verify/scenes/generated_parts.h"

namespace cistula {
namespace generated {
namespace {

/// Makes everything but objects and materials.
class Maker : Part {
  public:
    explicit Maker(State& state) : Part(state), state_(state) {}

    void make() {
        const double palette = random_.unit();
        state_.palette = palette < 0.08   ? Palette::opaque
                         : palette < 0.15 ? Palette::mirrors
                         : palette < 0.22 ? Palette::clear
                         : palette < 0.34 ? Palette::lights
                                          : Palette::everything;
        const double bodies = random_.unit();
        state_.bodies = bodies < (palette_ == Palette::everything ? 0.4 : 0.7) ? Bodies::flat
                        : bodies < 0.86                                        ? Bodies::all
                                                                               : Bodies::balls;
        add_objects(state_);
        if (random_.chance(0.2))
            std::reverse(scene_.objects.begin(), scene_.objects.end());  // reverses the priority of media
        add_lights();
        set_camera();
        set_frame();
        set_film();
        for (size_t i = 0; i < scene_.objects.size(); ++i) scene_.objects[i].place = "/objects/" + std::to_string(i);
        if (random_.chance(bodies_ == Bodies::flat ? 0.1 : 0.5)) set_keys(state_, unit_);
    }

  private:
    // ---- lights

    template <class Kind>
    const Kind* any_shape() {
        std::vector<const Kind*> all;
        for (const ObjectDescription& object : scene_.objects)
            if (const auto* shape = std::get_if<Kind>(&object.shape)) all.push_back(shape);
        return all.empty() ? nullptr : all[random_.below(static_cast<uint32_t>(all.size()))];
    }

    dvec3 light_position() {
        const uint32_t kind = random_.below(12);
        if (kind < 2 && !cores_.empty()) {
            const Core& core = cores_[random_.below(static_cast<uint32_t>(cores_.size()))];
            const double off = random_.of({0, 0.15}) * core.radius;
            return core.center + off * random_.direction();
        }
        if (palette_ < Palette::lights) return far_position();  // lesser masks know no lights on faces
        if (kind < 4)
            if (const SolidObject* s = any_shape<SolidObject>()) {
                const Polyhedron& shape = polyhedron_of(*s);
                const uint32_t face = random_.below(static_cast<uint32_t>(shape.faces.size()));
                if (random_.chance(0.25)) return world_vertices(*s)[shape.faces[face].vertices[0]];
                return s->center + Rotation(s->rotation)(s->radius * offset_of(shape, shape.faces[face]) *
                                                         shape.faces[face].normal);
            }
        if (kind < 6)
            if (const TrianglesObject* mesh = any_shape<TrianglesObject>()) {
                const auto& t = mesh->triangles[random_.below(static_cast<uint32_t>(mesh->triangles.size()))];
                const dvec3 &a = mesh->vertices[t[0]], &b = mesh->vertices[t[1]], &c = mesh->vertices[t[2]];
                const dvec3 on_edge = a + random_.of({0, 0.5, 0.3}) * (b - a);
                return random_.chance(0.7) ? on_edge : on_edge + 0.4 * (c - on_edge);
            }
        if (kind < 8)
            if (const DiskObject* disk = any_shape<DiskObject>()) {
                const dvec3 across = normalized(cross(disk->normal, random_.direction()));
                const double off = random_.of({0, 0.5, 1});
                return disk->center + (disk->is_endless() ? 2 * off : off * disk->radius) * across;
            }
        return far_position();
    }

    dvec3 far_position() {
        const dvec3 up = random_.direction();
        return random_.between(2.5, 6) * dvec3(up.x, up.y, magnitude(up.z));
    }

    /// The position, or one farther inside where it lies on a ball, which no light may.
    dvec3 off_balls(dvec3 position) {
        for (const ObjectDescription& object : scene_.objects)
            if (const auto* ball = std::get_if<SphereObject>(&object.shape)) {
                const dvec3 from_center = position - ball->center;
                if (magnitude(length(from_center) - ball->radius) < 0.001 * ball->radius)
                    position = ball->center + 0.9375 * from_center;
            }
        return position;
    }

    void add_lights() {
        const auto count = static_cast<uint32_t>(random_.of({0, 1, 1, 2, 2, 3}));
        for (uint32_t i = 0; i < count; ++i) {
            LightDescription light;
            light.position = off_balls(light_position());
            light.color = random_.chance(0.12) ? dvec3(0) : random_.color_times({0.3, 1, 2});
            if (palette_ >= Palette::lights && random_.chance(0.6)) {
                light.radius = random_.of({0.05, 0.2, 0.5});
                light.falloff = palette_ == Palette::everything && random_.chance(0.6);
                if (random_.chance(0.5)) light.glow = 2.0 * random_.color();
            }
            light.place = "/lights/" + std::to_string(i);
            scene_.lights.push_back(light);
        }
        scene_.ambient = 0.6 * random_.color();
        if (random_.chance(0.88)) scene_.background = 0.7 * random_.color();
        if ((bodies_ != Bodies::flat || palette_ == Palette::everything) && random_.chance(0.35)) add_sky();
        if (count > 0 && random_.chance(0.15)) scene_.ambient = dvec3(0);
    }

    /// Puts a gradient or a picture in place of the background.
    void add_sky() {
        const dvec3 around = std::exchange(scene_.background, dvec3(0));
        if (random_.chance(0.6)) {
            scene_.sky = SkyDescription{.axis = random_.direction(),
                                        .stops = {{20, around}, {80, 0.5 * around}, {80, dvec3(0.1)}}};
            return;
        }
        auto texels = std::make_shared<TexelArray>(TexelArray{.width = 8, .height = 4, .values = {}});
        auto& values = texels->values.emplace<std::vector<float>>();
        for (int i = 0; i < 8 * 4 * 3; ++i) values.push_back(static_cast<float>(random_.unit()));
        scene_.sky = SkyDescription{.texture = static_cast<int>(scene_.textures.size()),
                                    .rotation = random_.in_cube(180),
                                    .scale = random_.of({0.5, 1})};
        TextureDescription picture{.name = "sky", .texels = std::move(texels)};
        picture.bilinear = random_.chance(0.6);
        scene_.textures.push_back(std::move(picture));
    }

    // ---- camera, frame and film

    void set_camera() {
        CameraDescription& camera = scene_.camera;
        camera.field_of_view = random_.between(40, 70);
        const dvec3 center = centers_[random_.below(static_cast<uint32_t>(centers_.size()))];
        camera.target = center + random_.in_cube(0.3);
        const dvec3 from = random_.direction();
        camera.position = center + random_.between(2.3, 4.5) * reach_ * dvec3(from.x, from.y, magnitude(from.z));
        const double kind = random_.unit();
        if (kind < 0.2 && !cores_.empty()) {
            const Core& core = cores_[random_.below(static_cast<uint32_t>(cores_.size()))];
            camera.position = core.center + 0.15 * core.radius * random_.direction();
            camera.target = center + random_.in_cube(1);
            camera.field_of_view = random_.between(80, 130);
        } else if (kind < 0.35) {  // on an axis and along it
            const uint32_t axis = random_.below(3);
            camera.position = camera.target = dvec3(0);
            camera.position[static_cast<int>(axis)] = axis == 1 ? -4.5 * reach_ : 4.5 * reach_;
            camera.up = axis == 2 ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
        } else if (kind < 0.4) {  // in the plane of the floor
            camera.position = {5, 0.5, floor_height};
            camera.target = {0, 0.5, floor_height};
        } else if (kind < 0.46) {
            camera.position *= 60;
            camera.field_of_view *= 0.017;
        } else if (kind < 0.56) {
            camera.position_path = {4, 2, random_.between(0, 6), 0.5, 0.3, 0.3, 0.2, 0.1, random_.between(0, 6), 1};
            if (random_.chance(0.5))
                camera.target_path = {0.5, 0, 1, 0.2, 0.1, 0.3, 0.2, 0.1, 2, random_.between(0, 6)};
        }
        const dvec3 tilted = random_.direction();
        const dvec3 view = camera.target - camera.position;
        if (random_.chance(0.2) && length(cross(tilted, view)) > 0.1 * length(view)) camera.up = tilted;
        if (!(length(cross(camera.up, view)) > 0.01 * length(view))) camera.up = {0, 1, 0.5};
    }

    /// Changes units and origin, and pins the frame at times.
    void set_frame() {
        const double scale = random_.chance(0.2) ? random_.of({0.01, 0.25, 137.5}) : 1;
        dvec3 offset(0);
        if (random_.chance(0.2))
            offset = {random_.between(-1000, 1000), random_.between(-10, 10), random_.of({0, 77.125})};
        if (scene_.camera.position_path) offset = dvec3(0);  // camera paths are around the origin
        const bool pinned = random_.chance(0.12);
        const bool bound = random_.chance(0.5);
        unit_ = scale;
        if (scale != 1 || offset != dvec3(0)) move(scale, offset);
        if (!pinned) return;
        FrameOfReference frame;
        frame.center = offset;
        for (double reach = 16 * scale; reach >= 1.9; reach *= 0.5) --frame.scale;
        for (double reach = 16 * scale; reach < 0.9; reach *= 2) ++frame.scale;
        if (bound) frame.bound = 0x1p20;
        scene_.frame = frame;
    }

    void move(double scale, const dvec3& offset) {
        const auto point = [&](dvec3& p) { p = scale * p + offset; };
        const auto light = [&](dvec3& color, double& radius, bool falloff) {
            radius *= scale;
            if (falloff) color *= scale * scale;
        };
        for (ObjectDescription& object : scene_.objects) {
            if (auto* s = std::get_if<SolidObject>(&object.shape)) {
                point(s->center);
                s->radius *= scale;
                light(s->edge_lights.color, s->edge_lights.radius, s->edge_lights.falloff);
            } else if (auto* ball = std::get_if<SphereObject>(&object.shape)) {
                point(ball->center);
                ball->radius *= scale;
            } else if (auto* disk = std::get_if<DiskObject>(&object.shape)) {
                point(disk->center);
                disk->radius *= scale;
                if (disk->is_endless()) *disk = DiskObject::plane(disk->normal, dot(disk->normal, disk->center));
            } else if (auto* triangles = std::get_if<TrianglesObject>(&object.shape)) {
                for (dvec3& p : triangles->vertices) point(p);
            } else {
                auto& mesh = std::get<MeshObject>(object.shape);
                point(mesh.center);
                mesh.scale *= scale;
            }
        }
        for (LightDescription& l : scene_.lights) {
            point(l.position);
            light(l.color, l.radius, l.falloff);
        }
        for (MaterialDescription& m : scene_.materials) m.absorption /= scale;
        point(scene_.camera.position);
        point(scene_.camera.target);
        for (auto* path : {&scene_.camera.position_path, &scene_.camera.target_path})
            if (*path)
                for (double* length : {&(*path)->r0, &(*path)->z0, &(*path)->Ar, &(*path)->Az}) *length *= scale;
    }

    void set_film() {
        constexpr int sizes[][2] = {{48, 32}, {47, 31}, {40, 40}, {64, 48}};
        const auto& size = sizes[heavy_ ? 0 : random_.below(4)];
        scene_.film.width = size[0];
        scene_.film.height = size[1];
        scene_.film.supersample = static_cast<int>(random_.of({1, 1, 1, 2, 3}));
        scene_.depth = 1 + static_cast<int>(random_.below(10));
        if (scene_.depth < 3 && random_.chance(0.5)) scene_.depth += 4;
        if (scene_.film.supersample > 1 && scene_.depth > 7) scene_.depth = 7;
        if (random_.chance(0.25)) scene_.cutoff = random_.of({1e-3, 0.02, 0.5});
        if (!heavy_) return;
        scene_.film.supersample = 1;
        scene_.depth = 1 + (scene_.depth - 1) / 2;
    }

    State& state_;
    double unit_ = 1;  // a length of 1 before the scene was moved
};

}  // namespace
}  // namespace generated

SceneDescription generated_scene(uint64_t seed, const std::string& files) {
    generated::State state(seed, files);
    state.scene.source = "generated scene " + std::to_string(seed);
    generated::Maker(state).make();
    return std::move(state.scene);
}

FrameSettings generated_settings(const SceneDescription& scene) {
    return frame_settings(scene);
}

}  // namespace cistula
