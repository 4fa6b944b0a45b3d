// From a scene to what the page says about it.
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
    double limit = 2;           // seconds: settings whose frames take longer are left out
    int width = 0, height = 0;  // 0: the scene's film
    std::string cache;          // folder; empty: none

    FrameLimit of_setting() const { return {.whole = limit}; }
    /// What is needed may take long, but must get on.
    FrameLimit of_reference() const { return {.still = limit * reference_supersample * reference_supersample}; }
};

/// Adds the scene and its benchmarks to the record. Throws Error.
void measure_scene(const std::string& file, const MeasureSettings& settings, StepProgress& progress, Record& record);

/// The steps, each of which fills its part of the scene's record.
void measure_sweep(Frames& frames, const MeasureSettings& settings, SceneRecord& scene, Record& record);
void measure_levels(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_masks(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_stages(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);
void measure_parity(Frames& frames, const MeasureSettings& settings, SceneRecord& scene);

/// seed_baseline's record as a table, ours measured for the same picture if the scene is the same and the machine too.
SeedTable read_seed_table(const std::string& file);
void measure_seed_table(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                        const Record& record, SeedTable& table);
bool is_same_machine(const Json& seed_context, const Json& context);

/// Time against triangles, lights, depth, pixels and GPUs.
void measure_scaling(const std::string& scene_file, const MeasureSettings& settings, StepProgress& progress,
                     Record& record);

}  // namespace cistula::report
