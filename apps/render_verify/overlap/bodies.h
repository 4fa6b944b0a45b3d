// Opaque bodies in others, in either order of the file: the picture is that of their faces as sheets, which no line
// passes whatever it is in. And transparent ones in one another.
#pragma once

#include "apps/render_verify/given/writing.h"

namespace cistula::verify::overlap {

using namespace given;

/// The objects of a scene with their materials; `bodies` are opaque boxes.
struct Arrangement {
    SceneDescription scene = lit_scene();
    std::vector<std::pair<TrianglesObject, int>> bodies, others;
    std::vector<std::pair<TrianglesObject, int>> hidden;  // opaque and in the file with the bodies, but not to be seen
    int opaque, second, clear;

    Arrangement() {
        opaque = add_material(scene, stone({0.8, 0.6, 0.3}, 0.2));
        second = add_material(scene, stone({0.9, 0.2, 0.1}));
        clear = add_material(scene, contact::glass(1.5, {0.1, 0.2, 0.4}));
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
inline void sunk(Arrangement& to, Draw& draw) {
    to.bodies = {{box({-3, -3, -1}, {3, 3, 0}), to.opaque}};
    to.others = {{box({-0.6, -0.6, draw.one_in(2) ? -0.001 : -0.3}, {0.6, 0.6, 1.1}), to.clear}};
}
inline void core(Arrangement& to, Draw& draw) {
    const dvec3 shift = draw.in_cube<double>(0.2);
    to.bodies = {{box(dvec3(-0.3, -0.3, 0.1) + shift, dvec3(0.3, 0.3, 0.7) + shift), to.opaque}};
    to.others = {{box({-0.8, -0.8, -0.4}, {0.8, 0.8, 1.2}), to.clear}};
}
/// Two opaque bodies that stick out of glass.
inline void half_out(Arrangement& to, Draw& draw) {
    const double at = draw.centered<double>(0.2);
    to.bodies = {{box({0.4, at - 0.3, 0.1}, {1.2, at + 0.3, 0.7}), to.opaque},
                 {box({at - 0.3, -0.3, 0.9}, {at + 0.3, 0.3, 1.6}), to.second}};
    to.others = {{box({-0.8, -0.8, -0.4}, {0.8, 0.8, 1.2}), to.clear}};
}
/// Two opaque bodies that share a space, of which a part lies in glass.
inline void opaque_in_opaque(Arrangement& to, Draw& draw) {
    const double at = draw.centered<double>(0.2);
    to.bodies = {{box({-0.7, -0.4, -0.2}, {at + 0.2, 0.4, 0.5}), to.opaque},
                 {box({at - 0.2, -0.6, 0.1}, {0.7, 0.3, 0.8}), to.second}};
    to.others = {{box({-0.5, -0.9, 0.3}, {0.5, 0.9, 1.2}), to.clear}};
}
inline void room(Arrangement& to, Draw&) {
    to.scene.camera.field_of_view = 60;
    to.bodies = {{box({-6, -6, 0}, {6, 6, 6}), to.opaque}};
    to.others = {{box({-0.6, -0.6, 0.5}, {0.6, 0.6, 1.7}), to.clear}};
}
inline void room_standing(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.others = {{box({-0.6, -0.6, 0}, {0.6, 0.6, 1.2}), to.clear}};
}
inline void room_sunk(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.others = {{box({-0.6, -0.6, draw.one_in(2) ? -0.001 : -0.3}, {0.6, 0.6, 1.2}), to.clear}};
}
inline void room_opaque(Arrangement& to, Draw& draw) {
    room(to, draw);
    to.bodies.push_back({box({-1.4, 0.2, 0.4}, {-0.4, 1.2, 1.4}), to.second});
}

/// A box that touches a closed room from outside, before or after the room in the file.
inline void room_touched(Arrangement& to, Draw& draw) {
    room_standing(to, draw);
    to.hidden = {{box({-3, -3, -1}, {3, 3, 0}), to.second}};
    if (draw.one_in(2)) to.hidden.push_back({box({-6, -6, 6}, {6, 6, 7}), to.second});
}

/// Compares both orders with the faces as sheets.
template <Arrange arrange>
struct AsSheets {
    static constexpr const char* exact = "the picture of opaque bodies' faces as sheets, in either order of the file";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 52);
            Arrangement arrangement;
            arrange(arrangement, draw);
            const Writing writing = random_writing(draw, 2, 3);
            const bool triangles = i % 2 == 1;
            const Film expected = contact::film_of(stage, written(arrangement.sheets(triangles), writing));
            for (const bool opaque_first : {true, false})
                expect_same_picture(stage, tally, written(arrangement.solids(opaque_first, triangles), writing),
                                    expected, 2 * i + opaque_first);
        }
    }
};

