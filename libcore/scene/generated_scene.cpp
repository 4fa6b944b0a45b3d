#include "scene/generated_scene.h"

#include <algorithm>
#include <random>
#include <utility>

#include "cistula/vec.h"
#include "scene/frame.h"
#include "scene/generated_mesh.h"
#include "scene/platonic.h"
#include "scene/quad.h"
#include "scene/rotation.h"

namespace cistula {
namespace {

using glm::dvec3;
using Shape = std::variant<SolidObject, TrianglesObject, MeshObject>;

/// The standard's engine, our own conversions. Two draws never stand in one expression but in braces: their
/// order is defined there.
class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((engine_() >> 32) * n >> 32); }
    bool chance(double share) { return unit() < share; }
    dvec3 in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    dvec3 direction() {
        for (;;) {
            const dvec3 p = in_cube(1);
            if (const double square = dot(p, p); square <= 1 && square > 0.01) return p / square_root(square);
        }
    }
    double of(std::initializer_list<double> list) { return list.begin()[below(static_cast<uint32_t>(list.size()))]; }
    dvec3 color() { return {between(0.05, 1), between(0.05, 1), between(0.05, 1)}; }
    dvec3 color_times(std::initializer_list<double> list) {
        const double strength = of(list);
        return strength * color();
    }

  private:
    std::mt19937_64 engine_;
};

/// What materials and lights may do; each calls for another mask of effects.h.
enum class Palette { plain, mirrors, lamps, everything };

constexpr double floor_height = -1;

TrianglesObject placed(TrianglesObject mesh, const dvec3& center, double scale, const dvec3& degrees) {
    const Rotation rotation(degrees);
    for (dvec3& p : mesh.vertices) p = center + rotation(scale * p);
    return mesh;
}

