// Renders that are stopped from outside, as Ctrl-C does.
#pragma once

#include <chrono>
#include <thread>

#include "render/renderer.h"

namespace cistula::test {

struct Stopped {
    bool whole = false;
    double seconds = 0;  // from the request to stop to the end of the render
};

/// Renders a frame and stops it after `after` seconds.
inline Stopped render_stopped(Renderer& renderer, const CameraFrame& camera, const FrameSettings& settings,
                              double after) {
    using Clock = std::chrono::steady_clock;
    Film film;
    RenderProgress progress;
    Clock::time_point ordered;
    std::thread watcher([&] {
        std::this_thread::sleep_for(std::chrono::duration<double>(after));
        ordered = Clock::now();
        progress.stop = true;
    });
    Stopped result;
    result.whole = renderer.render(camera, settings, film, progress);
    const auto end = Clock::now();
    watcher.join();
    result.seconds = std::chrono::duration<double>(end - ordered).count();
    return result;
}

}  // namespace cistula::test
