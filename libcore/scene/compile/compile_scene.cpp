#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/default_rounding.h"
#include "base/error.h"
#include "cistula/geometry/ray.h"
#include "cistula/lights/light_tree.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/smooth_faces.h"
#include "scene/compile/lights/compile_lights.h"
#include "scene/compile/lights/radiance_bound.h"
#include "scene/compile/materials/compile_materials.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/compile/meshes/corner_normals.h"
#include "scene/compile/meshes/mesh_apex.h"
#include "scene/compile/scene_hash.h"
#include "scene/compile/solids/compile_balls.h"
#include "scene/compile/solids/compile_disks.h"
#include "scene/compile/solids/compile_solids.h"
#include "scene/compile/solids/near_solids.h"
#include "scene/compile/solids/placed_bodies.h"
#include "scene/description/rotation.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Returns memory to the system that the allocator keeps after the tree build of a large mesh, before the largest
/// arrays are filled.
void return_free_memory([[maybe_unused]] uint32_t triangles) {
#ifdef __GLIBC__
    if (triangles >= 100'000) malloc_trim(0);
#endif
}

}  // namespace

/// What takes long for a mesh and needs nothing of others.
struct PreparedMesh {
    ApexHeights heights;
    Groups groups;
    Tree tree;  // over groups
    ApexFaults faults;
    Box box;
};

/// What was prepared of meshes that do not change, and the vertices that contacts gave them.
struct MeshCache {
    using Key = std::tuple<size_t, uint32_t, std::string, size_t>;  // object, body, part, size of numbers
    std::mutex mutex;
    std::map<Key, std::pair<std::vector<dvec3>, PreparedMesh>> meshes;
};

std::shared_ptr<MeshCache> new_mesh_cache() {
    return std::make_shared<MeshCache>();
}

namespace {

constexpr uint32_t most_outlined = 16;  // triangles of a mesh that is outlined by its corners; larger ones by their box

/// One compilation; its steps are called in the order of their dependencies.
template <class Real>
class Compiler {
  public:
    explicit Compiler(SceneSource source)
        : description_(*source.description),
          source_(std::move(source)),
          bodies_(*source_.bodies),
          normalization_(bodies_.normalization) {}

    std::unique_ptr<CompiledScene<Real>> compile() {
        if (source_.solids.size() >= no_solid)
            throw scene_error(
                description_, "/objects",
                std::to_string(source_.solids.size()) + " solids: at most " + std::to_string(no_solid - 1));
        scene_.center = normalization_.center;
        scene_.scale = normalization_.scale;
        scene_.extent = rounded_up<Real>(normalization_.extent);
        scene_.warnings = std::move(source_.warnings);
        for (std::string& warning : contact_warnings(source_, normalization_, bodies_.contacts))
            scene_.warnings.push_back(std::move(warning));
        scene_.solids.resize(source_.solids.size());
        scene_.hulls.resize(source_.solids.size());
        places_.boxes.resize(source_.solids.size());
        places_.distances.resize(source_.solids.size());
        places_.bulges.resize(source_.solids.size());
        flat_planes_.resize(source_.solids.size());
        primitives_.assign(source_.solids.size(), effect_triangles);
        if (description_.contact) hash_.add(*description_.contact);
        hash_.add(normalization_.center);
        hash_.add(static_cast<uint32_t>(normalization_.scale));
        if (source_.moving) hash_.add(normalization_.extent);

        for (const SolidContacts& solid : bodies_.contacts.solids) scene_.reaches.push_back(solid.reach);
        compile_convex();
        compile_balls();
        compile_disks();
        lights_ = normalize_lights(source_, normalization_, bodies_.convex);
        light_faces_.resize(lights_.size());
        find_convex_incidents(lights_, bodies_, incident_reach(), light_faces_);
        find_disk_incidents(lights_, bodies_, scene_.solids, incident_reach(), light_faces_);
        for (uint32_t i = 0; i < source_.solids.size(); ++i) {
            scene_.solid_names.push_back(name_of(source_.solids[i]));
            scene_.solids[i].material = source_.solids[i].material;
        }
        smooth_faces_ = find_smooth_faces(source_, bodies_);
        if (!smooth_faces_.warning.empty()) scene_.warnings.push_back(smooth_faces_.warning);
        compile_meshes();
        settle_on_faces();
        add_shared_planes(scene_, bodies_.contacts);
        list_shared_planes(scene_, bodies_, places_.boxes);
        add_disks(scene_, source_, bodies_.disks, normalization_);
        find_near_balls(scene_, bodies_.balls, places_.boxes, flat_planes_);
        refuse_lights_on_balls();
        add_slabs();
        compile_shading();
        compile_lights();
        add_hulls();
        find_touching_solids(scene_, places_.boxes);
        find_isolated_solids(scene_, bodies_.disks);
        find_unseen_faces(scene_);
        find_crossed_bulges(scene_, source_, places_);
        explain();
        scene_.hashes = FrameHashes(hash_.hex());
        return std::make_unique<CompiledScene<Real>>(std::move(scene_));
    }

