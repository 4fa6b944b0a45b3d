// Bodies between planes x = begin and x = end, as cubes of planes or wide boxes of triangles, and the sequence of
// indices along x.
#pragma once

#include <set>

#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::refraction {

struct Body {
    double begin, end, index;
    bool operator<(const Body& other) const {
        return begin != other.begin ? begin < other.begin : end != other.end ? end < other.end : index < other.index;
    }
};
struct Arrangement {
    const char* name;
    std::vector<Body> bodies;
};

/// The arrangements of bodies; one of index 1 is a bubble.
inline std::vector<Arrangement> arrangements() {
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
inline TrianglesObject box_mesh(const glm::dvec3& low, const glm::dvec3& high, const Rotation& rotation,
                                bool other_way) {
    TrianglesObject mesh;
    mesh.keep_triangles = true;
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

inline constexpr double box_half_width = 8;

inline SceneDescription scene_of(const std::vector<Body>& bodies, Form form, const glm::dvec3& turn) {
    const Rotation rotation(turn);
    SceneDescription scene = empty_scene();
    for (size_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        const int material = add_material(scene, glass(body.index));
        const double half = 0.5 * (body.end - body.begin), middle = body.begin + half;
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

/// Appends the first twelve numbers of a case: position of x = y = z = 0 in the frame and the three axes.
inline void place_numbers(const glm::dvec3& turn, const glm::dvec3& center, double factor,
                          std::vector<double>& numbers) {
    const Rotation rotation(turn);
    for (const glm::dvec3& v :
         {-center * factor, rotation({factor, 0, 0}), rotation({0, factor, 0}), rotation({0, 0, factor})})
        numbers.insert(numbers.end(), {v.x, v.y, v.z});
}

CISTULA_HD inline Vec3<double> placed(const Span<double>& numbers, double x, double y, double z) {
    Vec3<double> p(numbers[0], numbers[1], numbers[2]);
    for (int k = 0; k < 3; ++k) p[k] += x * numbers[3 + k] + y * numbers[6 + k] + z * numbers[9 + k];
    return p;
}

struct PlaceOnFace {
    double y, z;
};

/// A random point: within `reach` of the x axis, on it, or on a diagonal of a mesh's faces.
CISTULA_HD inline PlaceOnFace place_on_face(Draw& draw, double reach) {
    double y = draw.centered<double>(reach), z = draw.centered<double>(reach);
    const int where = draw.between(0, 5);
    if (where == 0) y = z = 0;
    if (where == 1) y = z;
    if (where == 2) y = -z;
    return {y, z};
}

/// Sets the media around the ray's origin to the solids of these bits.
template <class Real>
CISTULA_HD inline void surround(Ray<Real>& ray, uint32_t solids) {
    for (uint32_t solid = 0; solid < 8; ++solid)
        if ((solids >> solid & 1u) != 0) ray.media.add(solid, 1);
}

/// Appends the numbers of place_numbers, the number of intervals, the greatest distance of rays from the x axis, the
/// sine of their greatest angle to it in air; then for every interval its ends, its index, the solids there as bits.
inline void sequence_numbers(const std::vector<Body>& bodies, Form form, const glm::dvec3& turn,
                             const glm::dvec3& center, double factor, std::vector<double>& numbers) {
    std::set<double> ends;
    for (const Body& body : bodies) ends.insert({body.begin, body.end});
    ends.insert({*ends.begin() - 1, *ends.rbegin() + 1});
    place_numbers(turn, center, factor, numbers);
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

inline std::string label(Form form, const char* name, const std::vector<Body>& bodies, const glm::dvec3& turn) {
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

}  // namespace cistula::verify::refraction
