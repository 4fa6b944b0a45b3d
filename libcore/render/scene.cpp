#include "render/scene.h"

namespace cistula {

Scene::Scene(SceneSource source, const std::optional<Precision>& wanted) {
    PrecisionChoice choice = choose_precision(wanted, smallest_part(source));
    *this = Scene(std::move(source), std::move(choice));
}

Scene::Scene(SceneSource source, PrecisionChoice choice) : choice_(std::move(choice)), names_(name_scene(source)) {
    if (!choice_.warning.empty()) warnings_.push_back(choice_.warning);
    if (choice_.precision == Precision::double_)
        compile<double>(std::move(source));
    else
        compile<float>(std::move(source));
}

Scene::Scene(const SceneDescription& description, const std::optional<Precision>& wanted, StopSignal stop)
    : Scene(gather_scene(description, stop), wanted) {}

template <class Real>
void Scene::compile(SceneSource source) {
    std::shared_ptr<const CompiledScene<Real>> scene = compile_scene<Real>(std::move(source));
    warnings_.insert(warnings_.end(), scene->warnings.begin(), scene->warnings.end());
    compiled_ = std::move(scene);
}

}  // namespace cistula