  private:
    void compile_convex() {
        for (uint32_t i = 0; i < source_.solids.size(); ++i) {
            if (!source_.solids[i].polyhedron) continue;
            for (const PlanePair& p : convex_solid(*source_.solids[i].polyhedron, i, normalization_).planes) {
                hash_.add(p.normal);
                hash_.add(p.low);
                hash_.add(p.high);
            }
            hash_.add(i);
        }
        for (const ConvexSolid& convex : bodies_.convex) {
            Solid& solid = scene_.solids[convex.solid];
            solid = {};
            solid.kind = SolidKind::convex;
            bound_sphere(convex, solid);
            scene_.convex.push_back(convex.solid);
            places_.boxes[convex.solid] = convex.box;
            primitives_[convex.solid] = effect_solids;
        }
    }

    void compile_balls() {
        for (const PlacedBall& ball : bodies_.balls) {
            hash_.add(ball.center);
            hash_.add(ball.radius);
            hash_.add(ball.solid);
            if (source_.materials[source_.solids[ball.solid].material].texture >= 0)
                for (const dvec3& axis : ball.axes) hash_.add(axis);
            places_.boxes[ball.solid] = ball.box();
            primitives_[ball.solid] = effect_spheres;
        }
        add_balls(scene_, bodies_.balls);
    }

    /// All of disks but what needs their planes in the scene's precision (add_disks).
    void compile_disks() {
        for (uint32_t i = 0; i < bodies_.disks.size(); ++i) {
            const PlacedDisk& disk = bodies_.disks[i];
            hash_.add(disk.solid);
            hash_.add(disk.object->normal);
            hash_.add(disk.equation.normal);
            hash_.add(disk.equation.offset);
            hash_.add(disk.is_endless() ? dvec3(0) : disk.center);
            hash_.add(disk.radius);
            Solid& solid = scene_.solids[disk.solid];
            solid = {};
            solid.kind = SolidKind::sheet;
            solid.first_slab = i;
            solid.slab_count = disk_slabs;
            solid.first_triangle = triangle_count_;
            triangle_count_ += triangles_of_disk;
            primitives_[disk.solid] = effect_planes;
            flat_planes_[disk.solid] = disk.equation;
            places_.boxes[disk.solid] = disk.is_endless() ? bodies_.sizes[disk.solid].box : disk.box();
            if (disk.is_endless()) scene_.hulls[disk.solid].reach = INFINITY;
        }
    }

    /// Shadow rays know whether a light is inside a ball, so it must not be on one.
    void refuse_lights_on_balls() const {
        for (const NormalizedLight& light : lights_)
            for (const PlacedBall& ball : bodies_.balls)
                if (light.lights() && ball.distance(light.position) <= incident_reach())
                    throw scene_error(description_, light.place,
                                      std::string(light.convex < 0 ? "the light lies" : "a light on its edges lies") +
                                          " on the surface of the sphere " + source_.solids[ball.solid].place,
                                      "move it inside or outside");
    }

    void add_slabs() {
        for (const ConvexSolid& convex : bodies_.convex) {
            Solid& solid = scene_.solids[convex.solid];
            solid.first_slab = static_cast<uint32_t>(scene_.slabs.size());
            solid.slab_count = static_cast<uint32_t>(convex.planes.size());
            for (uint32_t i = 0; i < convex.planes.size(); ++i)
                scene_.slabs.push_back(
                    {Vec3<Real>(convex.planes[i].normal), offset_of(convex, 2 * i), offset_of(convex, 2 * i + 1)});
            if (!scene_.shared_planes.empty())
                scene_.slab_planes.insert(scene_.slab_planes.end(), convex.face_planes.begin(),
                                          convex.face_planes.end());
            group_slabs(scene_.slabs, solid, scene_.slab_groups);
        }
    }

