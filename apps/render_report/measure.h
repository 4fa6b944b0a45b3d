// Measurements of a scene for the page.
#pragma once

#include <string>

#include "frames.h"
#include "record.h"
#include "sweep_plan.h"

namespace cistula::report {

struct MeasureSettings {
    Machine machine;
    int repetitions = 10, warm_ups = 2;
    bool quick = false;
    double limit = 2;           // seconds; settings with slower frames are left out
    int width = 0, height = 0;  // 0: those of the scene's film
    std::string cache;          // folder; empty: none

    FrameLimit of_setting() const { return {.whole = limit}; }
    /// Limit for frames that the report needs: they may take long, but pixels must keep being completed.
    FrameLimit of_reference() const { return {.still = limit * reference_supersample * reference_supersample}; }
};

/// Measures a scene and adds it and its benchmarks to the record. Throws Error.
void measure_scene(const std::string& file, const MeasureSettings& settings, StepProgress& progress, Record& record);

/// The steps of measure_scene; each fills its part of the scene's record.
void measure_sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene, Record& record);
void measure_levels(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_masks(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_stages(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_parity(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);

/// Reads seed_baseline's record as a table; ours is measured for the same picture if scene and machine match.
SeedTable read_seed_table(const std::string& file);
void measure_seed_table(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                        const Record& record, SeedTable& table);
bool is_same_machine(const Json& seed_context, const Json& context);

/// Measures time against the number of triangles, lights, pixels and GPUs, and against depth.
void measure_scaling(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                     Record& record);

}  // namespace cistula::report
