#include "renderers.h"

#include "base/timing.h"
#include "scene/compile/compiled_scene.h"

namespace cistula::report {
namespace {

Stage stage(const char* name, Precision precision, double seconds) {
    return {name, precision_name(precision), {{seconds * 1e3}}};
}

}  // namespace

const std::shared_ptr<const CompiledScene<float>>& Renderers::single() {
    if (!single_)
        stages_.push_back(
            stage("compile", Precision::single_, seconds_of([&] { single_ = compile_scene<float>(scene_); })));
    return single_;
}

const std::shared_ptr<const CompiledScene<double>>& Renderers::twice() {
    if (!twice_)
        stages_.push_back(
            stage("compile", Precision::double_, seconds_of([&] { twice_ = compile_scene<double>(scene_); })));
    return twice_;
}

Renderer& Renderers::of(const Setting& setting) {
    std::unique_ptr<Renderer>& renderer = made_[setting.precision];
    if (renderer) return *renderer;
    const auto prepare = [&](const auto& scene) {
        const double seconds = seconds_of([&] { renderer = make_renderer(machine_.backend, scene, machine_.cuda); });
        stages_.push_back(stage("prepare", setting.precision, seconds));
    };
    if (setting.precision == Precision::double_)
        prepare(twice());
    else
        prepare(single());
    return *renderer;
}

}  // namespace cistula::report
