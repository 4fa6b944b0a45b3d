// Compares one frame of all renderers that this machine has.
#include "backend_embree/embree/embree_renderer.h"
#include "image.h"
#include "measure.h"
#include "render/record/film_difference.h"
#include "render/record/film_picture.h"
#include "small_frame.h"
#include "verify/reference_renderers.h"

namespace cistula::report {
namespace {

constexpr size_t most_for_brute = 2000;  // primitives; for more the plain loop is too slow

template <class Real>
struct Named {
    std::string name;
    std::unique_ptr<Renderer> renderer;
};

/// All renderers of this machine; the others are compared with the first.
template <class Real>
std::vector<Named<Real>> all_renderers(const Machine& machine,
                                       const std::shared_ptr<const CompiledScene<Real>>& scene) {
    std::vector<Named<Real>> all;
    EmbreeOptions tree;
    tree.always_tree = true;
    all.push_back({"embree", make_embree_renderer<Real>(scene, tree)});
    if (machine.backend == Backend::cuda) {
        all.push_back({"cuda", make_renderer<Real>(Backend::cuda, scene, machine.cuda)});
    }
    auto with_tree = std::make_shared<CompiledScene<Real>>(*scene);
    build_primitive_tree(*with_tree);
    all.push_back({"bvh", make_host_renderer<Real>(with_tree, HostIntersector::bvh)});
    if (scene->convex.size() + scene->clusters.size() <= most_for_brute)
        all.push_back({"brute", make_host_renderer<Real>(scene, HostIntersector::brute)});
    return all;
}

template <class Real>
void compare_all(Frames& frames, const MeasureSettings& settings,
                 const std::shared_ptr<const CompiledScene<Real>>& compiled, Precision precision, SceneRecord& scene) {
    const auto [width, height] = small_size(frames.width, frames.height);
    Setting setting = scene.base;
    setting.precision = precision;
    const FrameSettings frame = frame_settings(setting, width, height);
    const std::vector<Named<Real>> all = all_renderers<Real>(settings.machine, compiled);
    Film first;
    for (size_t i = 0; i < all.size(); ++i) {
        Film film;
        frames.render(*all[i].renderer, frame, film);
        frames.progress.advance();
        const bool pictured = precision == Precision::single_ && i < 2;
        if (pictured) {
            (i == 0 ? scene.first_renderer : scene.second_renderer) = all[i].name;
            (i == 0 ? scene.first_image : scene.second_image) = to_image(to_color(film));
        }
        if (i == 0) {
            first = std::move(film);
            continue;
        }
        const FilmDifference difference = film_difference(first, film);
        scene.parity.push_back(
            {all[0].name, all[i].name, precision_name(precision), difference.compared, difference.differing});
    }
}

}  // namespace

void measure_parity(Frames& frames, const MeasureSettings& settings, SceneRecord& scene) {
    frames.progress.begin(scene.name + ": parity", settings.machine.backend == Backend::cuda ? 8 : 6);
    scene.parity_depth = scene.base.depth;
    compare_all<float>(frames, settings, frames.renderers.single(), Precision::single_, scene);
    compare_all<double>(frames, settings, frames.renderers.twice(), Precision::double_, scene);
}

}  // namespace cistula::report
