// The interface that backends offer to programs.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/description/camera_path.h"
#include "scene/film/film.h"

namespace cistula {

enum class Precision { single_, double_ };

/// exact: the one hit rule, the same bits everywhere. native: Embree's own triangles, approximate at edges.
enum class Intersection { exact, native };

struct FrameSettings {
    int full_width = 640, full_height = 480;
    PixelRect crop;           // the pixels to render; all: {0, 0, full_width, full_height}
    int supersample = 1;      // k: a k x k grid per pixel
    int depth = 4;            // 1 to 1,024
    double cutoff = 0;        // error budget per pixel in the scene's radiance units
    double target_error = 0;  // above 0: samples of the 16 x 16 lattice as needed, and a quarter of it for the cutoff
    int max_samples = 256;    // of a pixel, where there is a target: 5 to 256
    uint32_t effects = 0;     // mask to run; 0: the least that contains what the scene requires
    bool unshadowed = false;  // for measuring what shadows cost: the image is wrong; not with a target error
    int tile = 16;            // pixels along a tile's side; never changes the image

    bool operator==(const FrameSettings&) const = default;

    /// A frame of this size, all of it.
    void set_size(int width, int height) {
        full_width = width;
        full_height = height;
        crop = {0, 0, width, height};
    }

    bool adaptive() const { return target_error > 0; }
    /// Along a pixel's side, of the lattice too.
    int grid() const { return adaptive() ? 16 : supersample; }
    double truncation() const { return adaptive() ? target_error / 4 : cutoff; }
};

/// Shared between the rendering threads and whoever watches; all members may be read at any time.
struct RenderProgress {
    std::atomic<uint64_t> pixels_done{0};
    std::atomic<uint64_t> rays{0};
    alignas(64) std::atomic<bool> stop{false};  // set it: the render returns soon. Apart, as every ray's tree reads it
};

/// Where the time of the last frame went, in seconds; of the devices that had part in it the slowest.
struct RenderTimes {
    double kernel = 0;    // devices at work on pixels
    double transfer = 0;  // from their being done to the film's being whole
};

/// Renders frames of one scene in one precision. Not thread-safe: one render at a time.
class Renderer {
  public:
    virtual ~Renderer() = default;

    /// Fills `film`. Returns false if it was stopped (the film is then incomplete). Throws Error.
    virtual bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                        RenderProgress& progress) = 0;

    /// Announces the frame that render() will be asked for after the next one, so that a device can begin it early.
    /// Asking for another one then costs time, nothing else.
    virtual void expect(const CameraFrame&, const FrameSettings&) {}

    /// The mask of effects that the last render ran.
    virtual uint32_t effects() const = 0;

    /// "embree", "native", "bvh", "brute", "cuda".
    virtual std::string intersector() const = 0;

    /// Times of the last frame, from backends with devices of their own; else zeros.
    virtual RenderTimes times() const { return {}; }

    /// What the user should know of the last frame, one line each: that it went by parts for want of memory, ...
    virtual std::vector<std::string> notes() const { return {}; }

    /// Bytes of geometry, trees and shading data.
    virtual size_t memory() const = 0;
};

}  // namespace cistula
