// Time against the size of the scene or the frame, on generated scenes and the given one.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "measure.h"
#include "scene/description/platonic.h"
#include "scene/readers/read_scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::report {
namespace {

constexpr int width = 640, height = 480;

MaterialDescription matte() {
    MaterialDescription material;
    material.name = "matte";
    material.diffuse = 0.8;
    material.specular = 0.2;
    return material;
}

/// A scene with a camera in front of `object` at the origin, and two lights.
SceneDescription scene_of(std::variant<SolidObject, TrianglesObject, MeshObject> shape, MaterialDescription material) {
    SceneDescription scene;
    scene.source = "generated";
    scene.camera.position = {0, -3, 1};
    scene.materials = {std::move(material)};
    scene.objects = {{"body", 0, std::move(shape), "/objects/0"}};
    scene.lights.resize(2);
    scene.lights[0].position = {-4, -4, 5};
    scene.lights[1].position = {5, -3, 4};
    return scene;
}

/// A scene with `count` lights spread over the edges of an icosahedron, together as bright as two.
SceneDescription scene_with_lights(int count) {
    MaterialDescription material = matte();
    material.reflection = 0.2;
    material.transmission = 0.5;
    SolidObject solid;
    solid.solid = PlatonicSolid::icosahedron;
    SceneDescription scene = scene_of(solid, material);
    const PlatonicShape& shape = platonic_shape(solid.solid);
    const int edges = static_cast<int>(shape.edges.size());
    scene.lights.clear();
    for (int i = 0; i < count; ++i) {
        const auto& ends = shape.edges[static_cast<size_t>(i % edges)].vertices;
        const glm::dvec3 from = shape.vertices[ends[0]], to = shape.vertices[ends[1]];
        const int on_edge = i / edges, of_edge = (count - 1) / edges + 1;
        LightDescription light;
        light.position = from + (to - from) * ((on_edge + 1.0) / (of_edge + 1.0));
        light.color = glm::dvec3(2.0 / count);
        scene.lights.push_back(light);
    }
    return scene;
}

class Scaling {
  public:
    Scaling(const MeasureSettings& settings, StepProgress& progress) : settings_(settings), progress_(progress) {}

    /// Adds a measurement. False if it took longer than the limit: larger ones are then skipped. If even its first
    /// frame was too slow, it is skipped too.
    bool add(ScalingSeries& series, double value, Frames& frames, const Setting& setting) {
        progress_.begin(fmt::format("scaling: {} {:.0f}", series.name, value),
                        settings_.warm_ups + settings_.repetitions);
        ScalingPoint point;
        point.value = value;
        Film film;
        double last = 0;
        if (!frames.render_within(settings_.of_setting(), setting, film)) return false;
        progress_.advance();
        for (int round = 1; round < settings_.warm_ups + settings_.repetitions; ++round) {
            last = frames.render(setting, film);
            if (round >= settings_.warm_ups) point.time.runs.push_back(frames.kernel_ms(setting, last));
            progress_.advance();
        }
        point.rays = film.rays.total();
        series.points.push_back(std::move(point));
        return last <= settings_.limit;
    }

    bool add(ScalingSeries& series, double value, const SceneDescription& scene, const Setting& setting, int w, int h,
             const Machine& machine) {
        Frames frames(scene, machine, w, h, progress_);
        return add(series, value, frames, setting);
    }

  private:
    const MeasureSettings& settings_;
    StepProgress& progress_;
};

}  // namespace

void measure_scaling(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                     Record& record) {
    Scaling scaling(settings, progress);
    const Machine& machine = settings.machine;
    const int side = settings.quick ? 4 : 1;  // factor by which a quick frame's width and height are reduced
    const auto series = [&](const char* name, std::string what) {
        record.scaling.push_back({name, std::move(what), {}});
        return record.scaling.size() - 1;
    };
    const std::string size = fmt::format("{}x{}, float, one sample", width / side, height / side);

    size_t at = series("triangles", "a bumpy sphere that fills the frame, two lights, depth 1, " + size);
    Setting setting;
    setting.depth = 1;
    for (const uint32_t count : {1000u, 10000u, 100000u, 1000000u, 10000000u}) {
        if (settings.quick && count > 100000) break;
        const SceneDescription scene = scene_of(bumpy_sphere(count), matte());
        if (!scaling.add(record.scaling[at], count, scene, setting, width / side, height / side, machine)) break;
    }

    at = series("lights", "on the edges of an icosahedron (kr 0.2, kt 0.5), depth 4, " + size);
    setting.depth = 4;
    for (int count = 1; count <= (settings.quick ? 64 : 1024); count *= 4)
        if (!scaling.add(record.scaling[at], count, scene_with_lights(count), setting, width / side, height / side,
                         machine))
            break;

    const SceneDescription scene = read_scene(scene_file);
    const std::string name = std::filesystem::path(scene_file).filename().string();
    at = series("depth", name + ", " + size);
    {
        Frames frames(scene, machine, width / side, height / side, progress);
        for (int depth = 1; depth <= (settings.quick ? 16 : 64); depth *= 2) {
            setting.depth = depth;
            if (!scaling.add(record.scaling[at], depth, frames, setting)) break;
        }
    }

    setting.depth = scene.depth;
    at = series("pixels", fmt::format("{}, depth {}, float, one sample", name, scene.depth));
    for (int w = 80; w <= (settings.quick ? 320 : 5120); w *= 2)
        if (!scaling.add(record.scaling[at], w * (w * 9.0 / 16), scene, setting, w, w * 9 / 16, machine)) break;

    if (machine.cuda.devices.size() < 2 || machine.backend != Backend::cuda) return;
    at = series("GPUs", fmt::format("{}, 3840x2160, depth {}, float, one sample", name, scene.depth));
    for (size_t count = 1; count <= machine.cuda.devices.size(); ++count) {
        Machine part = machine;
        part.cuda.devices.resize(count);
        scaling.add(record.scaling[at], static_cast<double>(count), scene, setting, 3840, 2160, part);
    }
}

}  // namespace cistula::report
