// Cistula's triangles, each hit exactly once, against Embree's own robust ones, by single rays and by packets of 16:
// primary and mirrored rays on a bumpy sphere of 1.3 million triangles, one thread; and what that sphere takes of
// memory. bench_intersect --memory float|double|none: in a process of its own, the peak while generating, compiling and
// building the tree (none: before any of it), in bytes.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "backend_embree/embree/embree_tree.h"
#include "base/error.h"
#include "base/shown_text.h"
#include "program.h"
#include "render/frame/frame_view.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::bench {
namespace {

constexpr int width = 640;
constexpr int height = 480;
constexpr int tile = 16;
constexpr int repetitions = 9;

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

/// The kinds of rays.
enum Rays { primary, mirrored, ray_kinds };
constexpr const char* ray_names[] = {"primary", "mirrored"};

template <class Real>
struct Ours {
    std::unique_ptr<CompiledScene<Real>> compiled;
    SceneView<Real> view;
    std::unique_ptr<EmbreeTree<Real>> tree;
    std::vector<Ray<Real>> rays[ray_kinds];

    explicit Ours(const SceneDescription& scene)
        : compiled(compile_scene<Real>(scene)),
          view(compiled->view()),
          tree(std::make_unique<EmbreeTree<Real>>(view, EmbreeOptions())) {}

    Hit<Real> closest(const Ray<Real>& ray) const { return EmbreeIntersector<Real>{view, tree->scene()}.closest(ray); }

    /// Shoots the primary rays, and what the surface mirrors of them.
    void find_rays(const SceneDescription& scene) {
        rays[primary] = primary_rays(*compiled, scene);
        for (const Ray<Real>& ray : rays[primary]) {
            const Hit<Real> hit = closest(ray);
            if (!hit.found()) continue;
            const auto s = surface_at<Real, Effects<all_effects>>(view, ray, hit);
            rays[mirrored].push_back(spawned(s.viewer_side, reflected(ray.direction, s.normal), hit, ray.media));
        }
    }
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
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw Error(ErrorKind::device, "Embree's own tree failed");
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

    /// The least t of 16 rays from `ray` on; infinity where nothing was hit.
    void closest_of_16(const Ray<float>* ray, float (&t)[16]) const {
        alignas(64) static constexpr int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
        RTCRayHit16 packet;
        for (int i = 0; i < 16; ++i) {
            RTCRayHit one;
            set_ray(one.ray, ray[i], 0.0f, RealTraits<float>::infinity);
            packet.ray.org_x[i] = one.ray.org_x, packet.ray.org_y[i] = one.ray.org_y,
            packet.ray.org_z[i] = one.ray.org_z;
            packet.ray.dir_x[i] = one.ray.dir_x, packet.ray.dir_y[i] = one.ray.dir_y,
            packet.ray.dir_z[i] = one.ray.dir_z;
            packet.ray.tnear[i] = 0.0f, packet.ray.tfar[i] = RealTraits<float>::infinity;
            packet.ray.time[i] = 0.0f, packet.ray.mask[i] = ~0u, packet.ray.id[i] = 0, packet.ray.flags[i] = 0;
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        EmbreeContext context;
        embree_init(context);
        embree_intersect_16(scene_, context, all, packet);
        for (int i = 0; i < 16; ++i)
            t[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? RealTraits<float>::infinity : packet.ray.tfar[i];
    }

  private:
    static void embree_intersect_16(RTCScene scene, EmbreeContext& context, const int* valid, RTCRayHit16& packet) {
#if CISTULA_EMBREE_MAJOR >= 4
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        rtcIntersect16(valid, scene, &packet, &arguments);
#else
        rtcIntersect16(valid, scene, &context, &packet);
#endif
    }

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
void time_cistula(benchmark::State& state, const Ours<Real>& ours, Rays kind) {
    for (auto _ : state)
        for (const Ray<Real>& ray : ours.rays[kind]) benchmark::DoNotOptimize(ours.closest(ray).t);
    count_rays(state, ours.rays[kind].size());
}

void time_embree(benchmark::State& state, Rays kind) {
    for (auto _ : state)
        for (const Ray<float>& ray : setting->single.rays[kind]) benchmark::DoNotOptimize(setting->embree.closest(ray));
    count_rays(state, setting->single.rays[kind].size());
}

void time_embree_packets(benchmark::State& state, Rays kind) {
    const std::vector<Ray<float>>& rays = setting->single.rays[kind];
    const size_t packets = rays.size() / 16;
    for (auto _ : state)
        for (size_t i = 0; i < packets; ++i) {
            float t[16];
            setting->embree.closest_of_16(&rays[16 * i], t);
            benchmark::DoNotOptimize(t);
        }
    count_rays(state, 16 * packets);
}

/// Checks that equal work is compared: both find one surface.
void check_agreement() {
    size_t hits = 0;
    size_t differing = 0;
    const std::vector<Ray<float>>& rays = setting->single.rays[primary];
    for (size_t i = 0; i < rays.size(); ++i) {
        const float ours = setting->single.closest(rays[i]).t;
        const auto differs = [&](float theirs) { return !(ours == theirs || std::abs(ours - theirs) < 1e-3f); };
        hits += std::isfinite(ours);
        differing += differs(setting->embree.closest(rays[i]));
        if (i % 16 != 0 || i + 16 > rays.size()) continue;
        float t[16];
        setting->embree.closest_of_16(&rays[i], t);
        differing += differs(t[0]);
    }
    if (hits == 0 || differing * 1000 > hits)
        throw Error(ErrorKind::failed,
                    fmt::format("of {} hits {} differ from Embree's; at most 1 in 1000 may", hits, differing));
}

void measure_memory(benchmark::State& state, const std::string& precision) {
    for (auto _ : state) {
        const std::string self = shell_word(std::filesystem::read_symlink("/proc/self/exe").string());
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
    setting->single.find_rays(setting->scene);
    setting->twice.find_rays(setting->scene);
    check_agreement();
    for (const Rays kind : {primary, mirrored}) {
        const auto add = [&](const char* name, auto run) {
            benchmark::RegisterBenchmark(fmt::format("bumpy_sphere/{}/{}", ray_names[kind], name).c_str(), run)
                ->MinTime(0.1)
                ->Unit(benchmark::kMillisecond);
        };
        add("embree_robust", [=](benchmark::State& state) { time_embree(state, kind); });
        add("embree_robust_16", [=](benchmark::State& state) { time_embree_packets(state, kind); });
        add("cistula/float", [=](benchmark::State& state) { time_cistula(state, setting->single, kind); });
        add("cistula/double", [=](benchmark::State& state) { time_cistula(state, setting->twice, kind); });
    }
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
