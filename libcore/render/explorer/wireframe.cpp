#include "cistula/numerics/vec.h"
#include "render/explorer/explorer.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

Vec3<double> normal_of(const MeshSource& mesh, uint32_t triangle) {
    const TriangleCorners& c = mesh.triangles[triangle];
    const auto at = [&](size_t corner) { return Vec3<double>(mesh.vertices[c[corner]]); };
    return cross(at(1) - at(0), at(2) - at(0));
}

/// Whether two triangles turn by less than a thousandth where they meet.
bool in_one_plane(const Vec3<double>& a, const Vec3<double>& b) {
    const Vec3<double> turn = cross(a, b);
    return dot(a, b) > 0 && dot(turn, turn) <= 1e-6 * dot(a, a) * dot(b, b);
}

/// The half-edges of a mesh that stand for its edges: alone, or with a later one along the same edge.
std::vector<uint32_t> drawn_halves(const MeshSource& mesh, const std::vector<uint32_t>& next) {
    std::vector<uint32_t> drawn;
    for (uint32_t half = 0; half < next.size(); ++half) {
        const uint32_t other = next[half];
        if (other == half || (other > half && !in_one_plane(normal_of(mesh, half / 3), normal_of(mesh, other / 3))))
            drawn.push_back(half);
    }
    return drawn;
}

}  // namespace

std::vector<Wireframe> wireframes(const SceneSource& source, size_t most) {
    std::vector<Wireframe> all;
    for (const SourceSolid& solid : source.solids) {
        Wireframe& wires = all.emplace_back();
        if (solid.platonic) {
            const std::vector<glm::dvec3> vertices = world_vertices(*solid.platonic);
            for (const auto& [ends, faces] : platonic_shape(solid.platonic->solid).edges)
                wires.push_back({vertices[ends[0]], vertices[ends[1]]});
            continue;
        }
        const MeshSource& mesh = solid.mesh;
        const MeshEdges linked = solid.edges.next.empty() ? link_edges(mesh) : MeshEdges();
        const std::vector<uint32_t> drawn =
            drawn_halves(mesh, solid.edges.next.empty() ? linked.next : solid.edges.next);
        for (size_t i = 0; i < drawn.size(); i += drawn.size() / (most + 1) + 1) {
            const TriangleCorners& corners = mesh.triangles[drawn[i] / 3];
            wires.push_back({mesh.vertices[corners[drawn[i] % 3]], mesh.vertices[corners[(drawn[i] + 1) % 3]]});
        }
    }
    return all;
}

}  // namespace cistula
