// Cistula's triangles, each hit exactly once, against Embree's own robust ones: primary rays on a bumpy sphere of 1.3
// million triangles, one thread; and what that sphere takes of memory. bench_intersect --memory float|double|none: in a
// process of its own, the peak while generating, compiling and building the tree (none: before any of it), in bytes.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "backend_embree/embree/embree_tree.h"
#include "program.h"
#include "scene/base/error.h"
#include "scene/frame/frame_view.h"
#include "testing/generated_mesh.h"

namespace cistula::bench {
namespace {

constexpr int width = 640, height = 480, tile = 16, repetitions = 9;

SceneDescription bumpy_scene() {
    SceneDescription scene;
    scene.source = "bumpy sphere";
    scene.camera.position = {0, -2.6, 1};
    scene.camera.field_of_view = 30;  // every ray hits
    scene.materials.emplace_back();
    ObjectDescription object;
    object.name = "sphere";
    object.material = 0;
    object.shape = bumpy_sphere(1'300'000);
    object.place = "/objects/0";
    scene.objects.push_back(std::move(object));
    return scene;
}

size_t triangles_of(const SceneDescription& scene) {
    return std::get<TrianglesObject>(scene.objects[0].shape).triangles.size();
}

/// One ray through each pixel's center, in the order in which tiles are rendered.
template <class Real>
std::vector<Ray<Real>> primary_rays(const CompiledScene<Real>& compiled, const SceneDescription& scene) {
    FrameSettings settings;
    settings.full_width = width;
    settings.full_height = height;
    const FrameView frame = frame_view(compiled, camera_at(scene.camera, 0), settings);
    std::vector<Ray<Real>> rays;
    for (int top = 0; top < height; top += tile)
        for (int left = 0; left < width; left += tile)
            for (int y = top; y < top + tile; ++y)
                for (int x = left; x < left + tile; ++x) {
                    Ray<Real> ray;
                    Vec3<double> direction;
                    double start;
                    if (primary_ray(compiled.view(), frame, x + 0.5, y + 0.5, ray, direction, start))
                        rays.push_back(ray);
                }
    return rays;
}

template <class Real>
struct Ours {
    std::unique_ptr<CompiledScene<Real>> compiled;
    SceneView<Real> view;
    std::unique_ptr<EmbreeTree<Real>> tree;
    std::vector<Ray<Real>> rays;

    explicit Ours(const SceneDescription& scene)
        : compiled(compile_scene<Real>(scene)),
          view(compiled->view()),
          tree(std::make_unique<EmbreeTree<Real>>(view, EmbreeOptions())) {}

    Hit<Real> closest(const Ray<Real>& ray) const { return EmbreeIntersector<Real>{view, tree->scene()}.closest(ray); }
};

/// Embree alone over the triangles of Ours, in their scene coordinates.
class Theirs {
  public:
    Theirs(const SceneDescription& scene, const CompiledScene<float>& compiled) {
        const auto& mesh = std::get<TrianglesObject>(scene.objects[0].shape);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
        for (const glm::dvec3& v : mesh.vertices) {
            const glm::dvec3 p = (v - compiled.center) * std::ldexp(1.0, compiled.scale);
            for (int axis = 0; axis < 3; ++axis) *vertices++ = float(p[axis]);
        }
        auto* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), mesh.triangles.size());
        std::memcpy(corners, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
        rtcCommitGeometry(geometry);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw Error(ExitCode::device, "Embree's own tree failed");
    }
    ~Theirs() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Theirs(const Theirs&) = delete;
    Theirs& operator=(const Theirs&) = delete;

    /// Infinity: nothing was hit.
    float closest(const Ray<float>& ray) const {
        EmbreeContext context;
        embree_init(context);
        RTCRayHit rayhit;
        set_ray(rayhit.ray, ray, 0.0f, RealTraits<float>::infinity);
        rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree_intersect(scene_, context, rayhit);
        return rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? RealTraits<float>::infinity : rayhit.ray.tfar;
    }