    /// The offset of a slab's face: that of its shared plane, bit by bit, if it has one.
    Real offset_of(const ConvexSolid& convex, uint32_t face) const {
        const PlanePair& pair = convex.planes[face / 2];
        const uint32_t plane = convex.face_planes[face];
        if (plane == no_plane) return static_cast<Real>(face % 2 == 1 ? pair.high : pair.low);
        const SharedPlane<Real>& shared = scene_.shared_planes[plane];
        return dot(dvec3(shared.normal), pair.normal) > 0 ? shared.offset : -shared.offset;
    }

    NormalizedMesh placed_mesh(uint32_t number) const {
        return {source_.solids[number].mesh, normalization_, bodies_.contacts.solids[number].points,
                sizeof(Real) == sizeof(float)};
    }

    /// Prepares a mesh; one that does not change, once for all frames in which contacts move the same vertices.
    PreparedMesh prepare(uint32_t number) {
        const SourceSolid& from = source_.solids[number];
        const MovingScene* const moving = source_.moving.get();
        if (!moving || moving->solids[from.object].empty()) return prepared_anew(number);
        MeshCache& cache = *moving->meshes;
        const MeshCache::Key key{from.object, from.body, from.name, sizeof(Real)};
        const std::vector<dvec3>& points = bodies_.contacts.solids[number].points;
        {
            const std::lock_guard lock(cache.mutex);
            const auto known = cache.meshes.find(key);
            if (known != cache.meshes.end() && known->second.first == points) return known->second.second;
        }
        PreparedMesh prepared = prepared_anew(number);
        const std::lock_guard lock(cache.mutex);
        cache.meshes[key] = {points, prepared};
        return prepared;
    }

    PreparedMesh prepared_anew(uint32_t number) {
        SourceSolid& from = source_.solids[number];
        const NormalizedMesh mesh = placed_mesh(number);
        PreparedMesh prepared;
        prepared.heights =
            apex_heights(mesh, from.edges.next.empty() ? link_edges(from.mesh) : std::exchange(from.edges, {}));
        source_.stop.check();
        prepared.groups = group_triangles(mesh, source_.stop);
        prepared.tree = group_tree(mesh, prepared.groups);
        prepared.faults = check_apexes(mesh, prepared.groups, prepared.tree, prepared.heights, source_.stop);
        prepared.box = tbb::parallel_reduce(
            tbb::blocked_range<uint32_t>(0, mesh.size(), 4096), Box(),
            [&](const auto& range, Box box) {
                for (uint32_t t = range.begin(); t != range.end(); ++t)
                    for (const dvec3& corner : mesh.triangle(t)) box.add(corner);
                return box;
            },
            [](Box box, const Box& next) {
                box.add(next);
                return box;
            });
        return prepared;
    }

    /// Hashes and compiles the meshes in order. Small ones are prepared side by side, some at a time.
    void compile_meshes() {
        // but for those of the last
        constexpr uint32_t most_at_once = 4096;
        constexpr uint32_t most_triangles = 100'000;
        const auto count = static_cast<uint32_t>(source_.solids.size());
        std::vector<PreparedMesh> prepared;
        for (uint32_t first = 0, end = 0; first < count; first = end) {
            for (size_t triangles = 0; end < count && end - first < most_at_once && triangles < most_triangles; ++end)
                triangles += source_.solids[end].mesh.triangles.size();
            const auto is_mesh = [&](uint32_t i) {
                return !source_.solids[i].polyhedron && primitives_[i] == effect_triangles;
            };
            prepared.resize(end - first);
            tbb::parallel_invoke(
                [&] {
                    for (uint32_t i = first; i < end; ++i)
                        if (source_.solids[i].is_mesh()) hash_mesh(i);
                },
                [&] {
                    tbb::parallel_for(first, end, [&](uint32_t i) {
                        if (is_mesh(i)) prepared[i - first] = prepare(i);
                    });
                });
            source_.stop.check();
            for (uint32_t i = first; i < end; ++i)
                if (is_mesh(i)) compile_mesh(i, std::move(prepared[i - first]));
        }
    }

