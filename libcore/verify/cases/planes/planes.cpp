// Planes without end and disks: what a line meets follows from a few dot products, near and far.
#include <optional>

#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace planes {
namespace {

using glm::dvec3;

/// Where a scene is that is described about the origin, with a size of 1: turned, enlarged and moved.
struct Place {
    const char* name;
    dvec3 degrees{0};
    double scale = 1;
    dvec3 center{0};

    dvec3 turned(const dvec3& d) const { return Rotation(degrees)(d); }
    dvec3 operator()(const dvec3& p) const { return center + scale * turned(p); }
    /// The direction that turned() makes d.
    dvec3 turned_back(const dvec3& d) const {
        return {dot(d, turned({1, 0, 0})), dot(d, turned({0, 1, 0})), dot(d, turned({0, 0, 1}))};
    }
    DiskObject plane(const dvec3& normal, double offset) const {
        const dvec3 n = turned(normal);
        return DiskObject::plane(n, scale * offset + dot(n, center));
    }
};

const Place places[] = {{"as it is"},
                        {"turned", {31, 47, 11}},
                        {"at 1e6", {0, 0, 90}, 1, {1e6, -1e6, 1e6}},
                        {"2^-40", {90, 0, 0}, 0x1p-40},
                        {"2^40, turned", {200, 10, 20}, 0x1p40, {3e12, 0, 1e12}}};

/// A ball of radius 1 over the middle of a floor, from a camera above the floor that sees the horizon.
SceneDescription view(const Place& place, const dvec3& camera = {0.3, -5, 2.2}) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48;
    scene.film.height = 36;
    scene.depth = 3;
    scene.ambient = dvec3(1);
    scene.background = dvec3(0.25);
    scene.camera.position = place(camera);
    scene.camera.target = place({0, 0, 0.5});
    scene.camera.up = place.turned({0, 0, 1});
    scene.camera.field_of_view = 70;
    SphereObject ball;
    ball.center = place({0, 0, 1.25});
    ball.radius = place.scale;
    add_object(scene, ball, add_material(scene, paper(dvec3(0.5))));
    return scene;
}

constexpr dvec3 ball_center{0, 0, 1.25};
constexpr double extent = 1.5;  // no less than M of such a scene, in its lengths; at most 2 where it is a power of two

/// How much nearer than 1 a line comes to the ball's center; in doubt where that is about 0.
double ball_depth(const dvec3& from, const dvec3& direction) {
    const dvec3 off = ball_center - from;
    const double ahead = dot(off, direction);
    return ahead > 0 ? 1 - length(off - ahead * direction) : -1;
}

/// Where a line from above meets z = 0.
dvec3 on_floor(const dvec3& from, const dvec3& direction) {
    return from - from.z / direction.z * direction;
}

/// Expects each pixel's radiance to be that of expected(from, direction), in the lengths of the scene as it is
/// described; none: in doubt.
template <class Expected>
void expect_pixels(const Stage& stage, Tally& tally, const SceneDescription& scene, const Place& place, uint64_t number,
                   const Expected& expected) {
    const Film film = stage.film(scene);
    const dvec3 from = place.turned_back((scene.camera.position - place.center) / place.scale);
    for_each_view(film, scene, [&](size_t pixel, const dvec3& direction) {
        const std::optional<double> right = expected(from, place.turned_back(direction));
        if (!right) return;
        tally.place = place_of_scene(number) + pixel;
        tally.expect(magnitude(radiance(film, pixel) - *right) <= 1e-3);
    });
}

/// The color of a floor's checkerboard of squares of 1 about the scene's origin, by the rule of docs/scene.md; none
/// near the border of a square.
std::optional<double> checker(const Place& place, const dvec3& p) {
    const dvec3 normal = place.turned({0, 0, 1});
    const dvec3 axis = std::abs(normal.x) > 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 u = normalized(axis - dot(axis, normal) * normal);
    const dvec3 v = cross(normal, u);
    int cell = 0;
    for (const dvec3& along : {u, v}) {
        const double at = dot(along, place(p)) / place.scale;
        const double apart = std::abs(at - std::round(at));
        if (apart < 1e-4 + 4e-6 * length(p) * length(p)) return {};
        cell += int(int64_t(std::floor(at)) & 1);
    }
    return cell % 2 == 0 ? 0.8 : 0;
}

