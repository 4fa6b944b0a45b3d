#include "sequence/stats.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "base/stages.h"
#include "scene/compile/materials/required_effects.h"
#include "sequence/run_context.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

/// Largest resident set of this process so far in bytes.
uint64_t peak_memory() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

Json ledger(const LedgerTotals& totals) {
    return {{"mean", totals.mean}, {"worst", totals.worst}};
}

Json target_entry(const TargetReport& target) {
    const Json proven = {{"reached", target.proven()},
                         {"worst", target.worst_truncation},
                         {"pixels_truncated", target.truncated},
                         {"pixels_coarse", target.coarse},
                         {"pixels_bushy", target.bushy}};
    const Json estimated = {{"pixels_checked", target.checked},
                            {"pixels_off", target.off},
                            {"rate_at_most", rate_at_most(target.off, target.checked)},
                            {"pixels_undersampled", target.undersampled},
                            {"pixels_rounded", target.rounded}};
    return {{"pixels_missed", target.missed}, {"truncation_proven", proven}, {"sampling_estimated", estimated}};
}

Json frame_entry(const FrameStats& frame, const FrameSettings& settings, bool has_device) {
    Json entry = {{"name", fmt::format("frame/{}", frame.frame)}, {"run_type", "iteration"}, {"iterations", 1},
                  {"real_time", frame.render_seconds * 1e3},      {"time_unit", "ms"},       {"frame", frame.frame}};
    entry["file"] = frame.file;
    entry["film_hash"] = frame.hash;
    entry["pixels"] = static_cast<uint64_t>(frame.width) * static_cast<uint64_t>(frame.height);
    entry["render_ms"] = frame.render_seconds * 1e3;
    if (has_device) {
        entry["kernel_ms"] = frame.device.kernel * 1e3;
        entry["transfer_ms"] = frame.device.transfer * 1e3;
    }
    entry["encode_ms"] = frame.encode_seconds * 1e3;
    entry["write_ms"] = frame.write_seconds * 1e3;
    entry["rays"] = {{"primary", frame.rays.primary},
                     {"reflected", frame.rays.reflected},
                     {"transmitted", frame.rays.transmitted},
                     {"shadow", frame.rays.shadow},
                     {"total", frame.rays.total()}};
    entry["rays_per_second"] =
        frame.render_seconds > 0 ? static_cast<double>(frame.rays.total()) / frame.render_seconds : 0.0;
    if (settings.adaptive()) {
        entry["samples"] = frame.target.samples;
        entry["target"] = target_entry(frame.target);
    }
    entry["ledger"] = {{"pruned", ledger(frame.pruned)}, {"cut", ledger(frame.cut)}, {"units", ledger(frame.units)}};
    return entry;
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

double largest(const std::array<double, 3>& channels) {
    return *std::max_element(channels.begin(), channels.end());
}

}  // namespace

LedgerTotals ledger_totals(const Film& film, const Total (&ledger)[3]) {
    LedgerTotals totals;
    const double unit = film.unit();
    for (size_t c = 0; c < 3; ++c) {
        totals.mean[c] = film.pixels.empty() ? 0 : ledger[c].sum() * unit / static_cast<double>(film.pixels.size());
        totals.worst[c] = static_cast<double>(ledger[c].most) * unit;
    }
    return totals;
}

LedgerTotals unit_totals(const Film& film) {
    const Total& units = film.totals.units;
    return ledger_totals(film, {units, units, units});
}

DepthLoss depth_loss(const LedgerTotals& cut, const LedgerTotals& radiance) {
    return {largest(cut.mean), largest(cut.worst), largest(radiance.mean)};
}

std::string describe_depth_loss(const SequenceTotals& totals, const std::string& film, int depth) {
    if (totals.dark_frames == 0) return "";
    const DepthLoss& loss = totals.depth_loss;
    const std::string where = totals.frames == 1
                                  ? totals.first_file
                                  : fmt::format("{}: in {} of {} frames, most in frame {}", film, totals.dark_frames,
                                                totals.frames, totals.depth_loss_frame);
    return fmt::format(
        "{}: depth {} may have taken up to {:.2g} from a pixel and {:.2g} in the mean, where the picture's mean is "
        "{:.2g}: see `depth` and `layers` error",
        where, depth, loss.worst, loss.mean, loss.brightness);
}

void SequenceTotals::add(const FrameStats& frame) {
    if (frames == 0) first_file = frame.file;
    ++frames;
    pixels += static_cast<uint64_t>(frame.width) * static_cast<uint64_t>(frame.height);
    rays += frame.rays.total();
    render_seconds += frame.render_seconds;
    clamped += frame.clamped;
    clamped_frames += frame.clamped != 0;
    target.add(frame.target);
    if (!frame.depth_loss.is_seen()) return;
    if (dark_frames++ == 0 || frame.depth_loss.share() > depth_loss.share()) {
        depth_loss = frame.depth_loss;
        depth_loss_frame = frame.frame;
    }
}

StatsFile::StatsFile(const std::string& path, const FrameSettings& settings, bool has_device)
    : file_(path), settings_(settings), has_device_(has_device) {
    file_.write("{\n  \"benchmarks\": [");
}

void StatsFile::add(const FrameStats& frame) {
    file_.write((is_empty_ ? "\n" : ",\n") + text_of(frame_entry(frame, settings_, has_device_)));
    is_empty_ = false;
}

void StatsFile::finish(const RunStats& stats) {
    const StageSeconds seconds = stage_seconds();
    Json stages;
    for (size_t i = 0; i < seconds.size(); ++i) stages[stage_names[i]] = seconds[i] * 1e3;
    const PixelRect& crop = settings_.crop;
    Json context = run_context("render");
    context.update({
        {"scene", stats.scene},
        {"scene_hash", stats.scene_hash},
        {"backend", backend_name(stats.backend)},
        {"intersector", stats.intersector},
        {"precision", precision_name(stats.precision)},
        {"threads", stats.threads},
        {"lanes", stats.lanes},
        {"resolution", {settings_.full_width, settings_.full_height}},
        {"crop", {crop.x, crop.y, crop.width, crop.height}},
        {"supersample", settings_.grid()},
        {"depth", settings_.depth},
        {"cutoff", settings_.truncation()},
        {"effects_required", names_of_effects(stats.required_effects)},
        {"effects", names_of_effects(stats.effects)},
        {"effects_mask", stats.effects},
        {"scene_bytes", stats.scene_bytes},
        {"stages_ms", stages},
        {"peak_rss_bytes", peak_memory()},
        {"frames_resumed", stats.resumed},
    });
    if (settings_.adaptive()) {
        context["target_error"] = settings_.target_error;
        context["max_samples"] = settings_.max_samples;
    }
    if (has_device_) {
        context["devices"] = stats.devices;
        context["driver"] = stats.driver;
    }
    file_.write(fmt::format("\n  ],\n  \"context\": {}\n}}\n", text_of(context)));
    file_.commit();
}

}  // namespace cistula