    /// The whole parts that a triangle's u and v lose where they lie far from 0, in units of uv times repeat: those of
    /// its least corner, so that float keeps the digits that tell texels apart. Even for a mirrored picture.
    std::array<double, 2> lost_parts(const SourceSolid& from, const TriangleCorners& corners) const {
        std::array<double, 2> parts{};
        const int number = source_.materials[from.material].texture;
        if (number < 0 || from.mesh.uvs.empty()) return parts;  // as of a disk
        const TextureDescription& texture = description_.textures[static_cast<size_t>(number)];
        for (int axis = 0; axis < 2; ++axis) {
            const TextureWrap wrap = texture.wrap[static_cast<size_t>(axis)];
            if (wrap == TextureWrap::clamp) continue;
            double least = INFINITY;
            for (const uint32_t corner : corners)
                least = min_or_second(from.mesh.uvs[corner][axis] * texture.repeat[axis], least);
            const double period = wrap == TextureWrap::mirror ? 2 : 1;
            const double part = period * floor_of(least / period);
            if (magnitude(part) < 0x1p52) parts[static_cast<size_t>(axis)] = part;  // beyond, no digits are left
        }
        return parts;
    }

    /// The texture coordinates of a corner of a triangle that loses these parts.
    dvec2 near_uv(const SourceSolid& from, uint32_t corner, const std::array<double, 2>& parts) const {
        dvec2 uv = from.mesh.uvs[corner];
        const dvec2 repeat =
            description_.textures[static_cast<size_t>(source_.materials[from.material].texture)].repeat;
        for (int axis = 0; axis < 2; ++axis)
            if (const double part = parts[static_cast<size_t>(axis)]; part != 0)
                uv[axis] = fused(uv[axis], repeat[axis], -part) / repeat[axis];
        return uv;
    }

    void compile_mesh(uint32_t number, PreparedMesh prepared) {
        SourceSolid& from = source_.solids[number];
        const NormalizedMesh mesh = placed_mesh(number);
        find_lights_on(number, mesh, prepared);
        prepared.tree = {};
        return_free_memory(mesh.size());

        Solid& solid = scene_.solids[number];
        solid.kind = from.closed ? SolidKind::mesh : SolidKind::sheet;
        solid.first_slab = solid.slab_count = 0;
        solid.flat = !from.closed && is_flat(mesh, 4 * RealTraits<Real>::unit * normalization_.extent, solid,
                                             flat_planes_[number])
                         ? 1
                         : 0;
        solid.first_triangle = triangle_count_;
        solid.first_uv = static_cast<uint32_t>(scene_.uvs.size());
        append_clusters(mesh, prepared.groups, prepared.heights, number, triangle_count_, scene_.clusters);
        places_.boxes[number] = prepared.box;
        const bool textured = source_.materials[from.material].texture >= 0;
        const bool outlined = mesh.size() <= most_outlined;
        for (uint32_t t = 0; t < mesh.size() && (textured || outlined); ++t) {
            const std::array<double, 2> parts = lost_parts(from, mesh.corners(t));
            for (const uint32_t corner : mesh.corners(t)) {
                if (outlined) scene_.hulls[number].points.push_back(mesh.vertex(corner));
                if (textured) scene_.uvs.push_back(Vec2<Real>(near_uv(from, corner, parts)));
            }
        }
        if (!from.normals.empty()) add_normals(number, mesh);
        triangle_count_ += mesh.size();
        from.mesh = {};  // its triangles are now stored in the clusters
    }

