// Bodies in one another: an opaque one is seen wherever it is, in either order of the file; the picture is that of its
// faces as sheets, which no line passes whatever it is in. Of transparent ones the later fills what they share.
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace overlap {
namespace {

/// The objects of a scene with their materials; `bodies` are opaque boxes.
struct Arrangement {
    SceneDescription scene = lit_scene();
    std::vector<std::pair<TrianglesObject, int>> bodies, others;
    std::vector<std::pair<TrianglesObject, int>> hidden;  // opaque and in the file with the bodies, but not to be seen
    int opaque, second, clear;

    Arrangement() {
        opaque = add_material(scene, paper({0.8, 0.6, 0.3}, 0.2));
        second = add_material(scene, paper({0.9, 0.2, 0.1}));
        clear = add_material(scene, glass(1.5, true, {0.1, 0.2, 0.4}));
    }
    static void add(SceneDescription& to, const std::vector<std::pair<TrianglesObject, int>>& shapes, bool triangles) {
        for (auto [shape, material] : shapes) {
            shape.keep_triangles = triangles && shape.triangles.size() > 2;
            add_object(to, shape, material);
        }
    }
    /// `opaque_first`: before the others in the file.
    SceneDescription solids(bool opaque_first, bool triangles) const {
        SceneDescription made = scene;
        if (!opaque_first) add(made, others, triangles);
        add(made, bodies, triangles), add(made, hidden, triangles);
        if (opaque_first) add(made, others, triangles);
        return made;
    }
    SceneDescription sheets(bool triangles) const {
        SceneDescription made = scene;
        add(made, others, triangles);
        for (const auto& [body, material] : bodies)
            for (const TrianglesObject& sheet : sheets_of_box(body)) add_object(made, sheet, material);
        return made;
    }
};

using Arrange = void (*)(Arrangement&, Draw&);

/// A block of glass set into a table by a thousandth or by a quarter of it.
void sunk(Arrangement& to, Draw& draw) {
    to.bodies = {{box({-3, -3, -1}, {3, 3, 0}), to.opaque}};
    to.others = {{box({-0.6, -0.6, draw.one_in(2) ? -0.001 : -0.3}, {0.6, 0.6, 1.1}), to.clear}};
}
void core(Arrangement& to, Draw& draw) {
    const dvec3 shift = draw.in_cube<double>(0.2);
    to.bodies = {{box(dvec3(-0.3, -0.3, 0.1) + shift, dvec3(0.3, 0.3, 0.7) + shift), to.opaque}};
    to.others = {{box({-0.8, -0.8, -0.4}, {0.8, 0.8, 1.2}), to.clear}};
}
/// Two opaque bodies that stick out of glass.
void half_out(Arrangement& to, Draw& draw) {
    const double at = draw.centered<double>(0.2);
    to.bodies = {{box({0.4, at - 0.3, 0.1}, {1.2, at + 0.3, 0.7}), to.opaque},
                 {box({at - 0.3, -0.3, 0.9}, {at + 0.3, 0.3, 1.6}), to.second}};
    to.others = {{box({-0.8, -0.8, -0.4}, {0.8, 0.8, 1.2}), to.clear}};
}
/// Two opaque bodies that share a space, of which a part lies in glass.
void opaque_in_opaque(Arrangement& to, Draw& draw) {
    const double at = draw.centered<double>(0.2);
    to.bodies = {{box({-0.7, -0.4, -0.2}, {at + 0.2, 0.4, 0.5}), to.opaque},
                 {box({at - 0.2, -0.6, 0.1}, {0.7, 0.3, 0.8}), to.second}};
    to.others = {{box({-0.5, -0.9, 0.3}, {0.5, 0.9, 1.2}), to.clear}};
}
void room(Arrangement& to, Draw&) {
    to.scene.camera.field_of_view = 60;
    to.bodies = {{box({-6, -6, 0}, {6, 6, 6}), to.opaque}};
    to.others = {{box({-0.6, -0.6, 0.5}, {0.6, 0.6, 1.7}), to.clear}};
}
void room_standing(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.others = {{box({-0.6, -0.6, 0}, {0.6, 0.6, 1.2}), to.clear}};
}
void room_sunk(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.others = {{box({-0.6, -0.6, draw.one_in(2) ? -0.001 : -0.3}, {0.6, 0.6, 1.2}), to.clear}};
}
void room_opaque(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.bodies.push_back({box({-1.4, 0.2, 0.4}, {-0.4, 1.2, 1.4}), to.second});
}

/// A box that touches a closed room from outside, before or after the room in the file.
void room_touched(Arrangement& to, Draw& draw) {
    room_standing(to, draw);
    to.hidden = {{box({-3, -3, -1}, {3, 3, 0}), to.second}};
    if (draw.one_in(2)) to.hidden.push_back({box({-6, -6, 6}, {6, 6, 7}), to.second});
}

Render as_sheets(Arrange arrange) {
    return [=](Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 52);
            Arrangement arrangement;
            arrange(arrangement, draw);
            const Writing writing = random_writing(draw, 2, 3);
            const bool triangles = i % 2 == 1;
            const Film expected = stage.film(written(arrangement.sheets(triangles), writing));
            for (const bool opaque_first : {true, false})
                expect_same_picture(stage, tally, written(arrangement.solids(opaque_first, triangles), writing),
                                    expected, 2 * i + opaque_first);
        }
    };
}
Render without_bodies(Arrange arrange) {
    return [=](Stage& stage, Tally& tally) {
        Draw draw(0, 52);
        Arrangement arrangement;
        arrange(arrangement, draw);
        const Film expected = stage.film(arrangement.sheets(false));
        arrangement.bodies.clear();
        expect_same_picture(stage, tally, arrangement.solids(true, false), expected, 0);
    };
}