  private:
    RTCDevice device_ = rtcNewDevice("");
    RTCScene scene_ = rtcNewScene(device_);
};

struct Setting {
    SceneDescription scene = bumpy_scene();
    Ours<float> single{scene};
    Ours<double> twice{scene};
    Theirs embree{scene, *single.compiled};
};
std::unique_ptr<Setting> setting;

void count_rays(benchmark::State& state, size_t rays) {
    state.counters["rays_per_second"] = benchmark::Counter(double(rays), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["triangles"] = double(triangles_of(setting->scene));
}

template <class Real>
void time_cistula(benchmark::State& state, const Ours<Real>& ours) {
    for (auto _ : state)
        for (const Ray<Real>& ray : ours.rays) benchmark::DoNotOptimize(ours.closest(ray).t);
    count_rays(state, ours.rays.size());
}

void time_embree(benchmark::State& state) {
    for (auto _ : state)
        for (const Ray<float>& ray : setting->single.rays) benchmark::DoNotOptimize(setting->embree.closest(ray));
    count_rays(state, setting->single.rays.size());
}

/// Checks that equal work is compared: both find one surface.
void check_agreement() {
    size_t hits = 0, differing = 0;
    for (const Ray<float>& ray : setting->single.rays) {
        const float ours = setting->single.closest(ray).t, theirs = setting->embree.closest(ray);
        hits += std::isfinite(ours);
        differing += !(ours == theirs || std::abs(ours - theirs) < 1e-3f);
    }
    if (hits == 0 || differing * 1000 > hits)
        throw Error(ExitCode::failed,
                    fmt::format("of {} hits {} differ from Embree's; at most 1 in 1000 may", hits, differing));
}

void measure_memory(benchmark::State& state, const std::string& precision) {
    for (auto _ : state) {
        const std::string self = quoted(std::filesystem::read_symlink("/proc/self/exe").string());
        const auto measured = [&](const std::string& what) { return std::stod(output_of(self + " --memory " + what)); };
        const double bytes = measured(precision);
        state.counters["bytes_per_triangle"] = bytes / double(triangles_of(setting->scene));
        state.counters["peak_bytes"] = bytes;
        state.counters["empty_process_bytes"] = measured("none");
    }
}

template <class Real>
double memory_of_ours() {
    const SceneDescription scene = bumpy_scene();
    const Ours<Real> ours(scene);
    return peak_memory();
}

void register_all(const std::vector<std::string>&) {
    setting = std::make_unique<Setting>();
    setting->single.rays = primary_rays(*setting->single.compiled, setting->scene);
    setting->twice.rays = primary_rays(*setting->twice.compiled, setting->scene);
    check_agreement();
    benchmark::RegisterBenchmark("bumpy_sphere/embree_robust", time_embree)
        ->MinTime(0.1)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("bumpy_sphere/cistula/float", [](auto& s) { time_cistula(s, setting->single); })
        ->MinTime(0.1)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("bumpy_sphere/cistula/double", [](auto& s) { time_cistula(s, setting->twice); })
        ->MinTime(0.1)
        ->Unit(benchmark::kMillisecond);
    for (const char* precision : {"float", "double"})
        benchmark::RegisterBenchmark(fmt::format("bumpy_sphere/memory/{}", precision).c_str(),
                                     [=](benchmark::State& state) { measure_memory(state, precision); })
            ->Iterations(1)
            ->Repetitions(1)
            ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    using namespace cistula::bench;
    if (argc == 3 && std::strcmp(argv[1], "--memory") == 0) {
        const std::string what = argv[2];
        fmt::print("{:.0f}\n", what == "float"    ? memory_of_ours<float>()
                               : what == "double" ? memory_of_ours<double>()
                                                  : peak_memory());
        return 0;
    }
    return run_program(argc, argv, repetitions, register_all);
}