    /// Adds the normals of a mesh's corners. Triangles on shared planes are flat but for those that keep their normals,
    /// and so are slivers that rounding has turned away from their normals.
    void add_normals(uint32_t number, const NormalizedMesh& mesh) {
        scene_.solids[number].first_slab = static_cast<uint32_t>(scene_.normals.size()) + 1;
        for (uint32_t t = 0; t < mesh.size(); ++t) {
            const std::array<dvec3, 3>& normals = source_.solids[number].normals[t];
            const std::array<dvec3, 3> corners = mesh.triangle(t);
            const dvec3 face = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
            bool is_flat = bodies_.contacts.plane_of(number, t) != no_plane && !smooth_faces_.keeps(number, t);
            double bulge = 0;
            for (size_t c = 0; c < 3; ++c) {
                is_flat = is_flat || !(dot(normals[c], face) >= least_cosine / 2);
                for (const dvec3& corner : corners)
                    bulge = max_or_second(magnitude(dot(normals[c], corners[c] - corner)), bulge);
            }
            for (const dvec3& normal : normals)
                scene_.normals.push_back(is_flat ? Vec3<Real>(Real(0)) : Vec3<Real>(normal));
            if (!is_flat) places_.bulges[number] = max_or_second(bulge, places_.bulges[number]);
        }
        source_.solids[number].normals = {};
    }

    /// Whether all corners lie within `tolerance` of the plane of the largest triangle, which is then stored in the
    /// solid and in `plane`.
    static bool is_flat(const NormalizedMesh& mesh, double tolerance, Solid& solid,
                        std::optional<PlaneEquation>& plane) {
        dvec3 normal(0), on(0);
        for (uint32_t t = 0; t < mesh.size(); ++t) {
            const auto corners = mesh.corners(t);
            const dvec3 a = mesh.vertex(corners[0]);
            const dvec3 n = cross(mesh.vertex(corners[1]) - a, mesh.vertex(corners[2]) - a);
            if (dot(n, n) > dot(normal, normal)) normal = n, on = a;
        }
        if (!(dot(normal, normal) > 0)) return false;
        normal = normalized(normal);
        for (uint32_t t = 0; t < mesh.size(); ++t)
            for (const uint32_t corner : mesh.corners(t))
                if (magnitude(dot(normal, mesh.vertex(corner) - on)) > tolerance) return false;
        solid.plane_normal = Vec3<float>(normal);
        solid.plane_offset = float(dot(normal, on));
        plane = {normal, dot(normal, on)};
        return true;
    }

    /// Finds which lights lie on a mesh and how near others come, and warns of what was found wrong with it.
    void find_lights_on(uint32_t number, const NormalizedMesh& mesh, const PreparedMesh& prepared) {
        const SourceSolid& from = source_.solids[number];
        const auto warn_of = [&](uint32_t sides, const char* what) {
            if (sides > 0 && from.closed)
                scene_.warnings.push_back(from.place + ": " + name_of(from) + ": the mesh " + what +
                                          std::to_string(sides) + " sides of triangles; rays may leak there");
        };
        warn_of(prepared.faults.crossed, "passes through itself at ");
        warn_of(prepared.faults.unchecked, "is too crowded to be checked at ");
        const SolidContacts& contacts = bodies_.contacts.solids[number];
        find_triangle_incidents(lights_, NormalizedMesh(from.mesh, normalization_, contacts.points, false),
                                prepared.groups, prepared.tree, number, triangle_count_, contacts.reach,
                                incident_reach(), light_faces_);
        const LightFaces none(lights_.size());  // light in the plane of a smooth face may fall on it
        places_.distances[number] =
            light_distances(lights_, mesh, prepared.groups, prepared.tree, number, triangle_count_,
                            from.normals.empty() ? light_faces_ : none, normalization_.extent, 2 * incident_reach());
    }

    /// Moves lights onto the faces on which they lie; distances from where they were then say nothing.
    void settle_on_faces() {
        const std::vector<bool> moved =
            settle_lights(lights_, light_faces_, 4 * RealTraits<double>::unit * normalization_.extent);
        for (std::vector<LightDistance>& distances : places_.distances)
            std::erase_if(distances, [&](const LightDistance& distance) { return moved[distance.light]; });
    }

