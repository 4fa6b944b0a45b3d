#include "target_table.h"

#include <algorithm>
#include <cmath>

namespace cistula::report {
namespace {

constexpr int uniform_supersample = 4;

std::optional<UniformRow> uniform_row(const std::vector<const Entry*>& entries, const std::vector<TargetRow>& targets) {
    UniformRow row;
    for (const Entry* entry : entries) {
        const Setting& s = entry->setting;
        if (s.adaptive() || s.supersample != uniform_supersample || s.precision != Precision::single_) continue;
        if (row.uniform == nullptr || entry->error.rmse < row.uniform->error.rmse) row.uniform = entry;
    }
    if (row.uniform == nullptr || targets.empty()) return std::nullopt;
    const double rmse = row.uniform->error.rmse;
    for (const TargetRow& target : targets) {
        if (target.entry->error.rmse > rmse) {
            row.farther = target.entry;
            continue;
        }
        row.closer = target.entry;
        row.samples = row.closer->samples;
        break;
    }
    if (row.closer == nullptr) {
        row.farther = nullptr;
        return row;
    }
    if (row.farther != nullptr && row.closer->error.rmse > 0) {
        const double far = row.farther->error.rmse,
                     place = std::log(far / rmse) / std::log(far / row.closer->error.rmse);
        row.samples = row.farther->samples * std::pow(row.closer->samples / row.farther->samples, place);
    }
    return row;
}

}  // namespace

double TargetRow::ratio() const {
    return entry->wall.median() / fixed->wall.median();
}

TargetTable target_table(const std::vector<const Entry*>& entries) {
    TargetTable table;
    for (const Entry* entry : entries) {
        if (!entry->setting.adaptive()) continue;
        TargetRow row{entry, nullptr};
        for (const Entry* other : entries)
            if (!other->setting.adaptive() && other->error.p999 <= entry->error.p999 &&
                (row.fixed == nullptr || other->wall.median() < row.fixed->wall.median()))
                row.fixed = other;
        (entry->setting.precision == Precision::single_ ? table.rows : table.in_double).push_back(row);
    }
    for (std::vector<TargetRow>* rows : {&table.rows, &table.in_double})
        std::stable_sort(rows->begin(), rows->end(), [](const TargetRow& a, const TargetRow& b) {
            return a.entry->setting.target_error > b.entry->setting.target_error;
        });
    table.uniform = uniform_row(entries, table.rows);
    return table;
}

void to_json(Json& json, const TargetRow& row) {
    const Metrics& error = row.entry->error;
    json = {{"target_error", row.entry->setting.target_error},
            {"rmse", error.rmse},
            {"p999", error.p999},
            {"max", error.max},
            {"worst", {{"x", error.worst_x}, {"y", error.worst_y}}},
            {"over_target", row.entry->target->over},
            {"missed", row.entry->target->missed},
            {"samples", row.entry->samples},
            {"time_ms", row.entry->wall.median()},
            {"fixed", row.fixed ? Json(setting_name(row.fixed->setting)) : Json("none")}};
    if (row.fixed) {
        json["fixed_rmse"] = row.fixed->error.rmse;
        json["fixed_p999"] = row.fixed->error.p999;
        json["fixed_time_ms"] = row.fixed->wall.median();
        json["ratio"] = row.ratio();
    }
}

void to_json(Json& json, const TargetTable& table) {
    json = {{"rows", table.rows}, {"in_double", table.in_double}};
    if (!table.uniform) return;
    const UniformRow& uniform = *table.uniform;
    json["uniform"] = {{"setting", setting_name(uniform.uniform->setting)},
                       {"rmse", uniform.uniform->error.rmse},
                       {"samples", uniform.uniform->samples}};
    if (uniform.closer == nullptr) {
        json["uniform"]["adaptive"] = "none";
        return;
    }
    json["uniform"]["adaptive"] = uniform.farther ? "interpolated" : "first target";
    json["uniform"]["adaptive_samples"] = uniform.samples;
}

}  // namespace cistula::report
