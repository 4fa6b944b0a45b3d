// Media side by side, overlapping and nested: the sequence of indices along a ray is that of the scene's description,
// without gaps of air where bodies touch.
#include <algorithm>
#include <set>

#include "verify/cases/refraction/lines.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace refraction {
namespace {

// ---- bodies between planes x = begin and x = end, as cubes of planes or wide boxes of triangles

struct Body {
    double begin, end, index;
    auto operator<=>(const Body&) const = default;
};
struct Arrangement {
    const char* name;
    std::vector<Body> bodies;
};

/// The arrangements of bodies; one of index 1 is a bubble.
std::vector<Arrangement> arrangements() {
    return {{"two abutting", {{0, 2, 1.5}, {2, 4, 1.33}}},
            {"three abutting", {{0, 2, 1.33}, {2, 4, 2}, {4, 6, 1.5}}},
            {"two of one glass", {{0, 2, 1.5}, {2, 4, 1.5}}},
            {"overlapping", {{0, 3, 1.5}, {1, 4, 1.33}, {2, 5, 2}}},
            {"nested", {{0, 6, 1.5}, {1, 5, 1.33}, {2, 4, 2}}},
            {"bubble", {{0, 6, 1.5}, {2, 4, 1}}},
            {"flush in front", {{0, 4, 1.5}, {0, 2, 1.33}}},
            {"flush behind", {{0, 4, 1.5}, {2, 4, 1.33}}},
            {"abutting in another", {{0, 6, 1.33}, {1, 3, 1.5}, {3, 5, 2}}},
            {"bubble at a face", {{0, 4, 1.5}, {4, 6, 1.33}, {2, 4, 1}}},
            {"twice the same", {{0, 4, 1.5}, {0, 4, 1.33}}}};
}

enum class Form { cubes, wide_boxes, both };

/// A closed box of triangles; there are two ways of cutting its faces.
TrianglesObject box_mesh(const glm::dvec3& low, const glm::dvec3& high, const Rotation& rotation, bool other_way) {
    TrianglesObject mesh{.keep_triangles = true};
    for (const double x : {low.x, high.x})
        for (const double y : {low.y, high.y})
            for (const double z : {low.z, high.z}) mesh.vertices.push_back(rotation(glm::dvec3(x, y, z)));
    const uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& q : quads) {
        if (other_way)
            mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[1], q[3]}, {q[1], q[2], q[3]}});
        else
            mesh.triangles.insert(mesh.triangles.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
    }
    return mesh;
}

constexpr double box_half_width = 8;

SceneDescription scene_of(const std::vector<Body>& bodies, Form form, const glm::dvec3& turn) {
    const Rotation rotation(turn);
    SceneDescription scene = empty_scene();
    for (size_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        const int material = add_material(scene, glass(body.index));
        const double half = 0.5 * (body.end - body.begin);
        const double middle = body.begin + half;
        const bool cube = form == Form::cubes || (form == Form::both && i % 2 == 0);
        const double wide = form == Form::both ? half : box_half_width;
        if (cube)
            add_object(scene, solid_object(PlatonicSolid::cube, rotation({middle, 0, 0}), std::sqrt(3.0) * half, turn),
                       material);
        else
            add_object(scene, box_mesh({body.begin, -wide, -wide}, {body.end, wide, wide}, rotation, i % 2 != 0),
                       material);
    }
    return scene;
}

/// Turned about the scene's origin, or not.
const glm::dvec3 site_turns[] = {{0, 0, 0}, {20, 35, 50}};

/// Appends the twelve numbers of a place.
void place_numbers(const glm::dvec3& turn, const PartFrame& frame, Numbers& numbers) {
    const Rotation rotation(turn);
    const double f = frame.factor;
    for (const glm::dvec3& v : {-frame.center * f, rotation({f, 0, 0}), rotation({0, f, 0}), rotation({0, 0, f})})
        add_vector(v, numbers);
}
/// Appends the numbers of MediaSequence.
void sequence_numbers(const std::vector<Body>& bodies, Form form, const glm::dvec3& turn, const PartFrame& frame,
                      Numbers& numbers) {
    std::set<double> ends;
    for (const Body& body : bodies) ends.insert({body.begin, body.end});
    ends.insert({*ends.begin() - 1, *ends.rbegin() + 1});
    place_numbers(turn, frame, numbers);
    // At most 8 lengths of air at a slope of 3/4 from 1.5 beside the axis; 8 at a slope of 1/16 from 0.4.
    const bool wide = form == Form::wide_boxes;
    numbers.insert(numbers.end(), {double(ends.size() - 1), wide ? 1.5 : 0.4, wide ? 0.6 : 0.0625});
    for (auto end = std::next(ends.begin()); end != ends.end(); ++end) {
        const double begin = *std::prev(end);
        double index = 1;
        uint32_t solids = 0;
        for (uint32_t i = 0; i < bodies.size(); ++i)
            if (bodies[i].begin <= begin && *end <= bodies[i].end) index = bodies[i].index, solids |= 1u << i;
        numbers.insert(numbers.end(), {begin, *end, index, double(solids)});
    }
}