/// Boxes that end and begin at x = from, and those that overlap from there to x = to.
std::pair<SceneDescription, SceneDescription> pair(double from, double to, bool swapped, bool triangles) {
    SceneDescription scene = lit_scene();
    const int one = add_material(scene, glass(1.5, true));
    const int other = add_material(scene, glass(1.33, true));
    SceneDescription apart = scene;
    const auto add = [&](SceneDescription& made, double low, double high, int material) {
        add_object(made, box({low, -0.7, -0.3}, {high, 0.7, 1}, triangles), material);
    };
    const double cut = swapped ? to : from;
    add(apart, -1.2, cut, one), add(apart, cut, 1.2, other);
    add(scene, -1.2, to, one), add(scene, from, 1.2, other);
    if (swapped) std::swap(scene.objects[0], scene.objects[1]);
    return {apart, scene};
}
/// Two that share a space: the later fills it, as if the earlier one ended at its faces. (But for absorption, which
/// adds.)
void later_fills(Stage& stage, Tally& tally) {
    for (uint64_t i = 0; i < scenes(stage); ++i) {
        Draw draw(i, 52);
        const double from = -0.2 - 0.2 * draw.unit<double>();
        const double to = 0.2 + 0.2 * draw.unit<double>();
        const Writing writing = random_writing(draw, 2, 3);
        for (const bool swapped : {false, true}) {
            const auto [apart, both] = pair(from, to, swapped, i % 2 == 1);
            expect_same_picture(stage, tally, written(both, writing), written(apart, writing), 2 * i + swapped);
        }
    }
}

}  // namespace
}  // namespace overlap

void add_overlap(Cases& cases) {
    using namespace overlap;
    const std::pair<const char*, Arrange> rows[] = {{"sunk", sunk},
                                                    {"core", core},
                                                    {"half-out", half_out},
                                                    {"opaque-in-opaque", opaque_in_opaque},
                                                    {"room/floating", room},
                                                    {"room/standing", room_standing},
                                                    {"room/sunk", room_sunk},
                                                    {"room/opaque", room_opaque},
                                                    {"room/touched", room_touched}};
    for (const auto& [name, arrange] : rows)
        cases.images(name, "the picture of opaque bodies' faces as sheets, in either order of the file",
                     no_failures("pixels"), as_sheets(arrange));
    cases.images("transparent", "two overlapping bodies look as if the earlier one ended at the later one",
                 no_failures("pixels"), later_fills);
    for (const auto& [name, arrange] : {std::pair("core", &core), std::pair("room", &room)})
        cases.images(std::string("broken/") + name, "without the opaque body the case fails", must_fail(5, "pixels"),
                     without_bodies(arrange));
}

}  // namespace cistula::verify
