// The cost of target errors compared with the best fixed settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record.h"

namespace cistula::report {

struct TargetRow {
    const Entry* entry = nullptr;  // the entry with the target
    const Entry* fixed = nullptr;  // the fastest fixed setting with a p999 no larger; null: none was measured

    /// The target's time divided by the fixed setting's, which must exist.
    double ratio() const;
};

/// Samples per pixel that adaptive sampling needs for the error of a uniform grid.
struct UniformRow {
    const Entry* uniform = nullptr;  // the 4x4 grid: the one with the smallest RMSE of all depths and cutoffs
    const Entry* closer = nullptr;   // the largest target whose RMSE is no larger; null: there is none
    const Entry* farther = nullptr;  // the next larger target; null: closer is the largest of all
    double samples = 0;  // per pixel: interpolated between the two in log-log; those of `closer` if there is no other
};

struct TargetTable {
    std::vector<TargetRow> rows;       // in float, by descending target
    std::vector<TargetRow> in_double;  // the smallest targets again, in double
    std::optional<UniformRow> uniform;
};

/// The table for one scene's entries, into which it points; times are medians of wall time. Targets are compared with
/// fixed settings at equal p999 (99.9 % of the pixels are as close), since a target concerns most pixels, while an RMSE
/// may be due to one. Sample counts are compared at equal RMSE, since a grid's is due to many pixels.
TargetTable target_table(const std::vector<const Entry*>& entries);

void to_json(Json& json, const TargetRow& row);
void to_json(Json& json, const TargetTable& table);

}  // namespace cistula::report
