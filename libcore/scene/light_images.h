// Where in a picture lines from the camera may come upon seen lights: straight on, or where the first mirror that they
// meet sends them. What a plane mirror shows is what a camera beyond it would see.
#pragma once

#include <vector>

#include "cistula/shown_lights.h"
#include "scene/compiled_scene.h"
#include "scene/film.h"
#include "scene/renderer.h"

namespace cistula {

class FrameCover;
struct FrameView;

/// Pixels of a frame's rectangle around the image of a light, or of all that its mirror may show.
struct LightImage {
    static constexpr uint32_t any = 0xffffffffu;

    PixelRect rect;
    uint32_t mirror = MirrorNumbers::straight;
    uint32_t light = any;

    bool operator==(const LightImage&) const = default;
};

/// Conservative: lights are grown by far more than rounding moves a ray or a face.
class LightImages {
  public:
    /// Without lights.
    explicit LightImages(const PixelRect& rect) : rect_(rect) {}

    const std::vector<LightImage>& images() const { return images_; }
    /// False: only straight lines are told about.
    bool knows_mirrors() const { return knows_mirrors_; }

    const PixelRect& rect() const { return rect_; }

    void add(const LightImage& image) { images_.push_back(image); }
    /// Of any light, the rectangle itself.
    void add_everywhere(uint32_t mirror) { add({{0, 0, rect_.width, rect_.height}, mirror}); }
    /// From now on mirrors without images are known to show no light.
    void know_mirrors() { knows_mirrors_ = true; }

  private:
    PixelRect rect_;
    std::vector<LightImage> images_;
    bool knows_mirrors_ = false;
};

/// What the images meet, by cells of so many pixels from the rectangle's top left corner.
class LitCells {
  public:
    LitCells(const LightImages& images, int width, int height);

    /// False: all are the first.
    bool varies() const { return !indices_.empty(); }
    /// Those that differ, and their lists; the first is of all that no image meets.
    const std::vector<LitCell>& cells() const { return cells_; }
    const std::vector<ShownLight>& lights() const { return lights_; }

    /// In cells().
    uint32_t index_at(int column, int row) const {
        return indices_.empty() ? 0 : indices_[size_t(row) * size_t(columns_) + size_t(column)];
    }
    ShownLights at(int column, int row) const { return {&cells_[index_at(column, row)], lights_.data()}; }

  private:
    int columns_;
    std::vector<uint32_t> indices_;  // empty: all are 0
    std::vector<LitCell> cells_;
    std::vector<ShownLight> lights_;
};

/// A camera, or its image behind a mirror, that looks through a window of the picture: pixels from the top left corner
/// of a frame's rectangle.
class LightView {
  public:
    LightView(const FrameView& frame, const Camera& camera, const PixelRect& rect, const PixelRect& window);

    /// The pixels of the window around a ball; none if it is not seen there.
    PixelRect image_of(const Vec3<double>& center, double radius) const;

  private:
    Camera camera_;
    PixelRect window_;
    double middle_x_, middle_y_, pixels_;             // where forward meets the picture; pixels to tangent 1
    double left_, right_, bottom_, top_;              // tangents
    double at_left_, at_right_, at_bottom_, at_top_;  // lengths of the directions with these
};

/// Of a frame whose cover is known. Mirrors are told about where the mask that runs has use for it.
template <class Real>
LightImages light_images(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings,
                         const FrameCover& cover);

}  // namespace cistula
