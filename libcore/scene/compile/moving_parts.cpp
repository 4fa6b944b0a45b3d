#include "scene/compile/moving_parts.h"

#include <algorithm>
#include <map>

#include "scene/compile/contacts/flat_faces.h"
#include "scene/compile/scene_normalization.h"
#include "scene/compile/scene_source.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "scene/readers/meshes/polygon_mesh.h"

namespace cistula {
namespace {

using glm::dvec3;

/// A sphere around a mesh file's vertices, in its own coordinates.
struct MeshBall {
    dvec3 center{0};
    double radius = 0;

    explicit MeshBall(const MeshData& data) {
        Box box;
        for (const PolygonMesh& group : data.groups)
            for (const dvec3& p : group.vertices)
                if (is_finite(p)) box.add(p);
        if (box.empty()) return;
        center = 0.5 * box.low + 0.5 * box.high;
        for (const PolygonMesh& group : data.groups)
            for (const dvec3& p : group.vertices)
                if (is_finite(p)) radius = max_or_second(length(p - center), radius);
        radius *= 1 + 0x1p-40;  // above all rounding of placed vertices
    }

    Box box(const MeshObject& mesh) const {
        const dvec3 placed = mesh.center + Rotation(mesh.rotation)(mesh.scale * center);
        const dvec3 reach(mesh.scale * radius + 0x1p-40 * length(placed));
        return {placed - reach, placed + reach};
    }
};

/// The number of a shape that its parts are multiples of; 1: none changes their size alone.
double size_of(const decltype(ObjectDescription::shape)& shape) {
    if (const auto* solid = std::get_if<SolidObject>(&shape)) return solid->radius * polyhedron_of(*solid).inradius;
    if (const auto* sphere = std::get_if<SphereObject>(&shape)) return sphere->radius;
    if (const auto* mesh = std::get_if<MeshObject>(&shape)) return mesh->scale;
    return 1;
}

/// Whether a box comes within `reach` of a plane without end.
bool meets(const DiskObject& plane, const Box& box, double reach) {
    const dvec3 normal = normalized(plane.normal);
    const dvec3 half = 0.5 * (box.high - box.low);
    double most = reach;
    for (int axis = 0; axis < 3; ++axis) most += magnitude(normal[axis]) * half[axis];
    return magnitude(dot(normal, box.low + half - plane.center)) <= most;
}

}  // namespace

MovingParts::MovingParts(const SceneDescription& description, const SceneAssets& assets,
                         const std::function<SceneSource(const SceneDescription&)>& gather, StopSignal stop) {
    const Motion& motion = *description.motion;
    std::map<size_t, MeshBall> meshes;
    for (const size_t i : motion.objects)
        if (assets.meshes[i]) meshes.emplace(i, *assets.meshes[i]);
    SceneDescription at = description;
    SceneDescription part = description;  // what changes, but for meshes
    first_ = motion.frames.front();
    for (int frame = first_; frame <= motion.frames.back(); ++frame) {
        stop.check();
        motion.set(at, frame);
        part.shown = frame;
        part.objects.clear();
        part.lights.clear();
        std::vector<Part> parts;
        std::vector<size_t> gathered;  // the part that is each of the description's objects
        for (const size_t i : motion.objects) {
            parts.push_back({{}, size_of(at.objects[i].shape)});
            if (const auto mesh = meshes.find(i); mesh != meshes.end()) {
                parts.back().box = mesh->second.box(std::get<MeshObject>(at.objects[i].shape));
                continue;
            }
            part.objects.push_back(at.objects[i]);
            gathered.push_back(parts.size() - 1);
        }
        for (const size_t i : motion.lights) {
            const LightDescription& light = at.lights[i];
            part.lights.push_back(light);
            parts.push_back(
                {{light.position - dvec3(light.radius), light.position + dvec3(light.radius)}, light.radius});
            if (light.shown()) box.add(parts.back().box);
        }
        const SceneSource source = named_by_frame(part, [&] { return gather(part); });
        for (const SourceSolid& solid : source.solids) parts[gathered[solid.object]].box.add(world_box(solid));
        for (size_t k = 0; k < motion.objects.size(); ++k) box.add(parts[k].box);
        frames_.push_back(std::move(parts));
    }
}

std::vector<int> MovingParts::frames_of_smaller(const SceneSource& source) const {
    const Motion& motion = *source.description->motion;
    std::vector<double> least;
    for (const Part& part : frames_.front()) least.push_back(part.size);
    for (const int frame : motion.frames)
        for (size_t k = 0; k < least.size(); ++k)
            least[k] = min_or_second(frames_[size_t(frame - first_)][k].size, least[k]);
    return frames_between(motion, [&](const std::vector<Part>& parts) {
        for (size_t k = 0; k < parts.size(); ++k)
            if (parts[k].size < least[k]) return true;
        return false;
    });
}

std::vector<int> MovingParts::frames_of_meetings(const SceneSource& source, double reach) const {
    const Motion& motion = *source.description->motion;
    std::vector<Box> still;
    std::vector<const DiskObject*> planes;
    for (const SourceSolid& solid : source.solids) {
        if (std::binary_search(motion.objects.begin(), motion.objects.end(), solid.object)) continue;
        if (solid.disk && solid.disk->is_endless())
            planes.push_back(solid.disk);
        else
            still.push_back(world_box(solid));
    }
    for (size_t i = 0; i < source.description->lights.size(); ++i)
        if (const dvec3& p = source.description->lights[i].position;
            !std::binary_search(motion.lights.begin(), motion.lights.end(), i))
            still.push_back({p, p});
    const NearSolids at_rest(still, std::vector<double>(still.size(), reach));
    return frames_between(motion, [&](const std::vector<Part>& parts) {
        std::vector<Box> boxes;
        for (const Part& part : parts) boxes.push_back(part.box);
        const NearSolids together(boxes, std::vector<double>(boxes.size(), reach / 2));
        for (uint32_t k = 0; k < parts.size(); ++k)
            if (boxes[k].empty() || together.meets_another(boxes[k], k) || at_rest.meets_another(boxes[k], no_solid) ||
                std::any_of(planes.begin(), planes.end(),
                            [&](const DiskObject* plane) { return meets(*plane, boxes[k], reach); }))
                return true;
        return false;
    });
}

template <class Asks>
std::vector<int> MovingParts::frames_between(const Motion& motion, const Asks& asks) const {
    std::vector<int> frames;
    for (size_t i = 0; i < frames_.size(); ++i) {
        const int frame = first_ + int(i);
        if (!std::binary_search(motion.frames.begin(), motion.frames.end(), frame) && asks(frames_[i]))
            frames.push_back(frame);
    }
    return frames;
}

}  // namespace cistula
