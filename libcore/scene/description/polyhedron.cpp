#include "scene/description/polyhedron.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double most_off_pair = 0x1p-50;  // of the sum of two unit normals: their planes are a pair
constexpr double least_inradius = 1e-9;    // of a body's reach from its middle

void drop_vertices_between(std::vector<dvec3>& vertices, std::vector<BodyFace>& faces) {
    std::vector<uint32_t> count(vertices.size(), 0);
    for (const BodyFace& face : faces)
        for (const uint32_t c : face.corners) ++count[c];
    std::vector<uint32_t> number(vertices.size());
    std::vector<dvec3> kept;
    for (size_t i = 0; i < vertices.size(); ++i) {
        number[i] = static_cast<uint32_t>(kept.size());
        if (count[i] >= 3) kept.push_back(vertices[i]);
    }
    for (BodyFace& face : faces) {
        std::erase_if(face.corners, [&](uint32_t c) { return count[c] < 3; });
        for (uint32_t& c : face.corners) c = number[c];
    }
    vertices = std::move(kept);
}

/// Makes pairs of parallel faces, in the order of the first of each, and single ones.
void pair_planes(Polyhedron& body, const std::vector<BodyFace>& faces) {
    std::vector<bool> taken(faces.size(), false);
    for (size_t i = 0; i < faces.size(); ++i) {
        if (taken[i]) continue;
        const BodyPlane& plane = faces[i].plane;
        const auto low = 2 * static_cast<uint32_t>(body.planes.size());
        body.planes.push_back({plane.normal, -INFINITY, plane.offset});
        for (size_t j = i + 1; j < faces.size(); ++j) {
            const dvec3 sum = plane.normal + faces[j].plane.normal;
            if (taken[j] || !(dot(sum, sum) <= most_off_pair * most_off_pair)) continue;
            taken[j] = true;
            body.planes.back().low = -faces[j].plane.offset;
            body.faces.push_back({low, -plane.normal, faces[j].corners});
            break;
        }
        body.faces.push_back({low + 1, plane.normal, faces[i].corners});
    }
}

void measure_body(Polyhedron& body) {
    dvec3 middle(0);
    for (const dvec3& p : body.vertices) middle += p / double(body.vertices.size());
    double size = 0;
    double area = 0;
    double volume = 0;
    body.reach = 0;
    for (const dvec3& p : body.vertices) {
        body.reach = max_or_second(length(p), body.reach);
        size = max_or_second(length(p - middle), size);
    }
    for (const Polyhedron::Face& face : body.faces) {
        const double twice = length(twice_area(body.vertices, face.vertices));
        area += twice;
        volume += twice * dot(face.normal, body.vertices[face.vertices[0]] - middle);
        for (const uint32_t c : face.vertices)
            body.flatness =
                max_or_second(magnitude(dot(face.normal, body.vertices[c]) - offset_of(body, face)), body.flatness);
    }
    body.inradius = volume / area;
    if (!(body.inradius > least_inradius * size)) refuse_flat_body();
}

}  // namespace

void refuse_flat_body() {
    throw Error(ErrorKind::scene, "the body is flat, or nearly so", "give one with an inside");
}

const Polyhedron& polyhedron_of(const SolidObject& solid) {
    return solid.body ? *solid.body : platonic_shape(solid.solid);
}

bool find_edges(Polyhedron& body) {
    std::map<std::array<uint32_t, 2>, uint32_t> faces;  // by the edge as they go around
    size_t sides = 0;
    for (const auto& face : body.faces)
        for (size_t i = 0; i < face.vertices.size(); ++i, ++sides)
            faces[{face.vertices[i], face.vertices[(i + 1) % face.vertices.size()]}] = face.id;
    for (const auto& [ends, face] : faces) {
        if (ends[0] > ends[1]) continue;
        const auto other = faces.find({ends[1], ends[0]});
        if (other == faces.end()) return false;
        body.edges.push_back({ends, {std::min(face, other->second), std::max(face, other->second)}});
    }
    return 2 * body.edges.size() == sides && body.vertices.size() + body.faces.size() == body.edges.size() + 2;
}

std::vector<std::array<uint32_t, 3>> triangulated(const Polyhedron& body) {
    std::vector<std::array<uint32_t, 3>> triangles;
    for (const auto& face : body.faces)
        for (size_t i = 2; i < face.vertices.size(); ++i)
            triangles.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    return triangles;
}

dvec3 twice_area(const std::vector<dvec3>& vertices, const std::vector<uint32_t>& corners) {
    dvec3 area(0);
    const dvec3& first = vertices[corners[0]];
    for (size_t i = 2; i < corners.size(); ++i)
        area += cross(vertices[corners[i - 1]] - first, vertices[corners[i]] - first);
    return area;
}