    void hash_mesh(uint32_t number) {
        const MeshSource& mesh = source_.solids[number].mesh;
        hash_.add(number);
        for (size_t v = 0; v < mesh.vertices.size(); ++v) {
            if (v % 65536 == 0) source_.stop.check();
            hash_.add(normalization_.point(mesh.vertices[v]));
        }
        hash_.add_bytes(mesh.triangles.data(), mesh.triangles.size_bytes());
        if (source_.solids[number].keep_triangles) hash_.add(1u);
        for (const auto& corners : source_.solids[number].normals)
            for (const dvec3& normal : corners) hash_.add(normal);
        if (source_.materials[source_.solids[number].material].texture < 0) return;
        for (const auto& uv : mesh.uvs) hash_.add(uv.x), hash_.add(uv.y);
        for (const TriangleCorners& corners : mesh.triangles)  // with the hash of before for all that lose none
            for (const double part : lost_parts(source_.solids[number], corners))
                if (part != 0) hash_.add(part);
    }

    void compile_shading() {
        TextureSet textures = join_textures(source_);
        for (const ConvexSolid& convex : bodies_.convex)
            places_.distances[convex.solid] =
                light_distances(lights_, convex, light_faces_, normalization_.extent, 2 * incident_reach());
        for (const PlacedBall& ball : bodies_.balls)
            places_.distances[ball.solid] = light_distances(lights_, ball, normalization_.extent, 2 * incident_reach());
        for (const PlacedDisk& disk : bodies_.disks) {
            if (disk.is_endless())  // lights are no farther from the box than from the plane
                for (const NormalizedLight& light : lights_)
                    places_.boxes[disk.solid].add(light.position -
                                                  disk.equation.distance(light.position) * disk.equation.normal);
            places_.distances[disk.solid] =
                light_distances(lights_, disk, light_faces_, normalization_.extent, 2 * incident_reach());
        }
        const dvec3 bound =
            radiance_bound(source_, textures, places_, 1 / normalization_.factor, lights_, scene_.warnings);
        scale_ = radiance_scale(description_, bound, sizeof(Real) == sizeof(float));
        scene_.radiance_exponent = scale_.exponent;
        for (int c = 0; c < 3; ++c) scene_.bound[c] = rounded_up<Real>(scale_.bound[c]);
        scene_.background = Vec3<Real>(scaled(description_.background));
        std::vector<double> sizes(source_.materials.size());  // of the largest solid of each
        for (size_t i = 0; i < places_.boxes.size(); ++i) {
            double& size = sizes[source_.solids[i].material];
            if (!places_.boxes[i].empty() && !source_.solids[i].disk)
                size = max_or_second(length(places_.boxes[i].high - places_.boxes[i].low), size);
        }
        for (size_t i = 0; i < source_.materials.size(); ++i) {
            const MaterialDescription& material = source_.materials[i];
            const int texture = material.texture < 0 ? -1 : textures.number[static_cast<size_t>(material.texture)];
            scene_.materials.push_back(compile_material<Real>(material, scaled(description_.ambient), texture, sizes[i],
                                                              normalization_, description_));
        }
        for (const SourceSolid& solid : source_.solids) {
            const MaterialDescription& material = source_.materials[solid.material];
            hash_.add(material);
            hash_.add(static_cast<uint32_t>(scene_.materials[solid.material].texture));
        }
        for (const Texture& t : textures.textures) {
            hash_.add(t.width);
            hash_.add(t.height);
            hash_.add(static_cast<uint32_t>(t.filter));
            hash_.add(t.repeat[0]);
            hash_.add(t.repeat[1]);
            for (const TextureWrap wrap : t.wrap)  // with the hash of before for all that repeat
                if (wrap != TextureWrap::repeat) hash_.add(static_cast<uint32_t>(wrap));
        }
        for (const Texture& t : textures.textures)
            hash_.add_bytes(textures.texels.data() + t.first_texel,
                            size_t{t.width} * t.height * sizeof(textures.texels[0]));
        hash_.add(description_.ambient);
        hash_.add(description_.background);
        hash_.add(scale_.bound);
        hash_.add(static_cast<uint32_t>(scale_.exponent));
        compile_sky(textures);
        scene_.textures = std::move(textures.textures);
        scene_.texels = std::move(textures.texels);
    }