/// A floor of squares up to the horizon. `half`: of a quad in its place.
void floor_of_squares(Stage& stage, Tally& tally, double half) {
    uint64_t number = 0;
    for (const Place& place : places)
        for (const double far : {1.0, 100.0}) {
            SceneDescription scene = view(place, far * dvec3(0.3, -5, 2.2));
            scene.camera.field_of_view = far > 1 ? 20 : 70;
            add_checker(scene, glm::dvec2(0.5 / place.scale));
            if (half > 0)
                add_object(scene, floor_of_half(half));
            else
                add_object(scene, place.plane({0, 0, 1}, 0));
            expect_pixels(stage, tally, scene, place, number++,
                          [&](const dvec3& from, const dvec3& direction) -> std::optional<double> {
                              const double depth = ball_depth(from, direction);
                              if (std::abs(depth) < 1e-3) return {};
                              if (depth > 0) return 0.5;
                              if (direction.z >= 0) return 0.25;
                              const dvec3 p = on_floor(from, direction);
                              if (length(p) > 0x1p11 * extent) return {};
                              return checker(place, p);
                          });
            if (half > 0) return;
        }
}

/// The horizon of a floor, from any height, beside the scene too, and in a mirror that stands in the middle, which does
/// not change on which side of it a line goes. `radius`: of a disk in place of the floor.
void horizon(Stage& stage, Tally& tally, double radius) {
    uint64_t number = 0;
    for (const Place& place : {places[0], places[1], places[4]})
        for (const double height : {1e-6, 0.01, 3.0, 1e3, 1e6})
            for (const double aside : {0.0, 5.0, 1e3, 1e6}) {
                const dvec3 camera(aside, -5, height);
                SceneDescription scene = view(place, camera);
                const dvec3 ahead = normalized(aside > 0 && height < 1 ? dvec3(-aside, 5, 0) : dvec3(0, 1, 0));
                scene.camera.target = place(camera + ahead);
                scene.camera.field_of_view = height < 0.01 ? 1 : 0.002;
                const dvec3 along = 0.7 * dvec3(-ahead.y, ahead.x, 0);
                add_object(scene,
                           parallelogram(place(-along - dvec3(0, 0, 0.9)), 2 * place.scale * place.turned(along),
                                         1.8 * place.scale * place.turned({0, 0, 1})),
                           add_material(scene, paper(dvec3(0), 1)));
                const int floor = add_material(scene, paper(dvec3(0.75)));
                DiskObject disk;
                disk.center = place.center, disk.normal = place.turned({0, 0, 1}), disk.radius = radius * place.scale;
                add_object(scene, radius > 0 ? disk : place.plane({0, 0, 1}, 0), floor);
                const double wide = scene.camera.field_of_view / 57.29577951308232 / scene.film.width;
                const double near = max_or_second(wide, 0x1p-20);
                expect_pixels(stage, tally, scene, place, number++,
                              [&](const dvec3& from, const dvec3& direction) -> std::optional<double> {
                                  const double doubt = -0.05 - length(from) * near;
                                  const double t = -dot(from, ahead) / dot(direction, ahead);
                                  const dvec3 mirrored = direction - 2 * dot(direction, ahead) * ahead;
                                  if (ball_depth(from, direction) > doubt || std::abs(direction.z) < near ||
                                      ball_depth(from + t * direction, mirrored) > doubt)
                                      return {};
                                  return direction.z < 0 ? 0.75 : 0.25;
                              });
            }
}

/// The shadow of the ball, an ellipse, and of a disk beside it.
void shadows(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const Place& place : places) {
        SceneDescription scene = view(place);
        scene.ambient = dvec3(0);
        scene.background = dvec3(0);
        const dvec3 light(1, 2, 5);
        DiskObject disk;
        const dvec3 center(2, 0.5, 1), normal = normalized(dvec3(0.3, 0.2, 1));
        disk.center = place(center), disk.normal = place.turned(normal), disk.radius = 0.75 * place.scale;
        add_object(scene, disk, 1);
        add_object(scene, place.plane({0, 0, 1}, 0));
        add_light(scene, place(light));
        const auto disk_depth = [&](const dvec3& from, const dvec3& direction) {
            const double t = dot(normal, center - from) / dot(normal, direction);
            return t > 0 ? 0.75 - length(from + t * direction - center) : -1;
        };
        expect_pixels(stage, tally, scene, place, number++,
                      [&](const dvec3& from, const dvec3& direction) -> std::optional<double> {
                          if (ball_depth(from, direction) > -1e-3 || disk_depth(from, direction) > -1e-3) return {};
                          if (direction.z >= 0) return 0;
                          const dvec3 p = on_floor(from, direction);
                          if (length(p) > 0x1p10) return {};
                          const dvec3 toward = normalized(light - p);
                          const double depth = max_or_second(ball_depth(p, toward), disk_depth(p, toward));
                          if (std::abs(depth) < 1e-3 + 1e-5 * length(p)) return {};
                          return depth > 0 ? 0 : 0.8 * toward.z;
                      });
    }
}

