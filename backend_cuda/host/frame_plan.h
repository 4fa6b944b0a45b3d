// The distribution of a frame to GPUs: in parts, each of several strips of rows per device.
#pragma once

#include <algorithm>
#include <memory>

#include "backend_cuda/host/block_list.h"
#include "backend_cuda/kernels/frame_job.h"
#include "render/frame/frame_hints.h"

namespace cistula {

struct FramePlan {
    CameraFrame camera;
    FrameSettings settings;
    FrameView view;
    std::shared_ptr<const FrameHints> hints;
    BlockPlan blocks;
    Sampling sampling = Sampling::uniform;
    int mask = 0;             // index of effect_masks
    bool fits = true;         // whether the camera's interior list had room
    int first_device = 0;     // of those that share the frame
    int devices = 1;          // strip s of the rectangle belongs to device s % devices of them
    int strips = 0;           // of the whole rectangle
    size_t strip_pixels = 0;  // of whole blocks
    int part_strips = 0;      // of a part, per device
    int parts = 0;

    /// The number of strips of the device that has most.
    int strips_per_device() const { return (strips + devices - 1) / devices; }

    Strips strips_of(int part, int device) const {
        const int own = (strips - device + devices - 1) / devices;
        return {part * part_strips * devices + device, devices, std::clamp(own - part * part_strips, 0, part_strips)};
    }

    uint64_t pixels_of(int part) const {
        const int rows = part_strips * devices * strip_rows;
        const int height = settings.crop.height;
        return uint64_t(std::clamp(height - part * rows, 0, rows)) * uint64_t(settings.crop.width);
    }

    /// Samples of a pixel; an estimate if sampling is adaptive.
    size_t samples() const {
        constexpr size_t adaptive = 16;
        return settings.adaptive() ? adaptive : size_t(settings.supersample) * size_t(settings.supersample);
    }
};

}  // namespace cistula
