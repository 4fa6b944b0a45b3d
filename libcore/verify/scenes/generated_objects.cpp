#include <algorithm>
#include <utility>

#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "scene/readers/meshes/polygon.h"
#include "verify/scenes/generated_parts.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::generated {
namespace {

/// The mirror image of a solid at one of its faces, with exactly the same corners there.
TrianglesObject beyond_face(const SolidObject& solid, const Polyhedron::Face& face) {
    TrianglesObject mesh = triangulated_solid(solid);
    const dvec3 normal = Rotation(solid.rotation)(face.normal);
    const dvec3 on = mesh.vertices[face.vertices[0]];
    for (uint32_t i = 0; i < mesh.vertices.size(); ++i)
        if (std::find(face.vertices.begin(), face.vertices.end(), i) == face.vertices.end())
            mesh.vertices[i] -= 2 * dot(normal, mesh.vertices[i] - on) * normal;
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TrianglesObject placed(TrianglesObject mesh, const dvec3& center, double scale, const dvec3& degrees) {
    const Rotation rotation(degrees);
    for (dvec3& p : mesh.vertices) p = center + rotation(scale * p);
    return mesh;
}

SolidObject cube(const dvec3& center, double radius, const dvec3& rotation) {
    return {.solid = PlatonicSolid::cube, .center = center, .radius = radius, .rotation = rotation};
}

/// A body that is no Platonic solid and reaches no farther than 1 from the origin.
std::shared_ptr<const Polyhedron> other_body(size_t number) {
    static const std::shared_ptr<const Polyhedron> bodies[] = {
        std::make_shared<Polyhedron>(box_body({1.3, 0.9, 0.7})),
        archimedean_body("truncated-cube"),
        std::make_shared<Polyhedron>(body_over_polygon(PolygonBody::prism, 7, 0.7, 1.2)),
        archimedean_body("snub-dodecahedron"),
        std::make_shared<Polyhedron>(body_over_polygon(PolygonBody::antiprism, 5, 0.7, 1)),
        std::make_shared<Polyhedron>(body_over_polygon(PolygonBody::pyramid, 4, 0.8, 1.1))};
    return bodies[number % std::size(bodies)];
}

using Shape = decltype(ObjectDescription::shape);

/// Adds a floor, walls and sheets, then groups of closed bodies, with their materials.
class Objects : Part {
  public:
    using Part::Part;

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
            TrianglesObject pane;  // a fan through what stands there
            pane.vertices = {{0, 0.1, 0}, {2, 0, -0.9}, {1.2, 0.3, 2}, {-1, 0, 2.2}, {-2.1, -0.2, 0.3}};
            pane.uvs = {{0.5, 0.5}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
            pane.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
            const dvec3 center = random_.in_cube(0.3);
            add(placed(std::move(pane), center, 1, dvec3(0, 0, random_.between(0, 90))), true);
        }
    }

    void add_groups() {
        if (random_.chance(0.25)) return add_apart();
        const dvec3 places[] = {{-1.7, -1, 0}, {1.7, -1, 0}, {0, 1.9, 0}};
        const uint32_t count = 1 + random_.below(3);
        const uint32_t first = random_.below(3);
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

  private:
    void add(Shape shape, bool see_through) {
        bool textured = false;
        if (auto* triangles = std::get_if<TrianglesObject>(&shape)) {
            if (triangles->uvs.empty() && random_.chance(0.4))
                for (const dvec3& p : triangles->vertices) triangles->uvs.emplace_back(p.x, p.y + 0.5 * p.z);
            textured = !triangles->uvs.empty();
            if (scene_.objects.size() % 5 == 3) triangles->keep_triangles = false;  // convex ones are given by planes
            if (scene_.objects.size() % 4 == 2) triangles->smooth = 100;
        } else if (auto* solid = std::get_if<SolidObject>(&shape)) {
            if (edge_lights_left_ > 0 && random_.chance(0.15) && !heavy_) add_edge_lights(solid->edge_lights);
        }
        ObjectDescription object;
        object.name = "object " + std::to_string(scene_.objects.size());
        object.material =
            reused_ >= 0 && !textured && random_.chance(0.2) ? reused_ : add_material(see_through, textured);
        if (scene_.materials[static_cast<size_t>(object.material)].texture < 0) reused_ = object.material;
        object.shape = std::move(shape);
        scene_.objects.push_back(std::move(object));
    }

    /// Adds a solid as planes or as a mesh.
    void add_of(bool planes, const SolidObject& solid) {
        add(planes ? Shape(solid) : Shape(triangulated_solid(solid)), true);
    }

    void add_edge_lights(EdgeLights& lights) {
        --edge_lights_left_;
        lights.count = 1 + static_cast<int>(random_.below(2));
        lights.color = random_.chance(0.15) ? dvec3(0) : random_.color_times({0.05, 0.2});
        if (palette_ < Palette::lights || random_.chance(0.2)) return;
        lights.radius = random_.of({0.02, 0.06});
        if (random_.chance(0.6)) lights.glow = random_.color();
        lights.falloff = random_.chance(0.4);
    }

    /// Adds convex solids that do not touch, in a grid: sometimes more than the plain loop takes, sometimes fewer.
    void add_apart() {
        const uint32_t nx = 2 + random_.below(3);
        const uint32_t ny = 1 + random_.below(3);
        const uint32_t nz = 1 + random_.below(2);
        const bool lattice = random_.chance(0.3);
        reach_ = 0.6;
        for (uint32_t x = 0; x < nx; ++x)
            for (uint32_t y = 0; y < ny; ++y)
                for (uint32_t z = 0; z < nz; ++z) {
                    dvec3 center = 1.3 * dvec3(x - 0.5 * (nx - 1), y - 0.5 * (ny - 1), z);
                    if (!lattice) center += random_.in_cube(0.1);
                    SolidObject s = solid(center, random_.between(0.2, 0.52));
                    if (scene_.objects.size() % 3 == 2) s.body = other_body(scene_.objects.size() / 3);
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
                radius *= 0.95 * polyhedron_of(*s).inradius;
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
                const double radius = 0.6;
                const double step = 2 * radius * platonic_shape(PlatonicSolid::cube).inradius;
                const dvec3 along = Rotation(turn)(dvec3(step, 0, 0));
                const uint32_t count = 2 + random_.below(2);
                for (uint32_t i = 0; i < count; ++i) {
                    const dvec3 turned = turn + dvec3(random_.of({0, 90}), 0, 0);
                    const SolidObject s = cube(center + (i - 0.5 * (count - 1)) * along, radius, turned);
                    add_of(random_.chance(0.6), s);
                }
                break;
            }
            case 1:
            case 2: {  // a solid and its mirror image beyond a face
                const SolidObject s = solid(center, 0.7);
                const auto& faces = platonic_shape(s.solid).faces;
                TrianglesObject twin = beyond_face(s, faces[random_.below(static_cast<uint32_t>(faces.size()))]);
                const bool planes = random_.chance(0.5);
                const bool twin_first = random_.chance(0.5);
                if (twin_first) add(twin, true);
                add_of(planes, s);
                if (!twin_first) add(std::move(twin), true);
                break;
            }
            case 3: {  // two solids in the same place
                const SolidObject s = solid(center, 0.9);
                add(s, true);
                add_of(random_.chance(0.5), s);
                break;
            }
            case 4: {  // coplanar faces that overlap in part
                SolidObject s = solid(center, 0.7);
                const auto& shape = platonic_shape(s.solid);
                const dvec3 normal = Rotation(s.rotation)(shape.faces.back().normal);
                cores_.push_back({s.center, s.radius});
                add(s, true);
                s.center += 2 * s.radius * shape.inradius * normal;
                add(s, true);
                break;
            }
            case 5: {  // cubes on the floor and on one another
                const double half = platonic_shape(PlatonicSolid::cube).inradius;
                const double lower = random_.between(0.7, 1.1);
                const double upper = random_.between(0.3, 0.7);
                const dvec3 on_floor = center + dvec3(0, 0, floor_height + lower * half);
                add(cube(on_floor, lower, dvec3(0)), true);
                add(cube(on_floor + dvec3(0.1, 0, (lower + upper) * half), upper, dvec3(0, 0, 30)), true);
                break;
            }
            default: {  // corners on the faces or corners of a surrounding solid
                const dvec3 turn = degrees();
                const double half = platonic_shape(PlatonicSolid::cube).inradius;
                const bool octahedron = random_.chance(0.5);
                SolidObject inner = cube(center, octahedron ? half : 1, turn);
                inner.solid = octahedron ? PlatonicSolid::octahedron : PlatonicSolid::tetrahedron;
                add(cube(center, 1, turn), true);
                add_of(random_.chance(0.5), inner);
            }
        }
    }

    // ---- materials

    int texture() {
        TextureDescription t;
        t.name = "texture " + std::to_string(scene_.textures.size());
        t.checker = {random_.color(), random_.chance(0.3) ? dvec3(0) : random_.color()};
        t.repeat = {random_.of({1, 2, 5.5}), random_.of({1, 3, 0.7})};
        const bool picture = random_.chance(0.5);
        const bool marble = random_.chance(0.5);
        t.bilinear = random_.chance(0.6);
        const size_t number = scene_.textures.size();
        t.wrap = {TextureWrap(number % 3), TextureWrap(number / 2 % 3)};
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

    /// Adds a material and returns its number; it may be required to transmit light more often than not, or to have a
    /// texture.
    int add_material(bool see_through, bool textured) {
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

    // ---- shapes

    dvec3 degrees() {
        const double kind = random_.unit();
        if (kind < 0.25) return dvec3(0);
        if (kind < 0.45) return {random_.of({0, 90, 180}), random_.of({0, 90, 270}), random_.of({0, 45, -90})};
        return random_.in_cube(180);
    }

    SolidObject solid(const dvec3& center, double radius) {
        const auto kind = static_cast<PlatonicSolid>(random_.below(5));
        return {.solid = kind, .center = center, .radius = radius, .rotation = degrees()};
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

    int reused_ = -1;           // a material without a texture
    int edge_lights_left_ = 2;  // solids that may still get edge lights
};

}  // namespace

void add_objects(State& state) {
    Objects objects(state);
    objects.add_surroundings();
    objects.add_groups();
}

}  // namespace cistula::generated
