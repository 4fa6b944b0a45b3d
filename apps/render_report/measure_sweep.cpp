// All settings of the sweep: errors once, times in rounds.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "apps/render/target.h"
#include "measure.h"
#include "reference.h"
#include "scene/film_picture.h"
#include "sweep_plan.h"

namespace cistula::report {
namespace {

/// At least, of a pixel.
double least_samples(const Setting& setting) {
    return setting.adaptive() ? 4 : static_cast<double>(setting.supersample) * setting.supersample;
}

/// How many times as long a frame takes at least as that of `other`; 0: nothing is known.
double least_ratio(const Setting& setting, const Setting& other) {
    const auto cutoff = [](const Setting& s) { return frame_settings(s, 1, 1).truncation(); };
    if (other.depth > setting.depth || cutoff(other) < cutoff(setting) || other.precision > setting.precision ||
        other.intersector != setting.intersector)
        return 0;
    if (other.adaptive()) return setting.adaptive() ? 1 : 0;  // the cutoffs are the targets'
    const double ratio = least_samples(setting) / least_samples(other);
    return ratio >= 1 ? ratio : 0;
}

/// How long a frame will take at least, from what is known of easier ones; 0: nothing is.
double predicted_seconds(const Setting& setting, const std::vector<std::pair<Setting, double>>& known) {
    double most = 0;
    for (const auto& [other, seconds] : known) most = std::max(most, seconds * least_ratio(setting, other));
    return most;
}

void note_times(const Renderer& renderer, double seconds, Entry& entry) {
    entry.wall.runs.push_back(seconds * 1e3);
    const RenderTimes times = renderer.times();
    if (times.kernel <= 0 && times.transfer <= 0) return;
    entry.kernel.runs.push_back(times.kernel * 1e3);
    entry.transfer.runs.push_back(times.transfer * 1e3);
}

std::vector<std::string> other_intersectors(Backend backend) {
    std::vector<std::string> names;
    for (const Intersector& one : intersectors())
        if (one.offered(backend) && one.name != Setting().intersector) names.push_back(one.name);
    return names;
}

class Sweep {
  public:
    Sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene)
        : frames_(frames),
          settings_(settings),
          scene_(scene),
          plan_(plan_sweep(scene.base, settings.quick, other_intersectors(settings.machine.backend))) {
        // Easier ones first, so that they tell of harder ones.
        std::stable_sort(plan_.begin(), plan_.end(), [](const PlannedSetting& a, const PlannedSetting& b) {
            const auto effort = [](const Setting& s) {
                return std::tuple(s.adaptive(), -s.target_error, s.supersample, s.precision, -s.cutoff, s.depth);
            };
            return effort(a.setting) < effort(b.setting);
        });
    }

    void run(std::vector<Entry>& entries) {
        find_yardsticks();
        const size_t begin = entries.size();
        measure_errors(entries);
        measure_times(entries, begin);
    }

  private:
    void find_yardsticks() {
        frames_.progress.begin(scene_.name + ": reference", 1);
        reference_ =
            reference_picture(frames_, scene_.hash, reference_setting(scene_.base, settings_.quick), settings_.cache);
        scene_.reference = reference_.yardstick;
        std::vector<std::pair<std::string, Setting>> wanted;
        for (const PlannedSetting& planned : plan_)
            for (const auto& [knob, setting] : planned.alone)
                if (yardstick_of(setting) == nullptr &&
                    std::none_of(wanted.begin(), wanted.end(), [&](const auto& one) { return one.second == setting; }))
                    wanted.emplace_back(knob, setting);
        frames_.progress.begin(scene_.name + ": references of single knobs", static_cast<double>(wanted.size()));
        for (const auto& [knob, setting] : wanted) {
            yardsticks_.push_back(reference_picture(frames_, scene_.hash, setting, settings_.cache));
            yardsticks_.back().yardstick.knob = knob;
            scene_.yardsticks.push_back(yardsticks_.back().yardstick);
            frames_.progress.advance();
        }
    }

    const ReferencePicture* yardstick_of(const Setting& setting) const {
        if (reference_.yardstick.setting == setting) return &reference_;
        for (const ReferencePicture& one : yardsticks_)
            if (one.yardstick.setting == setting) return &one;
        return nullptr;
    }

    void measure_errors(std::vector<Entry>& entries) {
        frames_.progress.begin(scene_.name + ": errors", static_cast<double>(plan_.size()));
        std::vector<std::pair<Setting, double>> known;
        Film film;
        for (const PlannedSetting& planned : plan_) {
            if (predicted_seconds(planned.setting, known) > settings_.limit) {
                scene_.left_out.push_back(setting_name(planned.setting));
                frames_.progress.advance();
                continue;
            }
            Entry entry;
            entry.scene = scene_.name;
            entry.setting = planned.setting;
            known.emplace_back(planned.setting, frames_.render(planned.setting, film));
            entry.film_hash = film_hash(film);
            entry.rays = Rays(film.rays);
            const Picture picture = resolve_picture(film);
            entry.error = compare_with(picture, reference_.picture);
            note_samples(film, picture, entry);
            for (const auto& [knob, setting] : planned.alone)
                entry.alone[knob] = compare_with(picture, yardstick_of(setting)->picture);
            entries.push_back(std::move(entry));
            frames_.progress.advance();
        }
        seconds_.clear();
        for (const auto& [setting, seconds] : known) seconds_.push_back(seconds);
    }

    void note_samples(const Film& film, const Picture& picture, Entry& entry) const {
        const FrameSettings frame = frame_settings(entry.setting, frames_.width, frames_.height);
        const TargetReport report = target_report(film, frame);
        entry.samples = static_cast<double>(report.samples) / static_cast<double>(film.pixels.size());
        if (entry.setting.adaptive())
            entry.target = {share_over(entry.setting.target_error, picture, reference_.picture), report.missed};
    }

    /// One run of each a round, in another order every time: what disturbs the machine for a while disturbs all alike.
    void measure_times(std::vector<Entry>& entries, size_t begin) {
        const int rounds = settings_.warm_ups - 1 + settings_.repetitions;  // the errors' frames were the first warm-up
        const double seconds = std::accumulate(seconds_.begin(), seconds_.end(), 0.0);
        frames_.progress.begin(scene_.name + ": times", seconds * rounds);
        std::vector<size_t> order(entries.size() - begin);
        std::iota(order.begin(), order.end(), size_t{0});
        std::mt19937 random(1);
        Film film;
        for (int round = 0; round < rounds; ++round) {
            std::shuffle(order.begin(), order.end(), random);
            for (const size_t i : order) {
                Entry& entry = entries[begin + i];
                const double time = frames_.render(entry.setting, film);
                if (round >= settings_.warm_ups - 1) note_times(frames_.renderers.of(entry.setting), time, entry);
                frames_.progress.advance(seconds_[i]);
            }
        }
    }

    Frames& frames_;
    const MeasureSettings& settings_;
    SceneRecord& scene_;
    std::vector<PlannedSetting> plan_;
    ReferencePicture reference_;
    std::vector<ReferencePicture> yardsticks_;
    std::vector<double> seconds_;  // of the frames of measure_errors
};

}  // namespace

void measure_sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene, Record& record) {
    Sweep(frames, settings, scene).run(record.entries);
}

}  // namespace cistula::report
