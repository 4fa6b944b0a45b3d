// What differs in two headers.
#pragma once

#include <string>
#include <vector>

#include "compare/metrics/picture_pairs.h"
#include "compare/metrics/selection.h"

namespace cistula {

/// Lines on data and display windows: "data window: 4x2+5+7 / 4x2+6+7".
std::vector<std::string> differing_windows(const PicturePair& pair);

/// Lines on names of parts and attributes: "owner: me / (none)".
std::vector<std::string> differing_attributes(const PicturePair& pair);

/// Lines on how the files are packed: "compression: zip / piz".
std::vector<std::string> differing_packing(const PicturePair& pair);

/// A line on types and sampling of a channel; empty where these are the same: "channel R: float / half".
std::string differing_type(const PicturePair& pair, const StoredChannel& a, const StoredChannel& b);

}  // namespace cistula