std::string label(Form form, const char* name, const std::vector<Body>& bodies, const glm::dvec3& turn) {
    std::string text = name;
    if (turn != glm::dvec3(0)) text += ", turned";
    text += form == Form::cubes ? ", planes:" : form == Form::both ? ", planes and meshes:" : ", meshes:";
    for (const Body& body : bodies)
        text += " [" + std::to_string(int(body.begin)) + ", " + std::to_string(int(body.end)) + "] " +
                std::to_string(body.index).substr(0, 4);
    return text;
}

/// Compiles the scene again with each body moved by an ulp of M or not at all along each axis, in the same frame.
template <class Real>
void move_bodies(CompiledScene<Real>& compiled, SceneDescription scene, uint64_t seed) {
    const double ulp =
        2 * double(RealTraits<Real>::unit) * double(compiled.extent) * elementary::power_of_two(-compiled.scale);
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        Draw draw(256 * seed + k, 0);
        glm::dvec3 by;
        for (int axis = 0; axis < 3; ++axis) by[axis] = ulp * draw.between(-1, 1);
        if (auto* solid = std::get_if<SolidObject>(&scene.objects[k].shape)) solid->center += by;
        if (auto* mesh = std::get_if<TrianglesObject>(&scene.objects[k].shape))
            for (glm::dvec3& p : mesh->vertices) p += by;
    }
    scene.frame = FrameOfReference{compiled.center, compiled.scale, {}};
    compiled = std::move(*compile_scene<Real>(scene));
}

/// Shared faces are ulps apart, or one in the other: bodies are moved so that they have gaps and overlaps of up to
/// 2 ulps a coordinate: 7 u M, less than half of the 16 u M within which faces share a plane.
void move_bodies_of(Part& part, uint64_t number) {
    part.edit([number, scene = part.scene](auto& compiled) { move_bodies(compiled, scene, number); });
}

/// Adds parts for every order of the bodies in the file.
void plan_bodies(Plan& plan, Form form, bool are_moved) {
    uint64_t number = 0;
    for (const Arrangement& arrangement : arrangements()) {
        std::vector<Body> bodies = arrangement.bodies;
        std::sort(bodies.begin(), bodies.end());
        do {
            for (const glm::dvec3& turn : site_turns) {
                Part& part = plan.add(label(form, arrangement.name, bodies, turn), scene_of(bodies, form, turn),
                                      MediaSequence(), {}, plan.rays(20000, 100));
                part.frame_numbers = [=](const PartFrame& frame, Numbers& numbers) {
                    sequence_numbers(bodies, form, turn, frame, numbers);
                };
                if (are_moved) move_bodies_of(part, number++);
            }
        } while (std::next_permutation(bodies.begin(), bodies.end()));
    }
}

void plan_octants(Plan& plan, Form form) {
    for (const glm::dvec3& turn : site_turns) {
        const Rotation rotation(turn);
        SceneDescription scene = empty_scene();
        const int material = add_material(scene, glass(1.5));
        for (int octant = 0; octant < 8; ++octant) {
            const glm::dvec3 center((octant & 1) - 0.5, (octant >> 1 & 1) - 0.5, (octant >> 2) - 0.5);
            const bool cube = form == Form::cubes || (form == Form::both && octant % 3 == 0);
            if (cube)
                add_object(scene, solid_object(PlatonicSolid::cube, rotation(center), std::sqrt(0.75), turn), material);
            else
                add_object(scene, box_mesh(center - 0.5, center + 0.5, rotation, octant % 2 != 0), material);
        }
        // On the faces, edges and corner that they share, well within the whole.
        std::vector<glm::dvec3> points;
        for (int x = -7; x <= 7; ++x)
            for (int y = -7; y <= 7; ++y)
                for (const glm::dvec3& p : {glm::dvec3(0, x, y), glm::dvec3(x, 0, y), glm::dvec3(x, y, 0)})
                    points.push_back(rotation(p / 8.0));
        Part& part = plan.add(form == Form::cubes  ? "planes"
                              : form == Form::both ? "planes and meshes"
                                                   : "meshes",
                              scene, Octants(), points, plan.rays(200000, 2500));
        part.frame_numbers = [](const PartFrame& frame, Numbers& numbers) { numbers = {frame.factor}; };
    }
}

