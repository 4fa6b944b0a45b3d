// What a run of render-report measured, in Google Benchmark's shape: a context and benchmarks, and beside them what the
// page shows of every scene. The page is made of records alone, on whatever machine.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/timing.h"
#include "metrics.h"
#include "setting.h"

namespace cistula::report {

struct Rays {
    uint64_t primary = 0, reflected = 0, transmitted = 0, shadow = 0;

    Rays() = default;
    explicit Rays(const RayCounts& counts)
        : primary(counts.primary),
          reflected(counts.reflected),
          transmitted(counts.transmitted),
          shadow(counts.shadow) {}
    uint64_t total() const { return primary + reflected + transmitted + shadow; }
};

/// What a setting with a target error came to.
struct TargetOutcome {
    double over = 0;      // share of the pixels that are farther than the target from the reference
    uint64_t missed = 0;  // pixels that say so themselves: see apps/common/target.h
};

/// A setting of the sweep, measured.
struct Entry {
    std::string scene;  // SceneRecord::name
    Setting setting;
    Timing wall, kernel, transfer;  // ms; the latter two empty where the backend has no device of its own
    std::string film_hash;
    Rays rays;
    double samples = 0;  // per pixel, in the mean
    std::optional<TargetOutcome> target;
    Metrics error;                         // against the scene's reference: all knobs together
    std::map<std::string, Metrics> alone;  // knob -> against the same frame without that knob's error
};

/// What errors are measured against.
struct Yardstick {
    std::string knob;  // empty: the reference
    Setting setting;
    Remainder remainder;  // what its own truncation may hide
    double seconds = 0;   // to render it, or to read it back
    bool cached = false;
};

/// The largest share of its light that some surface hands on to one ray.
struct Share {
    std::string what;  // "reflection" or "transmission"
    std::string material;
    double value = 0;
};

/// Before the first pixel of a frame, and after the last: ms.
struct Stage {
    std::string name;  // "compile", "prepare", "first frame", "encode"
    std::string precision;
    Timing time;
};

/// Rays of the n-th surfaces along their paths: what a frame of depth n has more than one of depth n - 1.
struct Level {
    int depth = 0;
    Rays rays;
};

/// The time of a scene's frame in code that has more effects compiled in than the scene calls for.
struct MaskCost {
    uint32_t mask = 0;
    std::vector<std::string> added;  // beyond the least mask
    Timing time;
};

struct Image {
    int width = 0, height = 0;
    std::string png;  // base64
};

/// A frame by two renderers: the number of integers (and bits of floats) that are not equal.
struct ParityCase {
    std::string first, second, precision;
    uint64_t compared = 0, differing = 0;
};

struct SceneRecord {
    std::string name, file, hash;
    int width = 0, height = 0;
    Setting base;  // where each knob is turned alone, the others stay here
    std::vector<std::string> effects;
    Share strongest, mirror;  // mirror: the largest reflection
    Yardstick reference;
    std::vector<Yardstick> yardsticks;
    std::vector<std::string> left_out;  // settings that take longer than the limit, and what else for want of time
    std::vector<Stage> stages;
    std::vector<Level> levels;
    std::vector<MaskCost> effect_costs;
    int parity_depth = 0;
    std::vector<ParityCase> parity;
    std::string first_renderer, second_renderer;  // of the two pictures
    Image first_image, second_image;
    Image heat;
    double heat_mean = 0, heat_most = 0;  // rays of a pixel
};

/// The algorithm of the course work, timed by seed_baseline, and ours for the same picture.
struct SeedRow {
    int depth = 0, grid = 0;  // grid 0: the loop on the CPU
    Timing time;
};
struct OwnRow {
    int depth = 0;
    std::string precision;
    Timing time;
};
struct SeedTable {
    std::string scene;
    int width = 0, height = 0;
    Json context;
    bool same_machine = false;  // as the record's
    std::vector<SeedRow> seed;
    std::vector<OwnRow> ours;
};

struct ScalingPoint {
    double value = 0;
    Timing time;
    uint64_t rays = 0;
};
struct ScalingSeries {
    std::string name;  // "triangles", "lights", ...
    std::string what;  // the scene and settings, in words
    std::vector<ScalingPoint> points;
};

struct Record {
    Json context;
    std::vector<Entry> entries;
    std::vector<SceneRecord> scenes;
    std::optional<SeedTable> seed;
    std::vector<ScalingSeries> scaling;
    std::optional<Json> verify;  // render-verify's record

    const std::string& text(const char* key) const;  // of the context; empty where it is not there
};

/// Machine, compiler, flags, commit, date.
Json machine_context(const std::string& backend, const std::vector<std::string>& devices, const std::string& driver);

std::string record_text(const Record& record);

/// Throws Error (file) where the text is no record; `name` is for the message.
Record parse_record(const std::string& text, const std::string& name);

}  // namespace cistula::report