struct Sunk : AsSheets<sunk> {
    static constexpr const char* name = "overlap/sunk";
};
struct Core : AsSheets<core> {
    static constexpr const char* name = "overlap/core";
};
struct HalfOut : AsSheets<half_out> {
    static constexpr const char* name = "overlap/half-out";
};
struct OpaqueInOpaque : AsSheets<opaque_in_opaque> {
    static constexpr const char* name = "overlap/opaque-in-opaque";
};
struct Room : AsSheets<room> {
    static constexpr const char* name = "overlap/room/floating";
};
struct RoomStanding : AsSheets<room_standing> {
    static constexpr const char* name = "overlap/room/standing";
};
struct RoomSunk : AsSheets<room_sunk> {
    static constexpr const char* name = "overlap/room/sunk";
};
struct RoomOpaque : AsSheets<room_opaque> {
    static constexpr const char* name = "overlap/room/opaque";
};
struct RoomTouched : AsSheets<room_touched> {
    static constexpr const char* name = "overlap/room/touched";
};

/// A picture in which what the rule shows is missing.
template <Arrange arrange>
struct Missing {
    static constexpr const char* exact = "without the opaque body the case fails";
    static constexpr Bound bound = must_fail(5, "pixels");

    static void render(Stage& stage, Tally& tally) {
        Draw draw(0, 52);
        Arrangement arrangement;
        arrange(arrangement, draw);
        const Film expected = contact::film_of(stage, arrangement.sheets(false));
        arrangement.bodies.clear();
        expect_same_picture(stage, tally, arrangement.solids(true, false), expected, 0);
    }
};
struct BrokenCore : Missing<core> {
    static constexpr const char* name = "overlap/broken/core";
};
struct BrokenRoom : Missing<room> {
    static constexpr const char* name = "overlap/broken/room";
};

// ---- transparent bodies

/// Two that share a space: the later fills it, as if the earlier one ended at its faces. (But for absorption, which
/// adds.)
struct Later {
    static constexpr const char* name = "overlap/transparent";
    static constexpr const char* exact = "two overlapping bodies look as if the earlier one ended at the later one";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 52);
            const double from = -0.2 - 0.2 * draw.unit<double>(), to = 0.2 + 0.2 * draw.unit<double>();
            const Writing writing = random_writing(draw, 2, 3);
            const bool triangles = i % 2 == 1;
            for (const bool swapped : {false, true}) {
                const auto [apart, both] = pair(from, to, swapped, triangles);
                expect_same_picture(stage, tally, written(both, writing), written(apart, writing), 2 * i + swapped);
            }
        }
    }

  private:
    /// Boxes that end and begin at x = from, and those that overlap from there to x = to.
    static std::pair<SceneDescription, SceneDescription> pair(double from, double to, bool swapped, bool triangles) {
        SceneDescription scene = lit_scene();
        const int one = add_material(scene, contact::glass(1.5));
        const int other = add_material(scene, contact::glass(1.33));
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
};

}  // namespace cistula::verify::overlap
