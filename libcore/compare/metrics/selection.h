// What of two files is compared: layers, a rectangle, pixels of a mask.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/picture/stored_picture.h"

namespace cistula {

/// Pixels that count, in a window.
struct Mask {
    PixelRect window;
    std::vector<uint8_t> counts;  // row-major; 1: it counts
};

/// What is compared; by default everything.
struct Selection {
    std::vector<std::string> layers;  // patterns of channels' and layers' names; empty: all
    bool intersection = false;        // only pixels that both data windows have
    std::optional<PixelRect> crop;    // only those of a rectangle in pixel space
    std::optional<Mask> mask;         // only those that count there
    bool common_channels = false;     // channels and parts that only one file has are no difference
    // metrics that take long
    bool ssim = false;
    bool flip = false;

    /// Whether windows may differ, since pixels outside are left out.
    bool excuses_windows() const { return intersection || crop; }
    bool has_region() const { return excuses_windows() || mask; }
};

/// Pixels that are compared.
struct Region {
    PixelRect window;
    std::vector<uint8_t> counts;  // row-major; 1: it is compared; empty: all are

    bool counts_at(size_t pixel) const { return counts.empty() || counts[pixel] != 0; }
    size_t pixels() const;
};

/// Whether a channel is one that patterns with * and ? name: by its own name or its layer's, which is what comes before
/// the last dot. `shown` is the channel's name with its part's.
bool is_selected(const std::vector<std::string>& patterns, const std::string& name, const std::string& shown);

/// The mask that a picture is: a pixel counts where a channel other than A is above 0, or A where it is the only one.
Mask mask_of(const StoredPicture& picture);

/// The pixels of two pictures that are compared; none where the data windows are to be the same and are not, or do not
/// overlap. `subject`: "" or "part depth: ", for messages. Throws Error (usage) where the crop leaves a data window,
/// and the mask does not have all pixels or counts none.
Region region_of(const StoredPicture& a, const StoredPicture& b, const Selection& selection,
                 const std::string& subject);

}  // namespace cistula
