#include "record.h"

#include <fmt/format.h>

#include <set>
#include <string>

#include "base/error.h"
#include "html_page.h"
#include "scene/readers/json_reader.h"
#include "sequence/run_context.h"
#include "target_table.h"

namespace cistula {

static void to_json(report::Json& json, const Timing& timing) {
    json = timing.runs;
}
static void from_json(const report::Json& json, Timing& timing) {
    json.get_to(timing.runs);
}

}  // namespace cistula

namespace cistula::report {

CISTULA_RECORD_FIELDS(Rays, primary, reflected, transmitted, shadow)
CISTULA_RECORD_FIELDS(TargetOutcome, over, missed)
CISTULA_RECORD_FIELDS(ReferenceRecord, knob, setting, remainder, seconds, cached)
CISTULA_RECORD_FIELDS(Share, what, material, value)
CISTULA_RECORD_FIELDS(Stage, name, precision, time)
CISTULA_RECORD_FIELDS(Level, depth, rays)
CISTULA_RECORD_FIELDS(MaskCost, mask, added, time)
CISTULA_RECORD_FIELDS(Image, width, height, png)
CISTULA_RECORD_FIELDS(ParityCase, first, second, precision, compared, differing)
CISTULA_RECORD_FIELDS(SceneRecord, name, file, hash, width, height, base, effects, strongest, mirror, reference,
                      yardsticks, left_out, stages, levels, effect_costs, parity_depth, parity, first_renderer,
                      second_renderer, first_image, second_image, heat, heat_mean, heat_most)
CISTULA_RECORD_FIELDS(SeedRow, depth, grid, time)
CISTULA_RECORD_FIELDS(OwnRow, depth, precision, time)
CISTULA_RECORD_FIELDS(SeedTable, scene, width, height, context, same_machine, seed, ours)
CISTULA_RECORD_FIELDS(ScalingPoint, value, time, rays)
CISTULA_RECORD_FIELDS(ScalingSeries, name, what, points)

void to_json(Json& json, const Entry& entry) {
    const std::string name = entry.scene + "/" + setting_name(entry.setting);
    json = {{"name", name},
            {"run_name", name},
            {"run_type", "iteration"},
            {"iterations", entry.wall.runs.size()},
            {"real_time", entry.wall.median()},
            {"time_unit", "ms"},
            {"repetition_times", entry.wall}};
    if (!entry.kernel.empty()) json["kernel_ms"] = entry.kernel, json["transfer_ms"] = entry.transfer;
    json["scene"] = entry.scene;
    json["setting"] = entry.setting;
    json["film_hash"] = entry.film_hash;
    json["rays"] = entry.rays;
    json["samples"] = entry.samples;
    if (entry.target) json["target"] = *entry.target;
    json["error"] = entry.error;
    json["alone"] = entry.alone;
}

void from_json(const Json& json, Entry& entry) {
    json.at("repetition_times").get_to(entry.wall);
    if (json.contains("kernel_ms")) {
        json.at("kernel_ms").get_to(entry.kernel);
        json.at("transfer_ms").get_to(entry.transfer);
    }
    json.at("scene").get_to(entry.scene);
    json.at("setting").get_to(entry.setting);
    json.at("film_hash").get_to(entry.film_hash);
    json.at("rays").get_to(entry.rays);
    json.at("samples").get_to(entry.samples);
    if (json.contains("target")) entry.target = json.at("target").get<TargetOutcome>();
    json.at("error").get_to(entry.error);
    for (const auto& [knob, metrics] : json.at("alone").items()) metrics.get_to(entry.alone[knob]);
}

namespace {

Json parity_totals(const Record& record) {
    uint64_t compared = 0, differing = 0;
    for (const SceneRecord& scene : record.scenes)
        for (const ParityCase& one : scene.parity) compared += one.compared, differing += one.differing;
    return {{"compared", compared}, {"differing", differing}};
}

/// Tables of targets by scene, for other programs; the page computes its own from the entries.
Json target_tables(const Record& record) {
    Json tables = Json::object();
    for (const SceneRecord& scene : record.scenes) {
        std::vector<const Entry*> entries;
        for (const Entry& entry : record.entries)
            if (entry.scene == scene.name) entries.push_back(&entry);
        tables[scene.name] = target_table(entries);
    }
    return tables;
}

void require(bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error(what);
}

/// Throws unless counts and sizes are whole numbers. The JSON library casts any number, and a cast of 1e300 has no
/// value.
void check_whole_numbers(const Json& json) {
    static const std::set<std::string> whole = {
        "depth",    "supersample", "width",  "height",  "grid",      "parity_depth", "x",      "y",   "mask",
        "compared", "differing",   "missed", "primary", "reflected", "transmitted",  "shadow", "rays"};
    for (const auto& [key, value] : json.items()) {
        require(!value.is_number_float() || whole.count(key) == 0, key + " is no whole number");
        if (value.is_structured()) check_whole_numbers(value);
    }
}

/// Throws if the record violates what the page relies on, beyond the types.
void check(const Record& record) {
    require(record.context.is_object(), "its context is no object");
    for (const Entry& entry : record.entries) {
        require(!entry.wall.empty(), setting_name(entry.setting) + " has no times");
        require(entry.setting.adaptive() == entry.target.has_value(),
                setting_name(entry.setting) + ": a target is met or missed, and nothing else is");
        bool known = false;
        for (const SceneRecord& scene : record.scenes) known = known || scene.name == entry.scene;
        require(known, "no scene is called " + entry.scene);
    }
    for (const SceneRecord& scene : record.scenes)
        require(scene.width > 0 && scene.height > 0, scene.name + " has no size");
}

}  // namespace

const std::string& Record::text(const char* key) const {
    static const std::string none;
    const auto found = context.find(key);
    return found != context.end() && found->is_string() ? found->get_ref<const std::string&>() : none;
}

Json machine_context(const std::string& backend, const std::vector<std::string>& devices, const std::string& driver) {
    Json context = run_context("render-report");
    context["backend"] = backend;
    if (!devices.empty()) {
        context["devices"] = devices;
        context["driver"] = driver;
        context["gpu_driver"] = gpu_driver_version();
#ifdef CISTULA_CUDA_COMPILER
        context["cuda_compiler"] = CISTULA_CUDA_COMPILER;
        context["cuda_flags"] = CISTULA_CUDA_FLAGS;
#endif
    }
    return context;
}

std::string record_text(const Record& record) {
    Json json = {{"context", record.context}, {"benchmarks", record.entries}, {"scenes", record.scenes}};
    json["parity"] = parity_totals(record);
    json["targets"] = target_tables(record);
    json["scaling"] = record.scaling;
    if (record.seed) json["seed"] = *record.seed;
    if (record.verify) json["verify"] = *record.verify;
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Record parse_record(const std::string& text, const std::string& name) {
    try {
        const Json json = parse_json(text, "its JSON");
        check_whole_numbers(json);
        Record record;
        json.at("context").get_to(record.context);
        json.at("benchmarks").get_to(record.entries);
        json.at("scenes").get_to(record.scenes);
        json.at("scaling").get_to(record.scaling);
        if (json.contains("seed")) record.seed = json.at("seed").get<SeedTable>();
        if (json.contains("verify")) record.verify = json.at("verify");
        check(record);
        (void)report_page({record});  // what has no page is no record
        return record;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::file, fmt::format("{}: is no record of render-report ({}); give what its --json wrote",
                                                 name, error.what()));
    }
}

}  // namespace cistula::report
