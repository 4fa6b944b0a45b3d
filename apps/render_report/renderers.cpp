#include "renderers.h"

#include <algorithm>
#include <stdexcept>

#include "apps/common/timing.h"
#include "scene/compile/compiled_scene.h"

namespace cistula::report {
namespace {

template <class Real>
std::unique_ptr<Renderer> make_exact(const Machine& machine, std::shared_ptr<const CompiledScene<Real>> scene) {
    return make_renderer<Real>(machine.backend, std::move(scene), machine.cuda);
}

template <class Real>
std::unique_ptr<Renderer> make_native(const Machine& machine, std::shared_ptr<const CompiledScene<Real>> scene) {
    return make_renderer<Real>(machine.backend, std::move(scene), machine.cuda, Intersection::native);
}

Stage stage(const char* name, Precision precision, double seconds) {
    return {name, precision_name(precision), {{seconds * 1e3}}};
}

}  // namespace

const std::vector<Intersector>& intersectors() {
    static const std::vector<Intersector> all = {
        {"exact", [](Backend) { return true; }, make_exact<float>, make_exact<double>},
        {"native", [](Backend backend) { return backend == Backend::embree; }, make_native<float>, make_native<double>},
    };
    return all;
}

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
    std::unique_ptr<Renderer>& renderer = made_[{setting.precision, setting.intersector}];
    if (renderer) return *renderer;
    const auto& table = intersectors();
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Intersector& one) { return one.name == setting.intersector; });
    if (found == table.end()) throw std::invalid_argument("no intersector is called " + setting.intersector);
    if (setting.precision == Precision::double_) {
        const auto& scene = twice();
        stages_.push_back(
            stage("prepare", setting.precision, seconds_of([&] { renderer = found->make_double(machine_, scene); })));
    } else {
        const auto& scene = single();
        stages_.push_back(
            stage("prepare", setting.precision, seconds_of([&] { renderer = found->make_single(machine_, scene); })));
    }
    return *renderer;
}

}  // namespace cistula::report
