#include "scene/compile/meshes/mesh_solids.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/corner_normals.h"

namespace cistula {
namespace {

/// The triangles of some meshes as one.
MeshSource joined_mesh(const std::vector<const MeshSource*>& meshes) {
    const bool with_uvs =
        std::all_of(meshes.begin(), meshes.end(), [](const MeshSource* m) { return !m->uvs.empty(); });
    const bool with_normals =
        std::any_of(meshes.begin(), meshes.end(), [](const MeshSource* m) { return !m->normals.empty(); });
    MeshSource joined;
    for (const MeshSource* mesh : meshes) {
        const auto first = static_cast<uint32_t>(joined.owned_vertices.size());
        joined.owned_vertices.insert(joined.owned_vertices.end(), mesh->vertices.begin(), mesh->vertices.end());
        if (with_uvs) joined.owned_uvs.insert(joined.owned_uvs.end(), mesh->uvs.begin(), mesh->uvs.end());
        if (with_normals) {
            joined.owned_normals.resize(first, glm::dvec3(0));
            joined.owned_normals.insert(joined.owned_normals.end(), mesh->normals.begin(), mesh->normals.end());
            joined.owned_normals.resize(joined.owned_vertices.size(), glm::dvec3(0));
        }
        for (const TriangleCorners& t : mesh->triangles)
            joined.owned_triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        joined.doubled_polygons += mesh->doubled_polygons;
        joined.rounding.digits = mesh->rounding.digits;  // of one file
        for (int axis = 0; axis < 3; ++axis)
            joined.rounding.half_unit[axis] =
                max_or_second(mesh->rounding.half_unit[axis], joined.rounding.half_unit[axis]);
    }
    joined.view_owned();
    return joined;
}

bool have_one_material(const MeshPart& a, const MeshPart& b, bool one_material) {
    if (one_material || !a.material || !b.material) return one_material || (!a.material && !b.material);
    return a.material->name == b.material->name;
}

void erase_empty(std::vector<MeshGroup>& groups) {
    std::erase_if(groups, [](const MeshGroup& group) { return group.part.mesh.triangles.empty(); });
}

/// Leaves out of each of some groups the triangles that are not in `kept`, which numbers those of all, one after
/// another. Where none are left, the first group has the count.
void keep_in_each(const std::vector<MeshGroup*>& groups, const std::vector<uint32_t>& kept, StopSignal stop) {
    uint32_t first = 0;
    auto next = kept.begin();
    for (MeshGroup* group : groups) {
        MeshSource& mesh = group->part.mesh;
        const auto count = static_cast<uint32_t>(mesh.triangles.size());
        const std::vector<uint32_t>& alone = group->pieces.source;
        std::vector<uint8_t> leave(count, 0);
        for (const uint32_t t : alone) {
            while (next != kept.end() && *next < first + t) ++next;
            leave[t] = next == kept.end() || *next != first + t;
        }
        first += count;
        if (std::find(leave.begin(), leave.end(), 1) == leave.end()) continue;
        uint32_t left = 0;
        for (uint32_t t = 0; t < count; ++t)
            if (!leave[t]) mesh.owned_triangles[left++] = mesh.owned_triangles[t];
        mesh.owned_triangles.resize(left);
        (left > 0 ? mesh : groups.front()->part.mesh).doubled_polygons += count - left;  // which the warning counts
        mesh.view_owned();
        group->pieces = find_pieces(mesh, stop);
    }
}

/// Joins the open groups of one material into the first of them if that closes them.
void join_open_groups(std::vector<MeshGroup>& groups, bool one_material, StopSignal stop) {
    std::vector<uint8_t> seen(groups.size(), 0);
    for (size_t i = 0; i < groups.size(); ++i) {
        std::vector<MeshGroup*> open;
        std::vector<const MeshSource*> meshes;
        for (size_t j = i; j < groups.size(); ++j) {
            const bool is_like = have_one_material(groups[i].part, groups[j].part, one_material);
            if (seen[j] || groups[j].pieces.closed || !is_like) continue;
            seen[j] = 1;
            open.push_back(&groups[j]);
            meshes.push_back(&groups[j].part.mesh);
        }
        if (open.size() < 2) continue;
        MeshSource joined = joined_mesh(meshes);
        MeshPieces pieces = find_pieces(joined, stop);
        if (!pieces.closed) {
            keep_in_each(open, pieces.source, stop);
            continue;
        }
        for (MeshGroup* group : open) group->part.mesh = MeshSource();
        open.front()->part.mesh = std::move(joined);
        open.front()->pieces = std::move(pieces);
    }
    erase_empty(groups);
}

/// Joins a closed group to another as a hole in it. False if it does not lie in that one's inside.
bool join_hole(MeshGroup& outer, MeshGroup& hole, StopSignal stop) {
    MeshSource joined = joined_mesh({&outer.part.mesh, &hole.part.mesh});
    MeshPieces pieces = find_pieces(joined, stop);
    const size_t before = outer.pieces.source.size();
    if (!pieces.closed || pieces.source.size() != before + hole.pieces.source.size()) return false;
    for (size_t t = 0; t < hole.pieces.turned.size(); ++t)
        if (pieces.turned[before + t] == hole.pieces.turned[t]) return false;
    outer.part.mesh = std::move(joined);
    outer.pieces = std::move(pieces);
    hole.part.mesh = MeshSource();
    return true;
}

/// Joins closed groups that are wound inward to the least group that they lie in.
void join_holes(std::vector<MeshGroup>& groups, bool one_material, StopSignal stop) {
    const auto is_inward = [](const MeshGroup& group) { return group.pieces.closed && group.pieces.volume < 0; };
    for (MeshGroup& hole : groups) {
        if (!is_inward(hole)) continue;
        std::vector<MeshGroup*> outer;
        for (MeshGroup& other : groups)
            if (other.pieces.volume > -hole.pieces.volume && have_one_material(other.part, hole.part, one_material))
                outer.push_back(&other);
        std::stable_sort(outer.begin(), outer.end(),
                         [](const MeshGroup* a, const MeshGroup* b) { return a->pieces.volume < b->pieces.volume; });
        for (MeshGroup* other : outer)
            if (join_hole(*other, hole, stop)) break;
    }
    erase_empty(groups);
}

void warn(SceneSource& source, const SourceSolid& solid, const MeshPieces& pieces) {
    const MeshFaults& faults = pieces.faults;
    const auto add = [&](const std::string& text) {
        source.warnings.push_back(solid.place + ": " + (solid.name.empty() ? "" : solid.name + ": ") + text);
    };
    const auto counted = [](uint32_t number, const char* one, const char* many) {
        return std::to_string(number) + (number == 1 ? one : many);
    };
    if (const std::string left_out = faults.left_out(); !left_out.empty()) add(left_out);
    if (const uint32_t doubled = solid.mesh.doubled_polygons + faults.doubled; doubled > 0)
        add("merged " + counted(doubled, " face", " faces") + " with the corners of an earlier one");
    if (faults.turned > 0)
        add("turned " + counted(faults.turned, " triangle that was", " triangles that were") +
            " wound unlike the others of the surface");
    if (faults.opposed > 0)
        add("turned " + counted(faults.opposed, " triangle that was", " triangles that were") +
            " wound against the normals of the corners");
    if (faults.passing > 0)
        add(counted(faults.passing, " piece passes", " pieces pass") +
            " through others of the mesh, and makes no hole in them");
    const MaterialDescription& material = source.materials[solid.material];
    if (!pieces.closed && (material.index != 1 || largest_component(material.absorption) > 0 || material.fresnel))
        add("is not closed (" + faults.why_not_closed() + "): its index and absorption have no effect" +
            (material.fresnel ? ", nor has fresnel: kr and kt hold as they are given" : ""));
}

/// Some triangles of a mesh, with the vertices that they need.
MeshSource part_of(const MeshSource& mesh, const std::vector<TriangleCorners>& triangles) {
    constexpr uint32_t unknown = 0xffffffffu;
    std::vector<std::pair<uint32_t, uint32_t*>> corners;  // the mesh's vertex, and where the part's is asked for
    MeshSource part;
    part.owned_triangles = triangles;
    part.rounding = mesh.rounding;
    for (TriangleCorners& t : part.owned_triangles)
        for (uint32_t& corner : t) corners.emplace_back(corner, &corner);
    std::sort(corners.begin(), corners.end());
    uint32_t last = unknown;
    for (const auto& [vertex, corner] : corners) {
        if (vertex != last) {
            part.owned_vertices.push_back(mesh.vertices[vertex]);
            if (!mesh.uvs.empty()) part.owned_uvs.push_back(mesh.uvs[vertex]);
            if (!mesh.normals.empty()) part.owned_normals.push_back(mesh.normals[vertex]);
        }
        last = vertex;
        *corner = static_cast<uint32_t>(part.owned_vertices.size() - 1);
    }
    part.view_owned();
    return part;
}

}  // namespace

std::vector<MeshGroup> join_groups(std::vector<MeshPart> parts, bool one_material, StopSignal stop) {
    std::vector<MeshGroup> groups;
    for (MeshPart& part : parts) {
        MeshPieces pieces = find_pieces(part.mesh, stop);
        groups.push_back({std::move(part), std::move(pieces)});
    }
    if (groups.size() > 1) {
        join_open_groups(groups, one_material, stop);
        join_holes(groups, one_material, stop);
    }
    return groups;
}

void add_mesh_solids(SceneSource& source, SourceSolid solid, MeshPieces pieces) {
    if (!pieces.closed && !solid.smooth && !solid.mesh.normals.empty()) turn_to_normals(solid.mesh, pieces);
    warn(source, solid, pieces);
    solid.closed = pieces.closed;
    const bool all_kept = pieces.source.size() == solid.mesh.triangles.size();
    const bool any_turned = std::find(pieces.turned.begin(), pieces.turned.end(), 1) != pieces.turned.end();
    const size_t count = std::max<size_t>(pieces.thickness.size(), 1);
    std::vector<std::vector<TriangleCorners>> triangles(count);  // of each solid
    std::vector<std::vector<uint8_t>> turned(count);             // of each of these
    const size_t first = source.solids.size();
    if (count > 1 || !all_kept || any_turned)
        for (size_t t = 0; t < pieces.source.size(); ++t) {
            TriangleCorners corners = solid.mesh.triangles[pieces.source[t]];
            const bool is_turned = !pieces.turned.empty() && pieces.turned[t] != 0;
            if (is_turned) std::swap(corners[1], corners[2]);
            triangles[pieces.closed ? pieces.solid[t] : 0].push_back(corners);
            if (pieces.closed) turned[pieces.solid[t]].push_back(is_turned);
        }
    for (uint32_t body = 0; count > 1 && body < count; ++body) {
        SourceSolid& own = source.solids.emplace_back(solid.with_mesh(part_of(solid.mesh, triangles[body])));
        own.thickness = pieces.thickness[body];
        own.body = body;
    }
    if (count == 1) {
        if (!all_kept || any_turned) {
            solid.mesh.owned_triangles = std::move(triangles[0]);
            solid.mesh.triangles = solid.mesh.owned_triangles;
        } else {
            solid.edges = std::move(pieces.edges);
        }
        if (pieces.closed) solid.thickness = pieces.thickness[0];
        source.solids.push_back(std::move(solid));
    }
    find_corner_normals(source, std::span(source.solids).subspan(first), turned);
}

}  // namespace cistula
