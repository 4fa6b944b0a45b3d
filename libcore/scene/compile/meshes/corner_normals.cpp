#include "scene/compile/meshes/corner_normals.h"

#include <algorithm>

#include <fmt/format.h>

#include "cistula/numerics/trigonometry.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_edges.h"
#include "scene/compile/meshes/union_find.h"

namespace cistula {
namespace {

using glm::dvec3;
using CornerNormals = std::array<dvec3, 3>;

constexpr double flat_reach = 0x1p-12;  // distance of unit normals that are one: above what four decimals round

/// The unit normal of a triangle; not finite if it has no area.
dvec3 face_normal(const MeshSource& mesh, size_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    return normalized(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
}

/// The angle between two vectors, from 0 to pi.
double angle_between(const dvec3& a, const dvec3& b) {
    return elementary::atan2(length(cross(a, b)), dot(a, b));
}

/// Whether the edge of a half-edge has exactly two triangles, wound alike.
bool are_wound_alike(const MeshSource& mesh, const MeshEdges& edges, uint32_t h) {
    const auto place = [&](uint32_t half_edge) { return mesh.vertices[mesh.triangles[half_edge / 3][half_edge % 3]]; };
    const uint32_t other = edges.next[h];
    return other != h && edges.next[other] == h && place(other) != place(h);
}

/// Those of the mesh's vertices. Where a triangle was turned, they are turned, too, if they looked as it did.
std::vector<CornerNormals> given_normals(const MeshSource& mesh, const std::vector<uint8_t>& turned) {
    std::vector<CornerNormals> normals(mesh.triangles.size());
    for (size_t t = 0; t < normals.size(); ++t) {
        for (size_t c = 0; c < 3; ++c) normals[t][c] = mesh.normals[mesh.triangles[t][c]];
        if (turned.empty() || turned[t] == 0) continue;
        const dvec3 face = face_normal(mesh, t);
        if (dot(normals[t][0] + normals[t][1] + normals[t][2], face) < 0)
            for (dvec3& normal : normals[t]) normal = -normal;
    }
    return normals;
}

/// The sums of the faces around each corner, weighted by their angles, over runs of edges at which two faces meet whose
/// normals are less than `crease` degrees apart.
std::vector<CornerNormals> normals_by_angle(const MeshSource& mesh, const MeshEdges& edges, double crease) {
    const auto count = static_cast<uint32_t>(3 * mesh.triangles.size());
    const auto place = [&](uint32_t h) { return mesh.vertices[mesh.triangles[h / 3][h % 3]]; };
    const auto after = [](uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; };
    const double most = crease * (3.14159265358979323846 / 180);
    std::vector<CornerNormals> sums(mesh.triangles.size());
    const auto sum = [&](uint32_t h) -> dvec3& { return sums[h / 3][h % 3]; };
    UnionFind runs(count);
    for (uint32_t h = 0; h < count; ++h) {
        const uint32_t other = edges.next[h];
        if (other < h || !are_wound_alike(mesh, edges, h) ||
            !(angle_between(face_normal(mesh, h / 3), face_normal(mesh, other / 3)) < most))
            continue;
        runs.merge(h, after(other));
        runs.merge(after(h), other);
    }
    for (uint32_t h = 0; h < count; ++h) {
        const dvec3 to_next = place(after(h)) - place(h);
        const dvec3 to_last = place(after(after(h))) - place(h);
        const dvec3 face = face_normal(mesh, h / 3);
        if (is_finite(face)) sum(runs.root(h)) += angle_between(to_next, to_last) * face;
    }
    for (uint32_t h = count; h-- > 0;) sum(h) = sum(runs.root(h));  // the least of a run
    return sums;
}

/// Makes all normals unit ones within reach of their faces', and counts those that were not. A triangle with those of
/// its face is flat; if all are, there are none.
uint32_t settle(const MeshSource& mesh, std::vector<CornerNormals>& normals) {
    uint32_t replaced = 0;
    bool is_flat = true;
    for (size_t t = 0; t < normals.size(); ++t) {
        const dvec3 face = face_normal(mesh, t);
        double farthest = 0;
        for (dvec3& normal : normals[t]) {
            normal = normalized(normal);
            if (!(dot(normal, face) >= least_cosine)) {
                normal = face;
                replaced += is_finite(face);
            }
            farthest = max_or_second(length(normal - face), farthest);
        }
        if (!(farthest > flat_reach))
            normals[t] = {};
        else
            is_flat = false;
    }
    if (is_flat) normals = {};
    return replaced;
}

bool is_in_parts(const MeshEdges& edges) {
    const auto count = static_cast<uint32_t>(edges.next.size() / 3);
    UnionFind parts(count);
    for (uint32_t h = 0; h < 3 * count; ++h) parts.merge(h / 3, edges.next[h] / 3);
    for (uint32_t t = 0; t < count; ++t)
        if (parts.root(t) != 0) return true;
    return false;
}

}  // namespace

void turn_to_normals(const MeshSource& mesh, MeshPieces& pieces) {
    MeshSource kept;
    kept.vertices = mesh.vertices;
    for (const uint32_t t : pieces.source) kept.owned_triangles.push_back(mesh.triangles[t]);
    kept.triangles = kept.owned_triangles;
    const auto count = static_cast<uint32_t>(kept.triangles.size());
    const MeshEdges edges = link_edges(kept);
    UnionFind runs(count);
    for (uint32_t h = 0; h < 3 * count; ++h)
        if (are_wound_alike(kept, edges, h)) runs.merge(h / 3, edges.next[h] / 3);
    enum : uint8_t { agrees = 1, opposes = 2 };
    std::vector<uint8_t> found(count, 0);  // of each run, at its root
    for (uint32_t t = 0; t < count; ++t)
        for (const uint32_t corner : kept.triangles[t]) {
            const double cosine = dot(normalized(mesh.normals[corner]), face_normal(kept, t));
            if (cosine >= least_cosine) found[runs.root(t)] |= agrees;
            if (cosine <= -least_cosine) found[runs.root(t)] |= opposes;
        }
    pieces.turned.resize(count);
    for (uint32_t t = 0; t < count; ++t) pieces.faults.opposed += pieces.turned[t] = found[runs.root(t)] == opposes;
}

void find_corner_normals(SceneSource& source, std::span<SourceSolid> solids,
                         const std::vector<std::vector<uint8_t>>& turned) {
    const Smoothing smooth = solids.front().smooth;
    const std::string& place = solids.front().place;
    if (smooth && !(*smooth >= 0 && *smooth <= 180))
        throw scene_error(*source.description, place, "smooth: expected an angle from 0 to 180 degrees");
    size_t corners = 0;
    size_t replaced = 0;
    for (SourceSolid& solid : solids) {
        if (smooth ? *smooth == 0 : solid.mesh.normals.empty()) continue;
        if (smooth && solid.edges.next.empty()) solid.edges = link_edges(solid.mesh);
        solid.normals = smooth ? normals_by_angle(solid.mesh, solid.edges, *smooth)
                               : given_normals(solid.mesh, turned[size_t(&solid - solids.data())]);
        const size_t of_no_use = settle(solid.mesh, solid.normals);
        solid.mesh.normals = {};
        solid.mesh.owned_normals = {};
        if (!smooth) replaced += of_no_use, corners += 3 * solid.mesh.triangles.size();
        if (solid.normals.empty()) continue;
        if (solid.edges.next.empty()) solid.edges = link_edges(solid.mesh);
        solid.in_parts = is_in_parts(solid.edges);
    }
    if (replaced == 0) return;
    const std::string name = solids.front().name.empty() ? "" : solids.front().name + ": ";
    const std::string fault = fmt::format(
        "{}at {} of {} corners of triangles the normals are missing, zero, not finite or turned away from the face",
        name, replaced, corners);
    if (2 * replaced > corners)
        throw scene_error(*source.description, place, fault,
                          "mend the file, or give \"smooth\": false or an angle in degrees");
    source.warnings.push_back(place + ": " + fault + "; its own are used there");
}

}  // namespace cistula
