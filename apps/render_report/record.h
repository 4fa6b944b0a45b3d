// The measurements of a run of render-report, in Google Benchmark's format: a context and benchmarks, with the page's
// data for every scene beside them. The page is made from records alone, on any machine.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/timing.h"
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

/// The result of a setting with a target error.
struct TargetOutcome {
    double over = 0;      // share of the pixels that differ from the reference by more than the target
    uint64_t missed = 0;  // pixels reported as missed, see render/target.h
};

/// A measured setting of the sweep.
struct Entry {
    std::string scene;  // SceneRecord::name
    Setting setting;
    Timing wall, kernel, transfer;  // ms; kernel and transfer are empty if the backend has no device of its own
    std::string film_hash;
    Rays rays;
    double samples = 0;  // mean per pixel
    std::optional<TargetOutcome> target;
    Metrics error;                         // against the scene's reference: of all knobs together
    std::map<std::string, Metrics> alone;  // knob -> error against the same frame without that knob's error
};

/// A reference picture for errors.
struct ReferenceRecord {
    std::string knob;  // empty: the reference for all knobs
    Setting setting;
    Remainder remainder;  // bound on its own truncation
    double seconds = 0;   // to render it or to read it from the cache
    bool cached = false;
};

/// The largest share of light that any surface passes to one ray.
struct Share {
    std::string what;  // "reflection" or "transmission"
    std::string material;
    double value = 0;
};

/// A stage before the first pixel of a frame or after the last, in ms.
struct Stage {
    std::string name;  // "compile", "prepare", "first frame", "encode"
    std::string precision;
    Timing time;
};

/// Rays of the n-th surfaces along their paths: those that a frame of depth n has in addition to depth n - 1.
struct Level {
    int depth = 0;
    Rays rays;
};

/// Cost of a frame run by code with more effects than the scene requires.
struct MaskCost {
    uint32_t mask = 0;
    std::vector<std::string> added;  // effects beyond the smallest mask
    Timing time;
};

struct Image {
    int width = 0, height = 0;
    std::string png;  // base64
};

/// Differences between one frame of two renderers: integers and bits of floats.
struct ParityCase {
    std::string first, second, precision;
    uint64_t compared = 0, differing = 0;
};

struct SceneRecord {
    std::string name, file, hash;
    int width = 0, height = 0;
    Setting base;  // values of the other knobs when one knob is varied
    std::vector<std::string> effects;
    Share strongest, mirror;  // mirror: the largest reflection
    ReferenceRecord reference;
    std::vector<ReferenceRecord> yardsticks;
    std::vector<std::string> left_out;  // settings slower than the limit, and other parts left out for lack of time
    std::vector<Stage> stages;
    std::vector<Level> levels;
    std::vector<MaskCost> effect_costs;
    int parity_depth = 0;
    std::vector<ParityCase> parity;
    std::string first_renderer, second_renderer;  // of the two pictures
    Image first_image, second_image;
    Image heat;
    double heat_mean = 0, heat_most = 0;  // rays per pixel
};

/// Times of the seed's algorithm from seed_baseline, and ours for the same picture.
struct SeedRow {
    int depth = 0, grid = 0;  // grid 0: the seed's loop on the CPU
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
    bool same_machine = false;  // the seed's record was made on this record's machine
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
    std::string what;  // scene and settings in words
    std::vector<ScalingPoint> points;
};

struct Record {
    Json context;
    std::vector<Entry> entries;
    std::vector<SceneRecord> scenes;
    std::optional<SeedTable> seed;
    std::vector<ScalingSeries> scaling;
    std::optional<Json> verify;  // render-verify's record

    const std::string& text(const char* key) const;  // a value of the context; empty if missing
};

/// The context: machine, compiler, flags, commit, date.
Json machine_context(const std::string& backend, const std::vector<std::string>& devices, const std::string& driver);

std::string record_text(const Record& record);

/// Parses a record. Throws Error (file) if the text is none; `name` is for the message.
Record parse_record(const std::string& text, const std::string& name);

}  // namespace cistula::report