void put_in_order(const std::vector<dvec3>& vertices, BodyFace& face) {
    std::vector<uint32_t>& corners = face.corners;
    sort_around(face.plane.normal, corners, [&](uint32_t c) { return vertices[c]; });
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
}

BodyFace face_through(const std::vector<dvec3>& vertices, std::vector<uint32_t> corners) {
    const dvec3 normal = normalized(twice_area(vertices, corners));
    double low = INFINITY;
    double high = -INFINITY;
    for (const uint32_t c : corners) {
        low = min_or_second(dot(normal, vertices[c]), low);
        high = max_or_second(dot(normal, vertices[c]), high);
    }
    return {{normal, 0.5 * (low + high)}, std::move(corners)};
}

Polyhedron body_of_faces(std::string_view name, std::vector<dvec3> vertices, std::vector<BodyFace> faces) {
    if (faces.size() > most_faces)
        throw Error(ErrorKind::scene,
                    fmt::format("the body has {} faces; expected at most {}", faces.size(), most_faces),
                    "give it as a mesh");
    drop_vertices_between(vertices, faces);
    Polyhedron body;
    body.name = name;
    body.vertices = std::move(vertices);
    for (BodyFace& face : faces) put_in_order(body.vertices, face);
    pair_planes(body, faces);
    if (std::any_of(faces.begin(), faces.end(), [](const BodyFace& face) { return face.corners.size() < 3; }) ||
        !find_edges(body))
        throw Error(ErrorKind::scene, "faces lie so near one another that rounding decides which of them meet",
                    "give a body whose faces are farther apart, or more digits");
    measure_body(body);
    return body;
}

Polyhedron box_body(const dvec3& size) {
    std::vector<dvec3> vertices;
    for (uint32_t i = 0; i < 8; ++i)
        vertices.push_back(0.5 * dvec3(i & 1 ? size.x : -size.x, i & 2 ? size.y : -size.y, i & 4 ? size.z : -size.z));
    std::vector<BodyFace> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (const uint32_t high : {1u, 0u}) {
            BodyFace face{{dvec3(0), 0.5 * size[axis]}, {}};
            face.plane.normal[axis] = high ? 1 : -1;
            for (uint32_t i = 0; i < 8; ++i)
                if ((i >> axis & 1) == high) face.corners.push_back(i);
            faces.push_back(face);
        }
    Polyhedron body = body_of_faces("box", std::move(vertices), std::move(faces));
    for (int axis = 0; axis < 3; ++axis) body.half_unit = max_or_second(half_unit_of(size[axis] / 2), body.half_unit);
    return body;
}

Polyhedron body_over_polygon(PolygonBody kind, int sides, double radius, double height) {
    const auto n = static_cast<uint32_t>(sides);
    std::vector<dvec3> vertices;
    const auto add_polygon = [&](double z, double turn) {
        for (uint32_t i = 0; i < n; ++i) {
            const auto [sine, cosine] = sine_cosine_of_degrees(360 * (i + turn) / n);
            vertices.push_back({radius * cosine, radius * sine, z});
        }
    };
    add_polygon(-height / 2, 0);
    if (kind == PolygonBody::pyramid)
        vertices.push_back({0, 0, height / 2});
    else
        add_polygon(height / 2, kind == PolygonBody::antiprism ? 0.5 : 0);
    std::vector<BodyFace> faces;
    const auto add = [&](std::vector<uint32_t> corners) {
        faces.push_back(face_through(vertices, std::move(corners)));
    };
    const SineCosine half = sine_cosine_of_degrees(180.0 / n);
    std::vector<uint32_t> base, top;
    for (uint32_t i = 0; i < n; ++i) base.push_back(n - 1 - i), top.push_back(n + i);
    add(base);
    if (kind != PolygonBody::pyramid) add(top);
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t next = (i + 1) % n;
        if (kind == PolygonBody::prism) {
            const auto [sine, cosine] = sine_cosine_of_degrees(360 * (i + 0.5) / n);  // so that opposite sides pair
            faces.push_back({{{cosine, sine, 0}, radius * half.cosine}, {i, next, n + next, n + i}});
        }
        if (kind == PolygonBody::pyramid) add({i, next, n});
        if (kind == PolygonBody::antiprism) add({i, next, n + i}), add({next, n + next, n + i});
    }
    static constexpr std::string_view names[] = {"prism", "antiprism", "pyramid"};
    Polyhedron body = body_of_faces(names[static_cast<size_t>(kind)], std::move(vertices), std::move(faces));
    body.half_unit = max_or_second(half_unit_of(radius), half_unit_of(height / 2));
    return body;
}

}  // namespace cistula
