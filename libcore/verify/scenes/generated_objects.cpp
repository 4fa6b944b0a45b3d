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

/// Adds a floor, walls and sheets, then groups of closed bodies, with their materials.
class Objects : ObjectMaker {
  public:
    using ObjectMaker::ObjectMaker;

    void add_surroundings() {
        if (random_.chance(0.65)) add_floor();
        if (random_.chance(0.2)) {
            if (bodies_ == Bodies::all && random_.chance(0.5))
                add(DiskObject::plane({0, -5, 1}, -21), false);
            else
                add(quad_triangles({dvec3{-4, 4, -1}, {4, 4, -1}, {4, 5, 4}, {-4, 5, 4}}), false);
        }
        if (bodies_ == Bodies::balls) return;
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
        if (random_.chance(0.17)) return add_apart();
        const dvec3 places[] = {{-1.7, -1, 0}, {1.7, -1, 0}, {0, 1.9, 0}};
        const auto count = static_cast<uint32_t>(random_.of({1, 2, 3, 3, 3}));
        const uint32_t first = random_.below(3);
        const bool mixed = random_.chance(0.6);
        uint32_t theme = random_.below(12);
        const bool flat = bodies_ == Bodies::flat;
        for (uint32_t i = 0; i < count; ++i) {
            const dvec3 center = count == 1 ? dvec3(0) : places[(first + i) % 3];
            centers_.push_back(center);
            if (mixed) theme = random_.below(12);
            if (bodies_ == Bodies::balls || (!flat && random_.chance(0.55)))
                add_round_group(state_, center);
            else if (theme < 3)
                add_nested(center);
            else if (theme < 10 && palette_ == Palette::everything)  // lesser masks know no contacts
                add_touching(center);
            else if (theme < 11)
                add_overlapping(center);
            else
                add(closed_mesh(center, random_.between(0.8, 1.1)), true);
        }
    }

  private:
    void add_floor() {
        const uint32_t kind = bodies_ == Bodies::all ? random_.below(3) : 0;
        const double h = floor_height;
        if (kind == 0)
            add(quad_triangles({dvec3{-5, -5, h}, {5, -5, h}, {5, 5, h}, {-5, 5, h}}), false);
        else if (kind == 1)
            add(DiskObject::plane({0, 0, 1}, h), false);
        else
            add(DiskObject{.center = {0.5, 0, h}, .radius = 4.5}, false);
    }

    /// Adds convex solids in a grid, sometimes more than the plain loop takes, sometimes fewer; only balls may touch.
    void add_apart() {
        const uint32_t nx = 1 + random_.below(4);
        const uint32_t ny = 1 + random_.below(3);
        const uint32_t nz = 1 + random_.below(2);
        const bool lattice = random_.chance(0.3);
        const bool touching = lattice && random_.chance(0.5);
        reach_ = 0.6;
        for (uint32_t x = 0; x < nx; ++x)
            for (uint32_t y = 0; y < ny; ++y)
                for (uint32_t z = 0; z < nz; ++z) {
                    dvec3 center = 1.3 * dvec3(x - 0.5 * (nx - 1), y - 0.5 * (ny - 1), z);
                    if (!lattice) center += random_.in_cube(0.1);
                    SolidObject s = solid(center, random_.between(0.2, 0.52));
                    if (scene_.objects.size() % 3 == 2) s.body = other_body(scene_.objects.size() / 3);
                    const bool is_ball = bodies_ != Bodies::flat && random_.chance(0.6);
                    if (is_ball && touching) s.radius = 0.65;
                    cores_.push_back({s.center, s.radius});
                    centers_.push_back(s.center);
                    add(is_ball ? Shape(ball(s.center, s.radius)) : Shape(s), true);
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
            } else if (std::holds_alternative<SphereObject>(shape)) {
                cores_.push_back({at, radius});
                radius *= 0.9;
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
        switch (random_.below(12)) {
            case 0:
            case 9:
            case 11: {  // a row of cubes, cut along one diagonal or the other
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
            case 2:
            case 8:
            case 10: {  // a solid and its mirror image beyond a face
                const SolidObject s = solid(center, 0.7);
                const auto& faces = platonic_shape(s.solid).faces;
                TrianglesObject twin = beyond_face(s, faces[random_.below(static_cast<uint32_t>(faces.size()))]);
                const bool planes = random_.chance(0.3);
                const bool twin_first = random_.chance(0.5);
                if (twin_first) add(twin, true);
                add_of(planes, s);
                if (!twin_first) add(std::move(twin), true);
                break;
            }
            case 3:
            case 7: {  // two solids in the same place
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

    // ---- shapes

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
        if (bodies_ == Bodies::all && random_.chance(0.3)) return ball(center, radius);
        if (random_.chance(0.65)) return solid(center, radius);
        return closed_mesh(center, radius);
    }
};

}  // namespace

void add_objects(State& state) {
    Objects objects(state);
    objects.add_surroundings();
    objects.add_groups();
}

}  // namespace cistula::generated
