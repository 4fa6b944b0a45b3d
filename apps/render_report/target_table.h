// What a target error costs, beside the best that fixed settings do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record.h"

namespace cistula::report {

struct TargetRow {
    const Entry* entry = nullptr;  // with the target
    const Entry* fixed = nullptr;  // the quickest fixed setting with a p999 no larger; null: none was measured

    /// The target's time over the fixed setting's; there must be one.
    double ratio() const;
};

/// How many samples a pixel takes adaptively for the error of a uniform grid.
struct UniformRow {
    const Entry* uniform = nullptr;  // 4x4, of all depths and cutoffs that with the smallest RMSE
    const Entry* closer = nullptr;   // the largest target whose RMSE is no larger; null: none is that close
    const Entry* farther = nullptr;  // the next larger one: samples lie between; null: closer is the largest of all
    double samples = 0;              // per pixel: between the two in log-log; of `closer` where there is no other
};

struct TargetTable {
    std::vector<TargetRow> rows;       // in float, by falling target
    std::vector<TargetRow> in_double;  // the small ones again
    std::optional<UniformRow> uniform;
};

/// The table of one scene's entries, into which it points, by median wall time. As close is what keeps 99.9 % of the
/// pixels as close: a target speaks of these, while an RMSE may be one pixel's. Samples are compared at an RMSE, since
/// that of a grid is made by many pixels.
TargetTable target_table(const std::vector<const Entry*>& entries);

void to_json(Json& json, const TargetRow& row);
void to_json(Json& json, const TargetTable& table);

}  // namespace cistula::report