/// A face where several bodies begin or end.
struct SharedFace {
    std::vector<Body> bodies;
    double at;
};
std::vector<SharedFace> shared_faces() {
    return {{{{0, 2, 1.5}, {2, 4, 1.33}}, 2},
            {{{0, 4, 1.5}, {0, 2, 1.33}}, 0},
            {{{0, 4, 1.5}, {2, 4, 1.33}}, 4},
            {{{0, 6, 1.33}, {1, 3, 1.5}, {3, 5, 2}}, 3},
            {{{0, 3, 1.5}, {1, 3, 1.33}, {2, 3, 2}}, 3}};
}

void plan_grazing(Plan& plan, bool are_moved) {
    uint64_t number = 0;
    for (const Form form : {Form::cubes, Form::wide_boxes, Form::both})
        for (const SharedFace& shared : shared_faces()) {
            std::vector<Body> bodies = shared.bodies;
            std::sort(bodies.begin(), bodies.end());
            do {
                for (const glm::dvec3& turn : site_turns)
                    for (const double onward : {1.0, -1.0}) {
                        double index[2] = {1, 1};
                        uint32_t around[2] = {0, 0};
                        for (uint32_t k = 0; k < bodies.size(); ++k)
                            for (int side = 0; side < 2; ++side) {
                                const double x = shared.at + (side == 0 ? -0.5 : 0.5) * onward;
                                if (!(bodies[k].begin < x && x < bodies[k].end)) continue;
                                index[side] = bodies[k].index, around[side] |= 1u << k;
                            }
                        if (index[0] == index[1]) continue;  // a body of higher priority around it
                        Part& part = plan.add(label(form, onward > 0 ? "onward" : "back", bodies, turn),
                                              scene_of(bodies, form, turn), Grazing(), {}, plan.rays(4000, 50));
                        part.frame_numbers = [=, at = shared.at, before = index[0], behind = index[1],
                                              solids = around[0]](const PartFrame& frame, Numbers& numbers) {
                            place_numbers(turn, frame, numbers);
                            numbers.insert(numbers.end(), {at, onward, before, behind, double(solids)});
                        };
                        if (are_moved) move_bodies_of(part, number++);
                    }
            } while (std::next_permutation(bodies.begin(), bodies.end()));
        }
}

}  // namespace

void add_media(Cases& cases) {
    const Bound none = no_failures("rays");
    const Bound witnessed = no_failures("rays", needs_witness);
    const auto sequence = [&](const std::string& name, const char* exact, Form form, bool are_moved) {
        cases.rays<MediaSequence>("media/" + name, exact, none,
                                  [=](Plan& plan) { plan_bodies(plan, form, are_moved); });
    };
    sequence("planes", "the sequence of indices through nested, abutting, overlapping solids", Form::cubes, false);
    sequence("triangles", "the same through meshes, whose shared faces are cut in two ways", Form::wide_boxes, false);
    sequence("planes-and-triangles", "the same where a solid of planes shares a face with a mesh", Form::both, false);
    sequence("within-rounding/planes",
             "the same where shared faces of solids of planes are ulps apart, or one in the other", Form::cubes, true);
    sequence("within-rounding/triangles", "the same where shared faces of meshes are ulps apart, or one in the other",
             Form::wide_boxes, true);
    cases.rays<Octants>("media/octants", "eight cubes of one glass: never out of it and in again", none,
                        [](Plan& plan) {
                            for (const Form form : {Form::cubes, Form::wide_boxes}) plan_octants(plan, form);
                        });
    cases.rays<Octants>("media/octants/planes-and-triangles", "the same, some of planes and some meshes", none,
                        [](Plan& plan) { plan_octants(plan, Form::both); });
    cases.rays<Grazing>("media/grazing", "at any slant down to 1/256 a shared face bends a line once, or mirrors it",
                        witnessed, [](Plan& plan) { plan_grazing(plan, false); });
    cases.rays<Grazing>("media/within-rounding/grazing",
                        "the same where shared faces are ulps apart, or one in the other", witnessed,
                        [](Plan& plan) { plan_grazing(plan, true); });
}

}  // namespace refraction
}  // namespace cistula::verify
