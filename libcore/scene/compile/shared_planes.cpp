#include "scene/compile/shared_planes.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "cistula/geometry/ray.h"
#include "scene/compile/patches.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double coinciding = 16;  // u M: faces within this of one plane share it
constexpr double steady = 4;       // u M: a plane's slack grows where its faces lie farther off
constexpr double reach = 64;       // u M: planes within this of a solid are near it

/// Sets of numbers that are merged pairwise.
class UnionFind {
  public:
    explicit UnionFind(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t root(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void merge(uint32_t a, uint32_t b) {
        a = root(a), b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> parent_;
};

template <class Real>
class PlaneSharing {
  public:
    PlaneSharing(CompiledScene<Real>& scene, std::vector<ConvexSolid>& convex, const std::vector<Box>& boxes)
        : scene_(scene),
          convex_(convex),
          boxes_(boxes),
          unit_(double(RealTraits<Real>::unit) * double(scene.extent)),
          patches_(touching_patches(scene, convex, boxes, reach * unit_)) {}

    FirstContact share(IncidentLists& incidents) {
        if (patches_.empty()) return {};
        planes_.assign(patches_.size(), no_plane);
        find_pairs();
        bind();
        if (scene_.shared_planes.empty()) return {};
        bind_triangles();
        bind_slabs(incidents);
        list_near();
        return first_;
    }

  private:
    /// Finds the pairs of patches that come within `reach` of one another, of different solids or of one open sheet
    /// that overlaps itself.
    void find_pairs() {
        std::vector<RTCBuildPrimitive> primitives;
        for (uint32_t i = 0; i < patches_.size(); ++i)
            primitives.push_back(padded_primitive(patches_[i].box, reach * unit_, i));
        const Tree tree = build_tree(primitives, 0);
        for (uint32_t i = 0; i < patches_.size(); ++i)
            for_each_in_box(tree, padded(patches_[i].box, reach * unit_), [&](uint32_t j) {
                if (j <= i || !touch(patches_[i].box, patches_[j].box, reach * unit_)) return;
                const bool one_solid = patches_[i].solid == patches_[j].solid;
                if (one_solid && !patches_[i].with_own) return;
                if (pairs_.size() == most_near_pairs) throw TooManyPairs{patches_[i].solid};
                pairs_.push_back({i, j, one_solid});
            });
        std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
            return a.first != b.first ? a.first < b.first : a.second < b.second;
        });
    }

    /// Whether two patches coincide: the smaller one's corners lie in the plane of the larger one.
    bool coincide(const Patch& a, const Patch& b) const {
        const Patch &large = a.area >= b.area ? a : b, &small = a.area >= b.area ? b : a;
        return touch(a.box, b.box, coinciding * unit_) && large.farthest(small) <= coinciding * unit_;
    }

    void bind() {
        UnionFind sets(patches_.size());
        std::vector<bool> in_contact(patches_.size(), false);
        for (const Pair& pair : pairs_) {
            const Patch &a = patches_[pair.first], &b = patches_[pair.second];
            if (!coincide(a, b)) continue;
            const bool one_flat_sheet = pair.one_solid && scene_.solids[a.solid].flat != 0;
            if (pair.one_solid && !one_flat_sheet && !overlap(a, b, reach * unit_)) continue;
            sets.merge(pair.first, pair.second);
            if (!pair.one_solid || overlap(a, b, reach * unit_)) in_contact[sets.root(pair.first)] = true;
            if (!pair.one_solid && !first_.found) first_ = {{a.solid, b.solid}, true};
        }
        std::vector<std::vector<uint32_t>> members(patches_.size());
        std::vector<bool> wanted(patches_.size(), false);
        for (uint32_t i = 0; i < patches_.size(); ++i) {
            members[sets.root(i)].push_back(i);
            if (in_contact[i]) wanted[sets.root(i)] = true;
        }
        for (uint32_t root = 0; root < patches_.size(); ++root)
            if (wanted[root]) add_plane(members[root]);
        if (!first_.found && !scene_.shared_planes.empty())
            for (uint32_t i = 0; i < patches_.size() && !first_.found; ++i)
                if (planes_[i] != no_plane) first_ = {{patches_[i].solid, patches_[i].solid}, true};
    }

    /// Makes the shared plane of patches: that of the largest one. Patches too far from it are left out.
    void add_plane(const std::vector<uint32_t>& members) {
        uint32_t largest = members[0];
        for (const uint32_t i : members)
            if (patches_[i].area > patches_[largest].area) largest = i;
        Patch plane = patches_[largest];
        const Vec3<Real> normal(plane.normal);
        plane.normal = dvec3(normal);
        plane.offset = dot(plane.normal, middle(plane.corners));
        const Real offset(plane.offset);
        plane.offset = double(offset);
        double farthest = 0;
        for (const uint32_t i : members) {
            const double off = plane.farthest(patches_[i]);
            if (off > coinciding * unit_) continue;
            farthest = std::max(farthest, off);
            planes_[i] = uint32_t(scene_.shared_planes.size());
        }
        const double grown = farthest <= steady * unit_ ? 1 : 1 + farthest / (8 * unit_);
        scene_.shared_planes.push_back({normal, offset, static_cast<Real>(grown * unit_), 0, 0, 0});
    }

    void bind_triangles() {
        uint32_t triangles = 0;
        for (const Cluster<Real>& cluster : scene_.clusters) triangles += cluster.count;
        scene_.triangle_planes.assign(triangles, no_plane);
        for (size_t i = 0; i < patches_.size(); ++i)
            if (patches_[i].convex < 0) scene_.triangle_planes[patches_[i].face] = planes_[i];
    }

    void bind_slabs(IncidentLists& incidents) {
        for (ConvexSolid& solid : convex_) solid.face_planes.assign(2 * solid.planes.size(), no_plane);
        for (size_t i = 0; i < patches_.size(); ++i)
            if (patches_[i].convex >= 0 && planes_[i] != no_plane)
                convex_[size_t(patches_[i].convex)].face_planes[patches_[i].face] = planes_[i];
        for (ConvexSolid& solid : convex_) {
            const size_t slabs = solid.planes.size();
            for (uint32_t slab = 0; slab < slabs; ++slab) bind_slab(solid, slab, incidents);
        }
        std::vector<std::vector<uint32_t>> meshes(scene_.shared_planes.size());
        for (size_t i = 0; i < patches_.size(); ++i) {
            if (planes_[i] == no_plane || scene_.solids[patches_[i].solid].kind != SolidKind::mesh) continue;
            std::vector<uint32_t>& listed = meshes[planes_[i]];
            if (listed.empty() || listed.back() != patches_[i].solid) listed.push_back(patches_[i].solid);
            bound_mesh(patches_[i].solid);
        }
        for (uint32_t plane = 0; plane < scene_.shared_planes.size(); ++plane) list_solids(plane, meshes[plane]);
    }

    /// Gives a slab the normals and the offsets of the shared planes on its sides. If these have different normals, or
    /// one side cannot follow the other, the low side becomes a slab of its own, the last.
    void bind_slab(ConvexSolid& solid, uint32_t slab, IncidentLists& incidents) {
        const uint32_t low = solid.face_planes[2 * slab], high = solid.face_planes[2 * slab + 1];
        if (low == no_plane && high == no_plane) return;
        PlanePair& pair = solid.planes[slab];
        PlanePair of_low = pair, of_high = pair;
        if (low != no_plane) take(of_low, low, false);
        if (high != no_plane) take(of_high, high, true);
        if (low == no_plane) follow(of_high.normal, solid.face_corners(2 * slab), of_low.normal, of_low.low);
        if (high == no_plane) follow(of_low.normal, solid.face_corners(2 * slab + 1), of_high.normal, of_high.high);
        pair.normal = of_high.normal;
        pair.high = of_high.high;
        pair.low = of_low.low;
        if (of_low.normal == pair.normal) return;
        const auto moved = uint32_t(2 * solid.planes.size() + 1);
        solid.face_planes[2 * slab] = no_plane;
        solid.face_planes.push_back(no_plane);
        solid.face_planes.push_back(low);
        pair.low = -INFINITY;
        solid.planes.push_back({-of_low.normal, -INFINITY, -of_low.low, false});
        for (auto& faces : incidents)
            for (Incident& incident : faces)
                if (incident.solid == solid.solid && incident.face == 2 * slab) incident.face = moved;
    }

    /// Gives a face the normal of the one opposite, through its middle, unless that moves a corner off: a small face
    /// may tilt much more than a large one.
    void follow(const dvec3& opposite, const std::vector<dvec3>& corners, dvec3& normal, double& offset) const {
        if (!corners.empty()) {
            const double through = dot(opposite, middle(corners));
            for (const dvec3& p : corners)
                if (magnitude(dot(opposite, p) - through) > coinciding * unit_) return;
            offset = through;
        }
        normal = opposite;
    }

    void take(PlanePair& pair, uint32_t plane, bool high) const {
        const SharedPlane<Real>& shared = scene_.shared_planes[plane];
        const dvec3 normal(shared.normal);
        const bool same = dot(normal, pair.normal) > 0;
        pair.normal = same ? normal : -normal;
        (high ? pair.high : pair.low) = same ? double(shared.offset) : -double(shared.offset);
    }

    /// Bounds a mesh by the sphere around its box.
    void bound_mesh(uint32_t number) {
        Solid& solid = scene_.solids[number];
        const dvec3 half = (boxes_[number].high - boxes_[number].low) / 2.0;
        solid.center = Vec3<float>(boxes_[number].low + half);
        solid.padded_square = float(dot(half, half)) + sphere_padding;
    }

    void list_solids(uint32_t plane, const std::vector<uint32_t>& meshes) {
        SharedPlane<Real>& shared = scene_.shared_planes[plane];
        shared.first_solid = uint32_t(scene_.plane_solids.size());
        for (const ConvexSolid& solid : convex_)
            if (std::find(solid.face_planes.begin(), solid.face_planes.end(), plane) != solid.face_planes.end())
                scene_.plane_solids.push_back(solid.solid);
        shared.solid_count = uint32_t(scene_.plane_solids.size()) - shared.first_solid;
        shared.mesh_count = uint32_t(meshes.size());
        scene_.plane_solids.insert(scene_.plane_solids.end(), meshes.begin(), meshes.end());
    }

    /// Lists the shared planes of each solid and of what comes near it.
    void list_near() {
        std::vector<std::vector<uint32_t>> near(scene_.solids.size());
        for (uint32_t i = 0; i < patches_.size(); ++i)
            if (planes_[i] != no_plane) near[patches_[i].solid].push_back(planes_[i]);
        for (const Pair& pair : pairs_) {
            const Patch &a = patches_[pair.first], &b = patches_[pair.second];
            if (planes_[pair.first] != no_plane) near[b.solid].push_back(planes_[pair.first]);
            if (planes_[pair.second] != no_plane) near[a.solid].push_back(planes_[pair.second]);
        }
        for (uint32_t i = 0; i < scene_.solids.size(); ++i) {
            std::sort(near[i].begin(), near[i].end());
            near[i].erase(std::unique(near[i].begin(), near[i].end()), near[i].end());
            scene_.solids[i].first_near = uint32_t(scene_.near_planes.size());
            scene_.solids[i].near_count = uint32_t(near[i].size());
            scene_.near_planes.insert(scene_.near_planes.end(), near[i].begin(), near[i].end());
        }
    }

    struct Pair {
        uint32_t first, second;
        bool one_solid;
    };

    CompiledScene<Real>& scene_;
    std::vector<ConvexSolid>& convex_;
    const std::vector<Box>& boxes_;
    const double unit_;  // u M
    const std::vector<Patch> patches_;
    std::vector<Pair> pairs_;
    std::vector<uint32_t> planes_;  // of each patch
    FirstContact first_;
};

}  // namespace

template <class Real>
FirstContact share_planes(CompiledScene<Real>& scene, std::vector<ConvexSolid>& convex, const std::vector<Box>& boxes,
                          IncidentLists& incidents) {
    return PlaneSharing<Real>(scene, convex, boxes).share(incidents);
}

template FirstContact share_planes(CompiledScene<float>&, std::vector<ConvexSolid>&, const std::vector<Box>&,
                                   IncidentLists&);
template FirstContact share_planes(CompiledScene<double>&, std::vector<ConvexSolid>&, const std::vector<Box>&,
                                   IncidentLists&);

}  // namespace cistula
