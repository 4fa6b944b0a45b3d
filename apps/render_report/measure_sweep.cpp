// Measures all settings of the sweep: errors once, times in several rounds.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <random>

#include "base/error.h"
#include "measure.h"
#include "reference.h"
#include "render/record/film_picture.h"
#include "render/target.h"
#include "sweep_plan.h"

namespace cistula::report {
namespace {

/// Least number of samples per pixel.
double least_samples(const Setting& setting) {
    return setting.adaptive() ? 4 : static_cast<double>(setting.supersample) * setting.supersample;
}

/// Whether a frame takes at least as long as that of `other`, because no knob makes it easier.
bool is_harder(const Setting& setting, const Setting& other) {
    const auto cutoff = [](const Setting& s) { return frame_settings(s, 1, 1).truncation(); };
    return other.depth <= setting.depth && cutoff(other) >= cutoff(setting) && other.precision <= setting.precision &&
           other.adaptive() == setting.adaptive() && least_samples(other) <= least_samples(setting);
}

void note_times(const Renderer& renderer, double seconds, Entry& entry) {
    entry.wall.runs.push_back(seconds * 1e3);
    const RenderTimes times = renderer.times();
    if (times.kernel <= 0 && times.transfer <= 0) return;
    entry.kernel.runs.push_back(times.kernel * 1e3);
    entry.transfer.runs.push_back(times.transfer * 1e3);
}

class Sweep {
  public:
    Sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene)
        : frames_(frames), settings_(settings), scene_(scene), plan_(plan_sweep(scene.base, settings.quick)) {
        // Easier settings first, so that harder ones can be predicted from them.
        std::stable_sort(plan_.begin(), plan_.end(), [](const PlannedSetting& a, const PlannedSetting& b) {
            const auto effort = [](const Setting& s) {
                return std::tuple(s.adaptive(), -s.target_error, s.supersample, s.precision, -s.cutoff, s.depth);
            };
            return effort(a.setting) < effort(b.setting);
        });
    }

    void run(std::vector<Entry>& entries) {
        find_reference();
        const size_t begin = entries.size();
        measure_errors(entries);
        measure_times(entries, begin);
    }

  private:
    void find_reference() {
        frames_.progress.begin(scene_.name + ": reference", 1);
        const Setting setting = reference_setting(scene_.base, settings_.quick);
        const auto found = reference_picture(frames_, scene_.hash, setting, settings_.of_reference(), settings_.cache);
        if (!found)
            throw Error(ErrorKind::failed,
                        fmt::format("{}: the reference, {}, does not get on within {:g} seconds: where next to no "
                                    "light is lost and much goes both ways, ray trees have no end; a larger --limit "
                                    "gives it more time",
                                    scene_.file, setting_name(setting), settings_.of_reference().still));
        reference_ = *found;
        scene_.reference = reference_.record;
    }

    /// The reference for one knob, rendered on first use; null if that takes too long.
    const ReferencePicture* reference_of(const std::string& knob, const Setting& setting) {
        if (reference_.record.setting == setting) return &reference_;
        for (const ReferencePicture& one : references_)
            if (one.record.setting == setting) return &one;
        if (std::find(without_end_.begin(), without_end_.end(), setting) != without_end_.end()) return nullptr;
        auto found = reference_picture(frames_, scene_.hash, setting, settings_.of_reference(), settings_.cache);
        frames_.progress.frame(0);
        if (!found) {
            without_end_.push_back(setting);
            scene_.left_out.push_back(fmt::format("{}: the reference of {}", setting_name(setting), knob));
            return nullptr;
        }
        found->record.knob = knob;
        scene_.yardsticks.push_back(found->record);
        return &references_.emplace_back(std::move(*found));
    }

    /// Measures the error of every setting. All are tried: predicting times from other settings would leave out some
    /// that are fast enough.
    void measure_errors(std::vector<Entry>& entries) {
        frames_.progress.begin(scene_.name + ": errors", static_cast<double>(plan_.size()));
        std::vector<Setting> stopped;
        Film film;
        for (const PlannedSetting& planned : plan_) {
            const Setting& setting = planned.setting;
            const bool hopeless = std::any_of(stopped.begin(), stopped.end(),
                                              [&](const Setting& other) { return is_harder(setting, other); });
            const auto seconds = hopeless ? std::nullopt : frames_.render_within(settings_.of_setting(), setting, film);
            if (!seconds) {
                if (!hopeless) stopped.push_back(setting);
                scene_.left_out.push_back(setting_name(setting));
                frames_.progress.advance();
                continue;
            }
            Entry entry;
            entry.scene = scene_.name;
            entry.setting = setting;
            entry.film_hash = film_hash(film);
            entry.rays = Rays(film.rays);
            const Picture picture = resolve_picture(film);
            entry.error = compare_with(picture, reference_.picture);
            note_samples(film, picture, entry);
            for (const auto& [knob, alone] : planned.alone)
                if (const ReferencePicture* reference = reference_of(knob, alone))
                    entry.alone[knob] = compare_with(picture, reference->picture);
            entries.push_back(std::move(entry));
            seconds_.push_back(*seconds);
            frames_.progress.advance();
        }
    }

    void note_samples(const Film& film, const Picture& picture, Entry& entry) const {
        const FrameSettings frame = frame_settings(entry.setting, frames_.width, frames_.height);
        const TargetReport report = target_report(film, frame);
        entry.samples = static_cast<double>(report.samples) / static_cast<double>(film.pixels.size());
        if (entry.setting.adaptive())
            entry.target = {share_over(entry.setting.target_error, picture, reference_.picture), report.missed};
    }

    /// Times every setting once per round, in a different order each time, so that disturbances of the machine affect
    /// all alike.
    void measure_times(std::vector<Entry>& entries, size_t begin) {
        const int rounds =
            settings_.warm_ups - 1 + settings_.repetitions;  // the frames for the errors were the first warm-up
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
    std::deque<ReferencePicture> references_;
    std::vector<Setting> without_end_;  // settings whose reference took too long
    std::vector<double> seconds_;       // of the frames in measure_errors
};

}  // namespace

void measure_sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene, Record& record) {
    Sweep(frames, settings, scene).run(record.entries);
}

}  // namespace cistula::report
