#include "measure.h"

#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "base/timing.h"
#include "scene/description/camera_path.h"

namespace cistula {
namespace {

constexpr int part = 4;  // of a side
constexpr size_t most_measured = 64;

int small_side(int length) {
    return std::max(1, (length + part - 1) / part);
}

/// The tile that holds a place, of so many over a length.
int tile_at(int place, int length, int count) {
    return static_cast<int>(((int64_t{place} + 1) * count - 1) / length);
}

double pixels_of(const PixelRect& rect) {
    return static_cast<double>(rect.width) * rect.height;
}

}  // namespace

FrameSettings small_settings(const FrameSettings& settings) {
    FrameSettings small = settings;
    small.full_width = small_side(settings.full_width);
    small.full_height = small_side(settings.full_height);
    small.crop.x = std::min(settings.crop.x / part, small.full_width - 1);
    small.crop.y = std::min(settings.crop.y / part, small.full_height - 1);
    small.crop.width = std::min(small_side(settings.crop.width), small.full_width - small.crop.x);
    small.crop.height = std::min(small_side(settings.crop.height), small.full_height - small.crop.y);
    small.supersample = 1;
    small.layers = {};
    small.parts = {.losses = false};
    return small;
}

std::vector<double> rays_of_tiles(const Film& small, const FrameSettings& settings, const TileGrid& grid) {
    std::vector<double> rays(static_cast<size_t>(grid.count()));
    const PixelRect &crop = settings.crop, &rect = small.rect;
    size_t pixel = 0;
    for (int y = 0; y < rect.height; ++y) {
        const int row = tile_at(static_cast<int>(int64_t{y} * crop.height / rect.height), crop.height, grid.rows);
        for (int x = 0; x < rect.width; ++x, ++pixel) {
            const int column =
                tile_at(static_cast<int>(int64_t{x} * crop.width / rect.width), crop.width, grid.columns);
            rays[static_cast<size_t>(row * grid.columns + column)] += small.pixels.sight(pixel).rays;
        }
    }
    return rays;
}

MeasuredFrames measure_tiles(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings,
                             const std::vector<int>& frames, const TileGrid& grid, StepProgress& progress) {
    const FrameSettings small = small_settings(settings);
    const std::vector<size_t> indices = frames_to_measure(frames.size(), most_measured);
    progress.begin("measuring", static_cast<double>(indices.size()));
    MeasuredFrames measured{indices, {}};
    double seconds = 0, rays = 0;
    Film film;
    for (const size_t index : indices) {
        const CameraFrame camera = camera_at(scene.camera, frames[index]);
        progress.frame(static_cast<uint64_t>(pixels_of(small.crop)));
        progress.render.pixels_done = 0;
        bool whole = false;
        seconds += seconds_of([&] { whole = renderer.render(camera, small, film, progress.render); });
        if (!whole) throw Error(ErrorKind::interrupted, "interrupted; nothing was written");
        measured.seconds.push_back(rays_of_tiles(film, settings, grid));
        rays += static_cast<double>(film.rays.total());
        progress.advance();
    }
    const double samples = settings.adaptive() ? 1 : static_cast<double>(settings.supersample) * settings.supersample;
    const double scale = pixels_of(settings.crop) / pixels_of(small.crop) * samples * seconds / std::max(rays, 1.0);
    for (std::vector<double>& tiles : measured.seconds)
        for (double& tile : tiles) tile *= scale;
    return measured;
}

}  // namespace cistula
