// Tiles of a frame put together to the file of the whole frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/pixel_rect.h"
#include "image/picture/picture.h"
#include "render/record/film.h"

namespace cistula {

/// Rectangles apart from each other that hold what of the window no rectangle covers.
std::vector<PixelRect> uncovered(const PixelRect& window, const std::vector<PixelRect>& rects);

/// Whether a file is an image of a layer that has a file of its own (split_picture.h): its channels are the layer's.
bool is_layer_file(const std::string& path, const std::string& layer);

/// Puts the parts of files together. All must be of one render: their headers equal but for the data window and what a
/// target error measured, their windows apart. Headers decide that; no pixel is read and no memory taken for any before
/// all is known to make a whole.
class Merge {
  public:
    /// The pixels to be covered; nothing: the full frame.
    explicit Merge(std::optional<PixelRect> window) : window_(window) {}

    /// Adds a tile. Throws Error: `failed` if it is none of these tiles or overlaps one, `file` if it cannot be read.
    void add(const std::string& path);

    /// Throws Error (failed) for pixels that no tile covers.
    void check_whole() const;

    /// Throws Error (failed) unless the tiles are those of a layer's own files beside these main ones.
    void check_beside(const Merge& main) const;

    /// The whole frame's parts, once checked. Throws Error: `file` for a tile that cannot be read.
    std::vector<PicturePart> whole() &&;

  private:
    void begin(const std::string& path, const std::vector<PicturePart>& tile);
    void check(const std::string& path, const std::vector<PicturePart>& tile) const;
    void check_window(const std::string& path, const PixelRect& rect) const;

    struct Placed {
        std::string path;
        PixelRect rect;
    };

    std::optional<PixelRect> window_;
    std::vector<PicturePart> parts_;
    std::vector<Placed> placed_;
};

}  // namespace cistula
