// Bodies that overlap, touch and contain one another at random, some opaque: what a line through them meets is what the
// regions say that they fill (docs/rules.md, 4).
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cistula/transport/layered_sums.h"
#include "cistula/transport/next_surface.h"
#include "render/frame/frame_view.h"
#include "testing/support/contacts/ideal_contact.h"
#include "testing/support/intersectors.h"
#include "testing/support/pictures/film_of_all.h"

namespace cistula {
namespace {

using test::Basis;
using test::BodyKind;
using test::dvec3;
using test::Random;

/// A box from one place on the line to another.
struct Part {
    int begin, end;
    bool opaque;

    bool holds(double place) const { return begin < place && place < end; }
};

/// What a line meets: an opaque body's face, or another medium.
struct Met {
    int place;
    uint32_t opaque = no_solid;  // the body, if it is one
    uint32_t before = no_solid, beyond = no_solid;

    bool operator==(const Met&) const = default;
};

/// The last transparent body at a place.
uint32_t medium_at(const std::vector<Part>& parts, double place) {
    uint32_t last = no_solid;
    for (uint32_t i = 0; i < parts.size(); ++i)
        if (!parts[i].opaque && parts[i].holds(place)) last = i;
    return last;
}

/// What a line meets, by the regions that the bodies fill: media from place to place, up to an opaque face. Of several
/// there, the last in the file of those that end, else of those that begin.
std::vector<Met> met_by_regions(const std::vector<Part>& parts, double start) {
    std::set<int> places;
    for (const Part& part : parts)
        for (const int place : {part.begin, part.end})
            if (place > start) places.insert(place);
    std::vector<Met> met;
    for (const int place : places) {
        const uint32_t before = medium_at(parts, place - 0.25), beyond = medium_at(parts, place + 0.25);
        uint32_t ends = no_solid, begins = no_solid;
        for (uint32_t i = 0; i < parts.size(); ++i) {
            if (parts[i].opaque && parts[i].end == place) ends = i;
            if (parts[i].opaque && parts[i].begin == place) begins = i;
        }
        if (ends != no_solid || begins != no_solid) {
            met.push_back({place, ends != no_solid ? ends : begins, before, no_solid});
            return met;
        }
        if (before != beyond) met.push_back({place, no_solid, before, beyond});
    }
    return met;
}

struct Row {
    std::vector<Part> parts;
    double start;  // of the line
};

Row random_row(Random& random) {
    Row row;
    for (uint32_t i = 1 + random.below(6); i > 0; --i) {
        const int a = int(random.below(24)), b = (a + 1 + int(random.below(23))) % 24;
        row.parts.push_back({std::min(a, b), std::max(a, b), random.below(100) < 45});
    }
    row.start = random.below(4) == 0 ? -1 : 0.5 + random.below(20);
    return row;
}

/// The boxes of a row along x, a little higher and wider one after the other.
SceneDescription boxes_of(const Row& row, Random& random) {
    const Basis basis = random.below(4) == 0 ? Basis() : Basis::random(random);
    const bool meshes = random.below(3) == 0;
    SceneDescription scene;
    for (uint32_t i = 0; i < row.parts.size(); ++i) {
        MaterialDescription& m = scene.materials.emplace_back();
        m.name = test::numbered("m", i);
        m.index = 1 + 0.125 * (i + 1);
        if (!row.parts[i].opaque) m.transmission = 0.9;
        if (row.parts[i].opaque && random.below(2)) m.transmission = 0.5, m.tint = dvec3(0);
        const double half = 4 + i;
        TrianglesObject box =
            test::blocks_mesh({{dvec3(row.parts[i].begin, -half, -half), dvec3(row.parts[i].end, half, half)}});
        box.keep_triangles = meshes && random.below(2);
        for (dvec3& p : box.vertices) p = basis(p);
        test::add_object(scene, box, int(i));
    }
    scene.camera.position = basis({row.start, 0.3, 0.2});
    scene.camera.target = basis({row.start + 40, 0.3 + random.between(-2, 2), 0.2 + random.between(-2, 2)});
    return scene;
}

/// What the next faces are that a line shades, from a camera, by the code that renders.
template <class Real>
std::vector<Met> met_by_line(const Row& row, const SceneDescription& scene) {
    using E = Effects<all_effects>;
    using Brute = test::Brute<Real>;
    const auto compiled = test::compile<Real>(scene);
    const SceneView<Real> view = compiled->view();
    const Brute brute{view};
    FrameSettings settings;
    FrameView frame = frame_view(*compiled, camera_at(scene.camera, 0), settings);
    EXPECT_TRUE(find_camera_solids(view, brute, frame));
    PixelRecord record{};
    uint32_t flags = 0;
    PixelSums<Real> sums(frame.tree, view, record, flags);
    NextSurface<Real, E, Brute, SumsOf<Real, E>> line(view, brute, frame.tree.depth, sums);
    Branch<Real> branch;
    double distance;
    const dvec3 direction = normalized(scene.camera.target - scene.camera.position);
    if (!primary_ray(view, frame, direction, branch.ray, distance)) return {};  // nothing is ahead
    const double along_row =
        double(std::ldexp(1.0, compiled->scale)) * length(scene.camera.target - scene.camera.position) / 40;
    SurfaceEvent<Real> event;
    VisibleLightHit<Real> light;
    Absorption<false> none;
    std::vector<Met> met;
    while (line.find(branch, event, light)) {
        const double place = row.start + (distance + double(event.hit.t)) / along_row;
        Met next{int(std::floor(place + 0.5))};
        EXPECT_NEAR(place, next.place, 1e-3);
        next.before = branch.ray.media.medium(view);
        const uint32_t solid = key_solid(event.hit.key);
        if (is_opaque(view, solid)) next.opaque = solid;
        if (next.opaque == no_solid) next.beyond = event.beyond.medium(view);
        met.push_back(next);
        if (next.opaque != no_solid) break;
        line.pass(branch.ray, event, none);
    }
    EXPECT_EQ(flags, 0u);
    return met;
}

template <class Real>
class OpaqueBodies : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(OpaqueBodies, Reals);

TYPED_TEST(OpaqueBodies, LinesMeetWhatTheRegionsSay) {
    Random random(1);
    size_t wrong = 0, in_opaque = 0, ended = 0;
    for (int i = 0; i < 5000; ++i) {
        const Row row = random_row(random);
        const std::vector<Met> right = met_by_regions(row.parts, row.start);
        wrong += met_by_line<TypeParam>(row, boxes_of(row, random)) != right;
        in_opaque += std::any_of(row.parts.begin(), row.parts.end(),
                                 [&](const Part& part) { return part.opaque && part.holds(row.start); });
        ended += !right.empty() && right.back().opaque != no_solid;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(in_opaque, 1500u);
    EXPECT_GT(ended, 3000u);
}

/// An opaque body with `fresnel` mirrors by its own index, in air and in glass: F = ((a - b) / (a + b))^2 at a right
/// angle.
TYPED_TEST(OpaqueBodies, MirrorByTheirOwnIndex) {
    for (const double around : {1.0, 1.5}) {
        SceneDescription scene;
        scene.film.width = scene.film.height = 1;
        scene.depth = 4;
        scene.background = dvec3(1);
        const int coat = test::add_material(scene, 1, 0, dvec3(0), 2);
        scene.materials[size_t(coat)].fresnel = true;
        const int glass = test::add_material(scene, 0, 1, dvec3(1), around);
        test::add_object(scene, test::blocks_mesh({{dvec3(-1), dvec3(1)}}), coat);
        test::add_object(scene, test::blocks_mesh({{dvec3(-3), dvec3(3)}}), glass);
        scene.camera.position = {-9, 0.25, 0.5};
        scene.camera.target = {0, 0.25, 0.5};
        const double f = (around - 2) / (around + 2);
        EXPECT_NEAR(to_color(test::film_of_all<TypeParam>(scene)).texels[0].x, f * f, 1e-5) << around;
    }
}

/// Six quads around a room, or a box that is given by planes or keeps its triangles.
void add_room(SceneDescription& scene, int material, int form) {
    const dvec3 low(-6, -6, 0), high(6, 6, 6);
    if (form > 0) {
        TrianglesObject box = test::blocks_mesh({{low, high}});
        box.keep_triangles = form == 2;
        return test::add_object(scene, box, material);
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            TrianglesObject wall;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int corner = 0; corner < 4; ++corner) {
                dvec3 p = upper ? high : low;
                p[u] = corner == 1 || corner == 2 ? high[u] : low[u];
                p[v] = corner >= 2 ? high[v] : low[v];
                wall.vertices.push_back(p);
            }
            wall.triangles = {{0, 1, 2}, {0, 2, 3}};
            test::add_object(scene, wall, material);
        }
}

struct InRoom {
    const char* name;
    int material;
    dvec3 low, high;
};

/// A picture from inside a room with a box, first or last in the file.
template <class Real>
Film room(const InRoom& thing, int form, bool room_first) {
    SceneDescription scene;
    scene.film.width = 64, scene.film.height = 48;
    scene.depth = 10;
    scene.ambient = dvec3(0.15);
    scene.background = {1, 0, 1};
    const int wall = test::add_material(scene);
    MaterialDescription& glass = scene.materials[size_t(test::add_material(scene, 0, 1, dvec3(1), 1.5))];
    glass.fresnel = true;
    scene.materials[size_t(test::add_material(scene))].color = {0.9, 0.1, 0.1};
    test::add_light(scene, {-3, -4, 5});
    scene.camera.position = {2, -5, 3};
    scene.camera.target = {0, 0, 0.4};
    if (room_first) add_room(scene, wall, form);
    test::add_object(scene, test::blocks_mesh({{thing.low, thing.high}}), thing.material);
    if (!room_first) add_room(scene, wall, form);
    return test::film_of_all<Real>(scene);
}

/// A room that is a closed box looks like six walls that are sheets.
TYPED_TEST(OpaqueBodies, ARoomMayBeAClosedBox) {
    const InRoom things[] = {{"glass that floats", 1, {-0.6, -0.6, 0.5}, {0.6, 0.6, 1.7}},
                             {"glass on the floor", 1, {-0.6, -0.6, 0}, {0.6, 0.6, 1.2}},
                             {"glass sunk into the floor", 1, {-0.6, -0.6, -0.125}, {0.6, 0.6, 1.2}},
                             {"a red box that floats", 2, {-0.6, -0.6, 0.5}, {0.6, 0.6, 1.7}},
                             {"a red box that touches the floor from below", 2, {-3, -3, -1}, {3, 3, 0}}};
    for (const InRoom& thing : things) {
        const Film walls = room<TypeParam>(thing, 0, true);
        for (const int form : {1, 2})
            for (const bool room_first : {true, false}) {
                const Film film = room<TypeParam>(thing, form, room_first);
                EXPECT_LE(test::share_apart(film, walls), 0.002)
                    << thing.name << ", form " << form << (room_first ? ", room first" : ", room last");
            }
    }
}

}  // namespace
}  // namespace cistula
