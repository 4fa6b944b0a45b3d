// Which picture of one file is compared with which of the other, and what differs in their headers.
#pragma once

#include <string>
#include <vector>

#include "compare/metrics/selection.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// A part at one of its levels, in both files.
struct PicturePair {
    const StoredPicture* a = nullptr;
    const StoredPicture* b = nullptr;
    std::string part;  // its name, or its number in a file of several parts without names; "": the only part

    /// "", "part depth: " or "part depth, level 1,1: ", for lines of a report.
    std::string subject() const;

    /// A channel's name among those of all parts and levels: "Z", "depth.Z", "depth.Z (level 1,1)".
    std::string shown(const std::string& channel) const;
};

/// A picture that only one file has.
struct LonePicture {
    PicturePair picture;  // as both
    std::string line;     // "part depth: only in the first"
};

struct PicturePairs {
    std::vector<PicturePair> pairs;  // in the order of the first file
    std::vector<LonePicture> unpaired;
    bool is_other_order = false;  // of parts that have partners
};

/// Parts are matched by their names where all parts of both files have one, else by their order, as the only parts of
/// two files are.
PicturePairs pair_pictures(const StoredFile& a, const StoredFile& b);

/// Lines on data and display windows: "data window: 4x2+5+7 / 4x2+6+7".
std::vector<std::string> differing_windows(const PicturePair& pair);

/// Lines on names of parts and attributes: "owner: me / (none)".
std::vector<std::string> differing_attributes(const PicturePair& pair);

/// Lines on how the files are packed: "compression: zip / piz".
std::vector<std::string> differing_packing(const PicturePair& pair);

/// A line on types and sampling of a channel; empty where these are the same: "channel R: float / half".
std::string differing_type(const PicturePair& pair, const StoredChannel& a, const StoredChannel& b);

}  // namespace cistula