    void compile_sky(const TextureSet& textures) {
        if (!description_.sky) return;
        const SkyDescription& sky = *description_.sky;
        Sky& to = scene_.sky;
        to.kind = sky.texture < 0 ? SkyKind::gradient : SkyKind::picture;
        hash_.add(static_cast<uint32_t>(to.kind));
        if (to.kind == SkyKind::gradient) {
            to.axes[2] = normalized(sky.axis);
            for (const SkyColor& stop : sky.stops)
                scene_.sky_stops.push_back({sine_cosine_of_degrees(stop.degrees).cosine, scaled(stop.color)});
        } else {
            const Rotation rotation(sky.rotation);
            for (int axis = 0; axis < 3; ++axis) {
                dvec3 unit(0);
                unit[axis] = 1;
                to.axes[axis] = rotation(unit);
            }
            to.texture = static_cast<uint32_t>(textures.number[static_cast<size_t>(sky.texture)]);
            to.scale = std::ldexp(sky.scale, -scale_.exponent);
            hash_.add(to.texture);
        }
        for (const dvec3& axis : to.axes) hash_.add(axis);
        hash_.add(to.scale);
        for (const SkyStop& stop : scene_.sky_stops) hash_.add(stop.cosine), hash_.add(stop.color);
        const auto lights = [](const NormalizedLight& light) { return light.lights(); };
        if (description_.ambient != dvec3(0) || std::any_of(lights_.begin(), lights_.end(), lights)) return;
        scene_.warnings.push_back(scene_error(description_, "/background",
                                              "it is seen, mirrored and refracted, but lights nothing",
                                              "`ambient` and lights do")
                                      .what());
    }

    void compile_lights() {
        LayerNames names;
        for (const SourceSolid& solid : source_.solids) {
            names.objects.push_back(name_of(solid));
            names.object_materials.push_back(solid.material);
        }
        for (const MaterialDescription& material : source_.materials) names.materials.push_back(material.name);
        std::unordered_map<std::string, uint32_t> groups;
        std::vector<uint32_t> owners;  // of visible lights
        for (size_t i = 0; i < lights_.size(); ++i) {
            const NormalizedLight& light = lights_[i];
            hash_.add(light.position);
            hash_.add(light.color);
            hash_.add(light.radiance);
            hash_.add(light.radius);
            hash_.add(static_cast<uint32_t>(light.falloff));
            if (light.radius > 0 && !light.shown) hash_.add(1u);
            const Vec3<Real> position(light.position), intensity(scaled(light.color));
            if (!is_finite(position) || !is_finite(intensity))
                throw scene_error(description_, light.place,
                                  std::string("the light is beyond the range of ") + RealTraits<Real>::name);
            if (light.shown) {
                const Vec3<Real> radiance(scaled(light.radiance));
                scene_.visible_lights.push_back({position, static_cast<Real>(light.radius), radiance});
                names.visible_lights.push_back(light.group);
                owners.push_back(light.convex < 0 ? no_solid : bodies_.convex[static_cast<size_t>(light.convex)].solid);
            }
            if (!light.lights()) continue;
            auto& faces = light_faces_[i];
            std::sort(faces.begin(), faces.end(), [](const LightFace& a, const LightFace& b) {
                const Incident &x = a.incident, &y = b.incident;
                return x.solid != y.solid ? x.solid < y.solid : x.face < y.face;
            });
            const auto first = static_cast<uint32_t>(scene_.incidents.size());
            scene_.lights.push_back({position, intensity, static_cast<Real>(light.falloff ? light.radius : 0.0), first,
                                     static_cast<uint32_t>(faces.size())});
            for (const LightFace& face : faces) scene_.incidents.push_back(face.incident);
            const auto [group, is_new] = groups.try_emplace(light.group, uint32_t(names.light_groups.size()));
            if (is_new) names.light_groups.push_back(light.group);
            scene_.light_groups.push_back(group->second);
        }
        scene_.layer_names = std::make_shared<const LayerNames>(std::move(names));
        if (scene_.visible_lights.size() < fewest_in_light_tree) return;
        std::vector<RTCBuildPrimitive> primitives;
        for (const auto& light : scene_.visible_lights) {
            const dvec3 center(light.center), radius{light.radius};
            Box box{center - radius, center + radius};
            primitives.push_back(padded_primitive(box, 0x1p-18 * static_cast<double>(scene_.extent),
                                                  static_cast<uint32_t>(primitives.size())));
        }
        scene_.visible_light_tree = light_tree(build_tree(primitives, 1));
        reach_edge_lights(scene_, owners);
    }

