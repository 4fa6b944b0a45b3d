// A finished frame.
#pragma once

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "image/picture/picture.h"
#include "module.h"
#include "render/record/film.h"
#include "render/renderer.h"
#include "scene.h"
#include "scene/description/camera_path.h"

namespace cistula::python {

/// A film with what its files say. Arrays look into it.
struct Image {
    std::shared_ptr<SceneHandle> scene;
    Film film;
    FrameSettings settings;
    int frame = 0;
    double seconds = 0;
    RenderTimes times;                                 // 0 where the backend has no device of its own
    LayeredPicture picture;                            // of values made as they are asked for
    std::map<std::string, std::vector<float>> values;  // that were
    std::atomic<uint64_t> clamped{0};
    std::string hash;

    size_t height() const { return static_cast<size_t>(film.rect.height); }
    size_t width() const { return static_cast<size_t>(film.rect.width); }
    const std::vector<float>& channel(const std::string& name);
};

}  // namespace cistula::python
