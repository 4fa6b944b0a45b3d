#include "render/scene.h"

#include <fmt/format.h>

#include <map>
#include <mutex>

namespace cistula {

/// The frames of a scene that changes; the one that was compiled last is kept.
class SceneFrames {
  public:
    SceneFrames(std::shared_ptr<const MovingScene> moving, Precision precision)
        : moving_(std::move(moving)), precision_(precision) {}

    Scene at(int frame, StopSignal stop) {
        const std::lock_guard lock(mutex_);
        if (!last_ || last_->shown() != frame) put(Scene(gather_frame(moving_, frame, stop), {precision_, "", ""}));
        return *last_;
    }
    std::string hash(int frame) {
        {
            const std::lock_guard lock(mutex_);
            if (const auto known = hashes_.find(frame); known != hashes_.end()) return known->second;
        }
        at(frame, {});
        return hash(frame);
    }
    /// Takes a frame that is compiled.
    void put(Scene scene) {
        last_ = std::make_unique<Scene>(std::move(scene));
        hashes_[last_->shown()] = last_->hashes().of(last_->shown());
    }

  private:
    const std::shared_ptr<const MovingScene> moving_;
    const Precision precision_;
    std::mutex mutex_;
    std::unique_ptr<Scene> last_;
    std::map<int, std::string> hashes_;
};

std::string in_frame(int frame, const std::string& message) {
    return fmt::format("frame {}: {}", frame, message);
}

Scene::Scene(SceneSource source, const std::optional<Precision>& wanted) {
    PrecisionChoice choice = choose_precision(wanted, smallest_part(source));
    *this = Scene(std::move(source), std::move(choice));
}

Scene::Scene(SceneSource source, PrecisionChoice choice)
    : choice_(std::move(choice)), shown_(source.description->shown), names_(name_scene(source)) {
    const std::shared_ptr<const MovingScene> moving = source.description->still ? nullptr : source.moving;
    const std::vector<std::string> of_reader = source.description->warnings;
    if (!choice_.warning.empty()) warnings_.push_back(choice_.warning);
    named_by_frame(*source.description, [&] {
        if (choice_.precision == Precision::double_)
            compile<double>(std::move(source));
        else
            compile<float>(std::move(source));
    });
    if (moving) {
        const auto frames = std::make_shared<SceneFrames>(moving, choice_.precision);
        frames->put(*this);
        frames_ = frames;
        for (std::string& warning : warnings_)
            if (warning != choice_.warning) warning = in_frame(shown_, warning);
    }
    warnings_.insert(warnings_.end(), of_reader.begin(), of_reader.end());
}

Scene Scene::at(int frame, StopSignal stop) const {
    return frames_ ? frames_->at(frame, stop) : *this;
}

FrameHashes Scene::hashes() const {
    if (frames_) return FrameHashes([frames = frames_](int frame) { return frames->hash(frame); });
    return visit([](const auto& scene) { return scene->hashes; });
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