    /// Adds a hull for each solid with the visible lights on its edges, and for every other visible light.
    void add_hulls() {
        for (const ConvexSolid& convex : bodies_.convex) scene_.hulls[convex.solid].points = convex.vertices;
        for (uint32_t i = 0; i < source_.solids.size(); ++i)
            if (scene_.hulls[i].points.empty() && !places_.boxes[i].empty())
                for (const dvec3& corner : places_.boxes[i].corners()) scene_.hulls[i].points.push_back(corner);
        for (const NormalizedLight& light : lights_) {
            if (!light.shown) continue;
            if (light.convex < 0) {
                scene_.hulls.push_back({{light.position}, light.radius});
            } else {
                Hull& hull = scene_.hulls[bodies_.convex[static_cast<size_t>(light.convex)].solid];
                hull.reach = max_or_second(hull.reach, light.radius);
            }
        }
    }

    void explain() {
        std::vector<MaterialUse> uses;
        for (size_t i = 0; i < source_.solids.size(); ++i)
            uses.push_back({&source_.materials[source_.solids[i].material], source_.solids[i].place,
                            source_.solids[i].closed, primitives_[i], is_smooth(scene_.solids[i])});
        scene_.effect_reasons =
            explain_effects(description_, uses, light_on_face(source_, lights_, light_faces_), contact());
        scene_.effects = required_effects(scene_.effect_reasons);
    }

    /// What touches: a sentence with the first two objects; empty where none do.
    std::string contact() const {
        const Contacts& contacts = bodies_.contacts;
        if (contacts.planes.empty()) return "";
        const std::string &first = source_.solids[contacts.first[0]].place,
                          &second = source_.solids[contacts.first[1]].place;
        if (source_.solids[contacts.first[0]].disk && first == second)
            return first + " is a plane or a disk, whose plane all shares that touches it";
        std::string text = first == second ? "faces of " + first : "faces of " + first + " and " + second;
        text += " lie in one plane";
        if (contacts.pairs > 1)
            text += fmt::format("; {} pairs of faces touch in all, in {} plane{}", contacts.pairs,
                                contacts.planes.size(), contacts.planes.size() == 1 ? "" : "s");
        if (contacts.farthest_move > 0)
            text += fmt::format("; to lie there, vertices were moved by up to {:.2g} ({})",
                                contacts.farthest_move / normalization_.factor, source_.solids[contacts.moved].place);
        return text;
    }

    /// How far from a face a light may be to lie on it: 16 u M.
    double incident_reach() const { return static_cast<double>(incidence<Real>) * normalization_.extent; }

    dvec3 scaled(const dvec3& radiance) const {
        return {std::ldexp(radiance.x, -scale_.exponent), std::ldexp(radiance.y, -scale_.exponent),
                std::ldexp(radiance.z, -scale_.exponent)};
    }

    const SceneDescription& description_;
    SceneSource source_;
    const PlacedBodies& bodies_;
    const SceneNormalization& normalization_;
    CompiledScene<Real> scene_;
    std::vector<NormalizedLight> lights_;
    LightFaces light_faces_;
    SolidPlaces places_;
    std::vector<uint32_t> primitives_;                       // the effect of what each solid is made of
    std::vector<std::optional<PlaneEquation>> flat_planes_;  // of each flat sheet
    SmoothFaces smooth_faces_;
    uint32_t triangle_count_ = 0;
    RadianceScale scale_;
    SceneHash hash_;
};

}  // namespace

template <class Real>
std::unique_ptr<CompiledScene<Real>> compile_scene(const SceneDescription& description, StopSignal stop) {
    return compile_scene<Real>(gather_scene(description, stop));
}

template <class Real>
std::unique_ptr<CompiledScene<Real>> compile_scene(SceneSource source) {
    return in_default_rounding([&] { return Compiler<Real>(std::move(source)).compile(); });
}

template std::unique_ptr<CompiledScene<float>> compile_scene(const SceneDescription&, StopSignal);
template std::unique_ptr<CompiledScene<double>> compile_scene(const SceneDescription&, StopSignal);
template std::unique_ptr<CompiledScene<float>> compile_scene(SceneSource);
template std::unique_ptr<CompiledScene<double>> compile_scene(SceneSource);

}  // namespace cistula
