#include "bench/gpu/image_parity.h"

#include <fmt/format.h>

#include <fstream>

#include "apps/common/golden.h"
#include "backend_cuda/cuda_renderer.h"
#include "backend_embree/embree_renderer.h"
#include "scene/generated_scene.h"
#include "scene/read_scene.h"

namespace cistula::bench {
namespace {

/// Integers and floats of a pixel that are not the same, bit for bit.
uint64_t differing_values(const PixelRecord& a, const PixelRecord& b) {
    uint64_t count = 0;
    for (int c = 0; c < 3; ++c)
        count += (a.radiance[c] != b.radiance[c]) + (a.pruned[c] != b.pruned[c]) + (a.cut[c] != b.cut[c]) +
                 (bits_as<uint32_t>(a.normal[c]) != bits_as<uint32_t>(b.normal[c]));
    return count + (a.hits != b.hits) + (a.rays != b.rays) + (a.id != b.id) +
           (bits_as<uint32_t>(a.z) != bits_as<uint32_t>(b.z));
}

constexpr uint64_t values_of_pixel = 16, values_of_frame = 5;  // ... of a frame: ray counts and flags

struct FilmDifference {
    uint64_t compared = 0, differing = 0;
    Json first = Json::object();
};

FilmDifference compare(const Film& cpu, const Film& gpu) {
    FilmDifference d;
    d.compared = values_of_pixel * cpu.pixels.size() + values_of_frame;
    if (cpu.pixels.size() != gpu.pixels.size()) {
        d.differing = d.compared;
        return d;
    }
    for (size_t i = 0; i < cpu.pixels.size(); ++i) {
        const uint64_t count = differing_values(cpu.pixels[i], gpu.pixels[i]);
        if (count != 0 && d.differing == 0)
            d.first = {{"x", i % size_t(cpu.rect.width)},
                       {"y", i / size_t(cpu.rect.width)},
                       {"cpu", cpu.pixels[i].radiance},
                       {"gpu", gpu.pixels[i].radiance}};
        d.differing += count;
    }
    d.differing += (cpu.rays.primary != gpu.rays.primary) + (cpu.rays.reflected != gpu.rays.reflected) +
                   (cpu.rays.transmitted != gpu.rays.transmitted) + (cpu.rays.shadow != gpu.rays.shadow) +
                   (cpu.flags != gpu.flags);
    return d;
}

template <class Real>
void check(GpuRecord& record, const std::string& name, const SceneDescription& scene, const FrameSettings& settings,
           const std::string& hash) {
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    const Film cpu = golden::render_with(*make_embree_renderer<Real>(compiled), scene, settings);
    const char* precision = sizeof(Real) == sizeof(float) ? "float" : "double";
    for (const bool always_tree : {false, true})
        for (const int split : {0, 1, 3}) {
            CudaOptions options;
            options.always_tree = always_tree;
            options.split = split;
            const Film gpu = golden::render_with(*make_cuda_renderer<Real>(compiled, options), scene, settings);
            FilmDifference d = compare(cpu, gpu);
            if (!hash.empty()) {
                ++d.compared;
                d.differing += film_hash(gpu) != hash;
            }
            record.add_parity(fmt::format("{}/{}/{}/split:{}", name, precision, always_tree ? "tree" : "chosen", split),
                              d.compared, d.differing, d.first);
        }
}

}  // namespace

void check_scenes(GpuRecord& record, const std::string& folder) {
    for (const std::string& name : golden::scene_names(folder + "/scenes")) {
        const SceneDescription scene = read_scene(folder + "/scenes/" + name + ".json");
        const auto golden = nlohmann::json::parse(std::ifstream(folder + "/golden/" + name + "/golden.json"));
        const FrameSettings settings = golden::settings_for(scene);
        check<float>(record, "scenes/" + name, scene, settings, golden["float"]["hash"]);
        check<double>(record, "scenes/" + name, scene, settings, golden["double"]["hash"]);
    }
}

void check_generated(GpuRecord& record, const std::string& folder, uint64_t count) {
    for (uint64_t seed = 0; seed < count; ++seed) {
        const SceneDescription scene = generated_scene(seed, folder + "/scenes");
        const FrameSettings settings = generated_settings(scene);
        check<float>(record, fmt::format("generated/{}", seed), scene, settings, "");
        check<double>(record, fmt::format("generated/{}", seed), scene, settings, "");
    }
}

}  // namespace cistula::bench