/// A floor that mirrors the ball, and the sky beside it; a wall without end that mirrors nothing.
void mirror(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const Place& place : places) {
        SceneDescription scene = view(place);
        add_object(scene, place.plane({0, 0, 2}, 0), add_material(scene, paper(dvec3(0), 1)));
        add_object(scene, place.plane({0, -1, 0}, -4), add_material(scene, paper(dvec3(0.75))));
        expect_pixels(stage, tally, scene, place, number++,
                      [&](const dvec3& from, const dvec3& direction) -> std::optional<double> {
                          const auto beyond = [](const dvec3& start, const dvec3& way) -> std::optional<double> {
                              const double depth = ball_depth(start, way);
                              if (std::abs(depth) < 1e-3 + 1e-5 * length(start)) return {};
                              return depth > 0 ? 0.5 : way.y > 0 ? 0.75 : 0.25;
                          };
                          if (std::abs(direction.y) < 1e-2) return {};
                          const double wall = (4 - from.y) / direction.y, floor = -from.z / direction.z;
                          const bool meets_floor = floor > 0 && (wall < 0 || floor < wall);
                          if (meets_floor && floor > 1000) return {};
                          if (std::abs(ball_depth(from, direction)) < 1e-3 || std::abs(wall - floor) < 1e-3) return {};
                          if (ball_depth(from, direction) > 0) return 0.5;
                          if (!meets_floor) return wall > 0 ? 0.75 : 0.25;
                          return beyond(on_floor(from, direction), {direction.x, direction.y, -direction.z});
                      });
    }
}

/// What stands on a plane looks as what stands on a quad, wherever that is in view.
void as_a_quad(Stage& stage, Tally& tally) {
    const auto scene_on = [&](const Place& place, bool endless, bool glassy) {
        SceneDescription scene = view(place, {0.3, -2, 7});
        scene.depth = 8;
        scene.ambient = dvec3(0.2);
        scene.materials[1] = glassy ? glass(1.5) : scene.materials[1];
        scene.materials[1].name = "ball";
        add_object(scene,
                   solid_object(PlatonicSolid::cube, place({1.6, 0.5, 0.5}), 0.75 * place.scale * 2 / std::sqrt(3.0)),
                   add_material(scene, glass(1.3)));
        add_object(scene,
                   parallelogram(place({-1.5, -1, -0.5}), place.turned({0, place.scale * 2, 0}),
                                 place.turned({0, 0, place.scale})),
                   add_material(scene, paper(dvec3(0.7, 0.2, 0.2))));
        TrianglesObject floor = floor_of_half(30);
        for (dvec3& p : floor.vertices) p = place(p);
        floor.uvs.clear();
        if (endless)
            add_object(scene, place.plane({0, 0, 1}, 0));
        else
            add_object(scene, floor);
        add_light(scene, place({1, 2, 5}));
        return scene;
    };
    for (const bool glassy : {false, true})
        for (const Place& place : {places[0], places[1]})
            expect_same_picture(stage, tally, scene_on(place, true, glassy), scene_on(place, false, glassy), glassy);
}

}  // namespace
}  // namespace planes

void add_planes(Cases& cases) {
    using namespace planes;
    cases.images("checker", "the square at the place of two dot products, up to the horizon", no_failures("pixels"),
                 [](Stage& stage, Tally& tally) { floor_of_squares(stage, tally, 0); });
    cases.images("broken/quad", "a quad in place of a plane has an end", must_fail(1, "pixels"),
                 [](Stage& stage, Tally& tally) { floor_of_squares(stage, tally, 20); });
    cases.images("horizon", "what is below the camera's height is floor", no_failures("pixels"),
                 [](Stage& stage, Tally& tally) { horizon(stage, tally, 0); });
    cases.images("broken/rim", "a disk in place of a plane has an end", must_fail(100, "pixels"),
                 [](Stage& stage, Tally& tally) { horizon(stage, tally, 0x1p12); });
    cases.images("shadows", "ellipses, of a ball and a disk", no_failures("pixels"), shadows);
    cases.images("mirror", "the ball mirrored in a floor before a wall", no_failures("pixels"), mirror);
    cases.images("as-a-quad", "what stands on a quad as large as the view", no_failures("pixels"), as_a_quad);
}

}  // namespace cistula::verify