/// The mirror image of a solid beyond one of its faces, whose corners are exactly the same.
TrianglesObject beyond_face(const SolidObject& solid, const PlatonicShape::Face& face) {
    TrianglesObject mesh = triangulated_solid(solid);
    const dvec3 normal = Rotation(solid.rotation)(face.normal), on = mesh.vertices[face.vertices[0]];
    for (uint32_t i = 0; i < mesh.vertices.size(); ++i)
        if (std::find(face.vertices.begin(), face.vertices.end(), i) == face.vertices.end())
            mesh.vertices[i] -= 2 * dot(normal, mesh.vertices[i] - on) * normal;
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

class Maker {
  public:
    Maker(uint64_t seed, const std::string& files) : random_(seed), files_(files) {
        scene_.source = "generated scene " + std::to_string(seed);
    }

    SceneDescription make() {
        const double kind = random_.unit();
        palette_ = kind < 0.12   ? Palette::plain
                   : kind < 0.27 ? Palette::mirrors
                   : kind < 0.43 ? Palette::lamps
                                 : Palette::everything;
        add_surroundings();
        add_groups();
        if (random_.chance(0.2))
            std::reverse(scene_.objects.begin(), scene_.objects.end());  // another priority of media
        add_lights();
        set_camera();
        set_frame();
        set_film();
        for (size_t i = 0; i < scene_.objects.size(); ++i) scene_.objects[i].place = "/objects/" + std::to_string(i);
        return std::move(scene_);
    }

  private:
    // ---- materials

    int texture() {
        TextureDescription t;
        t.name = "texture " + std::to_string(scene_.textures.size());
        t.checker = {random_.color(), random_.chance(0.3) ? dvec3(0) : random_.color()};
        t.repeat = {random_.of({1, 2, 5.5}), random_.of({1, 3, 0.7})};
        const bool picture = random_.chance(0.5), marble = random_.chance(0.5);
        t.bilinear = random_.chance(0.6);
        if (picture && !files_.empty()) t.file = files_ + (marble ? "/marble.data" : "/floor.data");
        scene_.textures.push_back(t);
        return static_cast<int>(scene_.textures.size()) - 1;
    }

    dvec3 tint() {
        dvec3 t = random_.color();
        for (int c = 0; c < 3; ++c)
            if (random_.chance(0.15)) t[c] = random_.chance(0.5) ? 0 : 1;
        return t;
    }

    void share_out(MaterialDescription& m, bool see_through) {
        const uint32_t kind = see_through && random_.chance(0.8) ? 3 + random_.below(6) : random_.below(9);
        switch (kind) {
            case 0:
                break;  // opaque
            case 1:
                m.reflection = random_.between(0.1, 0.9);
                break;
            case 2:
                m.reflection = 1;
                break;
            case 3:
                m.transmission = 1;  // clear
                break;
            case 4:
                m.transmission = 1;
                m.tint = tint();
                break;
            case 5:
                m.reflection = random_.of({0.25, 0.1, 0.3});
                m.transmission = 1 - m.reflection;
                m.tint = random_.chance(0.5) ? dvec3(1) : tint();
                break;
            case 6:
                m.reflection = 0.3;
                m.transmission = 0.7000005;  // a little above 1 is let pass
                break;
            case 7:
                m.transmission = random_.between(0.2, 0.9);
                m.tint = tint();
                break;
            default:
                m.reflection = random_.between(0.05, 0.3);
                m.transmission = random_.between(0.4, 0.7);
                m.tint = tint();
        }
    }

    int material(bool see_through, bool textured) {
        MaterialDescription m;
        m.name = "material " + std::to_string(scene_.materials.size());
        m.color = random_.color();
        m.ambient = random_.of({0, 0.3, 1, 1});
        m.diffuse = random_.of({0, 0.5, 0.8, 1});
        m.specular = random_.of({0, 0, 0.4, 1});
        if (random_.chance(0.3)) m.specular_color = random_.color();
        m.exponent = random_.of({0, 1, 2, 5, 50, 110, 1024, 1025, 0.5, 2.5, 37.3, 4000.25});
        if (textured && random_.chance(0.6)) m.texture = texture();
        if (palette_ != Palette::plain) share_out(m, see_through);
        if (palette_ == Palette::everything) {
            m.index = random_.of({1, 1, 1.000001, 1.33, 1.5, 1.5, 2.4, 0.75, 0.5});
            m.fresnel = random_.chance(0.4);
            const double strength = random_.of({0.2, 1, 10});
            if (random_.chance(0.4)) m.absorption = strength * tint();
        }
        scene_.materials.push_back(m);
        return static_cast<int>(scene_.materials.size()) - 1;
    }

    // ---- objects

    void add(Shape shape, bool see_through) {
        bool textured = false;
        if (auto* triangles = std::get_if<TrianglesObject>(&shape)) {
            if (triangles->uvs.empty() && random_.chance(0.4))
                for (const dvec3& p : triangles->vertices) triangles->uvs.emplace_back(p.x, p.y + 0.5 * p.z);
            textured = !triangles->uvs.empty();
        } else if (auto* solid = std::get_if<SolidObject>(&shape)) {
            if (edge_lights_left_ > 0 && random_.chance(0.15) && !heavy_) add_edge_lights(solid->edge_lights);
        }
        ObjectDescription object;
        object.name = "object " + std::to_string(scene_.objects.size());
        object.material = reused_ >= 0 && !textured && random_.chance(0.2) ? reused_ : material(see_through, textured);
        if (scene_.materials[static_cast<size_t>(object.material)].texture < 0) reused_ = object.material;
        object.shape = std::move(shape);
        scene_.objects.push_back(std::move(object));
    }

    void add_edge_lights(EdgeLights& lights) {
        --edge_lights_left_;
        lights.count = 1 + static_cast<int>(random_.below(2));
        lights.color = random_.chance(0.15) ? dvec3(0) : random_.color_times({0.05, 0.2});
        if (palette_ < Palette::lamps || random_.chance(0.2)) return;
        lights.radius = random_.of({0.02, 0.06});
        if (random_.chance(0.6)) lights.glow = random_.color();
        lights.falloff = random_.chance(0.4);
    }

    dvec3 degrees() {
        const double kind = random_.unit();
        if (kind < 0.25) return dvec3(0);
        if (kind < 0.45) return {random_.of({0, 90, 180}), random_.of({0, 90, 270}), random_.of({0, 45, -90})};
        return random_.in_cube(180);
    }

    SolidObject solid(const dvec3& center, double radius) {
        SolidObject s;
        s.solid = static_cast<PlatonicSolid>(random_.below(5));
        s.center = center;
        s.radius = radius;
        s.rotation = degrees();
        return s;
    }

    SolidObject cube(const dvec3& center, double radius, const dvec3& rotation) {
        SolidObject s;
        s.solid = PlatonicSolid::cube;
        s.center = center;
        s.radius = radius;
        s.rotation = rotation;
        return s;
    }

    Shape closed_mesh(const dvec3& center, double radius) {
        const dvec3 turn = degrees();
        switch (random_.below(5)) {
            case 0:
                return placed(bumpy_sphere(static_cast<uint32_t>(random_.of({60, 200, 700, 1500}))), center, radius,
                              turn);
            case 1: {
                const uint32_t around = 5 + random_.below(28);
                return placed(torus(0.7, 0.3, around, 4 + random_.below(12)), center, radius, turn);
            }
            case 2:
                return placed(star(random_.of({0.4, 0.6})), center, radius, turn);
            case 3:
                heavy_ = true;
                if (!files_.empty()) {
                    MeshObject mesh;
                    mesh.file = files_ + "/knot.ply";
                    mesh.center = center;
                    mesh.scale = 0.6 * radius;
                    mesh.rotation = turn;
                    return mesh;
                }
                return placed(torus(0.6, 0.35, 40, 12), center, radius, turn);
            default:
                return triangulated_solid(solid(center, radius));
        }
    }

    Shape closed(const dvec3& center, double radius) {
        if (random_.chance(0.65)) return solid(center, radius);
        return closed_mesh(center, radius);
    }

    // ---- what stands around

    void add_surroundings() {
        if (random_.chance(0.65))
            add(quad_triangles(
                    {dvec3{-5, -5, floor_height}, {5, -5, floor_height}, {5, 5, floor_height}, {-5, 5, floor_height}}),
                false);
        if (random_.chance(0.2)) add(quad_triangles({dvec3{-4, 4, -1}, {4, 4, -1}, {4, 5, 4}, {-4, 5, 4}}), false);
        const double sheets = random_.unit();
        if (sheets < 0.08) {
            const auto count = static_cast<uint32_t>(random_.of({8, 40, 300}));
            const double size = random_.between(0.3, 2);
            heavy_ = count > 100;
            add(placed(triangle_soup(count, size, random_.below(1000)), dvec3(0), 2, dvec3(0)), true);
        } else if (sheets < 0.16) {
            TrianglesObject bowl = torus(1.5, 0.6, 16, 8);
            bowl.triangles.resize(bowl.triangles.size() / 2);
            const dvec3 center = random_.in_cube(0.5);
            add(placed(std::move(bowl), center, 1, degrees()), true);
        } else if (sheets < 0.24) {
            TrianglesObject pane;  // a fan, across what stands there
            pane.vertices = {{0, 0.1, 0}, {2, 0, -0.9}, {1.2, 0.3, 2}, {-1, 0, 2.2}, {-2.1, -0.2, 0.3}};
            pane.uvs = {{0.5, 0.5}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
            pane.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
            const dvec3 center = random_.in_cube(0.3);
            add(placed(std::move(pane), center, 1, dvec3(0, 0, random_.between(0, 90))), true);
        }
    }

    // ---- groups of solids

    void add_groups() {
        if (random_.chance(0.25)) return add_apart();
        const dvec3 places[] = {{-1.7, -1, 0}, {1.7, -1, 0}, {0, 1.9, 0}};
        const uint32_t count = 1 + random_.below(3), first = random_.below(3);
        const bool mixed = random_.chance(0.4);
        uint32_t theme = random_.below(10);
        for (uint32_t i = 0; i < count; ++i) {
            const dvec3 center = count == 1 ? dvec3(0) : places[(first + i) % 3];
            centers_.push_back(center);
            if (mixed) theme = random_.below(10);
            if (theme < 3)
                add_nested(center);
            else if (theme < 7)
                add_touching(center);
            else if (theme < 8)
                add_overlapping(center);
            else
                add(closed_mesh(center, random_.between(0.8, 1.1)), true);
        }
    }

    /// Convex solids that do not touch, in a grid: more than a plain loop takes, or fewer.
    void add_apart() {
        const uint32_t nx = 2 + random_.below(3), ny = 1 + random_.below(3), nz = 1 + random_.below(2);
        const bool lattice = random_.chance(0.3);
        reach_ = 0.6;
        for (uint32_t x = 0; x < nx; ++x)
            for (uint32_t y = 0; y < ny; ++y)
                for (uint32_t z = 0; z < nz; ++z) {
                    dvec3 center = 1.3 * dvec3(x - 0.5 * (nx - 1), y - 0.5 * (ny - 1), z);
                    if (!lattice) center += random_.in_cube(0.1);
                    const SolidObject s = solid(center, random_.between(0.2, 0.52));
                    cores_.push_back({s.center, s.radius});
                    centers_.push_back(s.center);
                    add(s, true);
                }
    }

    void add_nested(const dvec3& center) {
        const uint32_t count = 2 + random_.below(3);
        double radius = random_.between(0.9, 1.2);
        dvec3 at = center;
        for (uint32_t i = 0; i < count; ++i) {
            Shape shape = closed(at, radius);
            if (const auto* s = std::get_if<SolidObject>(&shape)) {
                cores_.push_back({at, radius});
                radius *= 0.95 * platonic_shape(s->solid).inradius;
            } else {
                radius *= 0.45;
            }
            if (random_.chance(0.3)) at += random_.in_cube(0.3 * radius);
            add(std::move(shape), true);
        }
    }

    void add_overlapping(const dvec3& center) {
        const uint32_t count = 2 + random_.below(3);
        for (uint32_t i = 0; i < count; ++i) {
            const dvec3 at = center + random_.in_cube(0.4);
            add(closed(at, random_.between(0.5, 0.9)), true);
        }
    }

    void add_touching(const dvec3& center) {
        switch (random_.below(7)) {
            case 0: {  // a row of cubes, cut along one diagonal or the other
                const dvec3 turn = degrees();
                const double radius = 0.6, step = 2 * radius * platonic_shape(PlatonicSolid::cube).inradius;
                const dvec3 along = Rotation(turn)(dvec3(step, 0, 0));
                const uint32_t count = 2 + random_.below(2);
                for (uint32_t i = 0; i < count; ++i) {
                    const dvec3 turned = turn + dvec3(random_.of({0, 90}), 0, 0);
                    const SolidObject s = cube(center + (i - 0.5 * (count - 1)) * along, radius, turned);
                    if (random_.chance(0.6))
                        add(s, true);
                    else
                        add(triangulated_solid(s), true);
                }
                break;
            }
            case 1:
            case 2: {  // a solid and its mirror image beyond a face
                const SolidObject s = solid(center, 0.7);
                const auto& faces = platonic_shape(s.solid).faces;
                TrianglesObject twin = beyond_face(s, faces[random_.below(static_cast<uint32_t>(faces.size()))]);
                const bool planes = random_.chance(0.5), twin_first = random_.chance(0.5);
                if (twin_first) add(twin, true);
                if (planes)
                    add(s, true);
                else
                    add(triangulated_solid(s), true);
                if (!twin_first) add(std::move(twin), true);
                break;
            }
            case 3: {  // two in the same place
                const SolidObject s = solid(center, 0.9);
                add(s, true);
                if (random_.chance(0.5))
                    add(s, true);
                else
                    add(triangulated_solid(s), true);
                break;
            }
            case 4: {  // faces in one plane that overlap in part
                SolidObject s = solid(center, 0.7);
                const auto& shape = platonic_shape(s.solid);
                const dvec3 normal = Rotation(s.rotation)(shape.faces.back().normal);
                cores_.push_back({s.center, s.radius});
                add(s, true);
                s.center += 2 * s.radius * shape.inradius * normal;
                add(s, true);
                break;
            }
            case 5: {  // cubes that lie on the floor and on one another
                const double half = platonic_shape(PlatonicSolid::cube).inradius;
                const double lower = random_.between(0.7, 1.1), upper = random_.between(0.3, 0.7);
                const dvec3 on_floor = center + dvec3(0, 0, floor_height + lower * half);
                add(cube(on_floor, lower, dvec3(0)), true);
                add(cube(on_floor + dvec3(0.1, 0, (lower + upper) * half), upper, dvec3(0, 0, 30)), true);
                break;
            }
            default: {  // corners on the faces, or on the corners, of what is around
                const dvec3 turn = degrees();
                const double half = platonic_shape(PlatonicSolid::cube).inradius;
                const bool octahedron = random_.chance(0.5);
                SolidObject inner = cube(center, octahedron ? half : 1, turn);
                inner.solid = octahedron ? PlatonicSolid::octahedron : PlatonicSolid::tetrahedron;
                add(cube(center, 1, turn), true);
                if (random_.chance(0.5))
                    add(inner, true);
                else
                    add(triangulated_solid(inner), true);
            }
        }
    }

    // ---- lights

    template <class Kind>
    const Kind* any_shape() {
        std::vector<const Kind*> all;
        for (const ObjectDescription& object : scene_.objects)
            if (const auto* shape = std::get_if<Kind>(&object.shape)) all.push_back(shape);
        return all.empty() ? nullptr : all[random_.below(static_cast<uint32_t>(all.size()))];
    }

    dvec3 light_position() {
        const uint32_t kind = random_.below(10);
        if (kind < 2 && !cores_.empty()) {
            const Core& core = cores_[random_.below(static_cast<uint32_t>(cores_.size()))];
            const double off = random_.of({0, 0.15}) * core.radius;
            return core.center + off * random_.direction();
        }
        if (kind < 4)
            if (const SolidObject* s = any_shape<SolidObject>()) {
                const auto& shape = platonic_shape(s->solid);
                const uint32_t face = random_.below(static_cast<uint32_t>(shape.faces.size()));
                if (random_.chance(0.25)) return world_vertices(*s)[shape.faces[face].vertices[0]];
                return s->center + Rotation(s->rotation)(s->radius * shape.inradius * shape.faces[face].normal);
            }
        if (kind < 6)
            if (const TrianglesObject* mesh = any_shape<TrianglesObject>()) {
                const auto& t = mesh->triangles[random_.below(static_cast<uint32_t>(mesh->triangles.size()))];
                const dvec3 &a = mesh->vertices[t[0]], &b = mesh->vertices[t[1]], &c = mesh->vertices[t[2]];
                const dvec3 on_edge = a + random_.of({0, 0.5, 0.3}) * (b - a);
                return random_.chance(0.7) ? on_edge : on_edge + 0.4 * (c - on_edge);
            }
        const dvec3 up = random_.direction();
        return random_.between(2.5, 6) * dvec3(up.x, up.y, magnitude(up.z));
    }

    void add_lights() {
        const auto count = static_cast<uint32_t>(random_.of({0, 1, 1, 2, 2, 3}));
        for (uint32_t i = 0; i < count; ++i) {
            LightDescription light;
            light.position = light_position();
            light.color = random_.chance(0.12) ? dvec3(0) : random_.color_times({0.3, 1, 2});
            if (palette_ >= Palette::lamps && random_.chance(0.6)) {
                light.radius = random_.of({0.05, 0.2, 0.5});
                light.falloff = random_.chance(0.5);
                if (random_.chance(0.5)) light.glow = 2.0 * random_.color();
            }
            light.place = "/lights/" + std::to_string(i);
            scene_.lights.push_back(light);
        }
        scene_.ambient = 0.6 * random_.color();
        if (random_.chance(0.88)) scene_.background = 0.7 * random_.color();
        if (count > 0 && random_.chance(0.15)) scene_.ambient = dvec3(0);
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

    /// Other units and another origin; a frame that is pinned.
    void set_frame() {
        const double scale = random_.chance(0.2) ? random_.of({0.01, 0.25, 137.5}) : 1;
        dvec3 offset(0);
        if (random_.chance(0.2))
            offset = {random_.between(-1000, 1000), random_.between(-10, 10), random_.of({0, 77.125})};
        if (scene_.camera.position_path) offset = dvec3(0);  // paths go round the origin
        const bool pinned = random_.chance(0.12), bound = random_.chance(0.5);
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

    struct Core {  // of a solid: a ball of a third of the radius lies inside
        dvec3 center;
        double radius;
    };

    SceneDescription scene_;
    Random random_;
    const std::string files_;
    Palette palette_ = Palette::plain;
    std::vector<Core> cores_;
    std::vector<dvec3> centers_;  // of groups
    double reach_ = 1;            // how far the camera stands off
    int reused_ = -1;             // a material without a texture
    int edge_lights_left_ = 2;    // solids that may still carry them
    bool heavy_ = false;          // a mesh of thousands of triangles: the plain loop takes its time
};

}  // namespace

SceneDescription generated_scene(uint64_t seed, const std::string& files) {
    return Maker(seed, files).make();
}

FrameSettings generated_settings(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(scene.film.width, scene.film.height);
    settings.supersample = scene.film.supersample;
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

}  // namespace cistula
