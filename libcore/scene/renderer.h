// The interface that backends offer to programs.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "scene/camera_path.h"
#include "scene/film.h"

namespace cistula {

enum class Precision { single_, double_ };

struct FrameSettings {
    int full_width = 640, full_height = 480;
    PixelRect crop;            // the pixels to render; all: {0, 0, full_width, full_height}
    int supersample = 1;       // k: a k x k grid per pixel
    int depth = 4;             // 1 to 1,024
    double cutoff = 0;         // error budget per pixel in the scene's radiance units
    uint32_t effects = 0;      // mask to run; 0: the least that contains what the scene requires
    int tile = 16;             // pixels along a tile's side; never changes the image
};

/// Shared between the rendering threads and whoever watches; all members may be read at any time.
struct RenderProgress {
    std::atomic<uint64_t> pixels_done{0};
    std::atomic<uint64_t> rays{0};
    std::atomic<bool> stop{false};  // set it: the render returns at the next tile
};

/// Renders frames of one scene in one precision. Not thread-safe: one render at a time.
class Renderer {
  public:
    virtual ~Renderer() = default;

    /// Fills `film`. Returns false if it was stopped (the film is then incomplete). Throws Error.
    virtual bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                        RenderProgress& progress) = 0;

    /// The mask of effects that the last render ran.
    virtual uint32_t effects() const = 0;

    /// "embree", "bvh", "brute", "cuda".
    virtual std::string intersector() const = 0;

    /// Bytes of geometry, trees and shading data.
    virtual size_t memory() const = 0;
};

}  // namespace cistula
