#include "render/finished_tiles.h"

#include <algorithm>

namespace cistula {

void FinishedTiles::begin(const Film& film, int side) {
    const std::lock_guard lock(mutex_);
    film_ = &film;
    tiles_.clear();
    const auto count = [side](int length) { return static_cast<size_t>((length + side - 1) / side); };
    tiles_.reserve(count(film.rect.width) * count(film.rect.height));
}

void FinishedTiles::finish(const PixelRect& tile) {
    const std::lock_guard lock(mutex_);
    tiles_.push_back(tile);
}

void FinishedTiles::end() {
    const std::lock_guard lock(mutex_);
    film_ = nullptr;
}

std::optional<PartialFilm> FinishedTiles::copy() const {
    const std::lock_guard lock(mutex_);
    if (film_ == nullptr) return std::nullopt;
    PartialFilm part;
    Film& film = part.film;
    film.full_width = film_->full_width;
    film.full_height = film_->full_height;
    film.rect = film_->rect;
    film.radiance_exponent = film_->radiance_exponent;
    film.samples = film_->samples;
    film.fixed_shift = film_->fixed_shift;
    std::copy_n(film_->background, 3, film.background);
    film.rounding = film_->rounding;
    film.pixels.assign(film_->pixels.size(), PixelRecord(), film_->pixels.parts());
    film.layers.plan = film_->layers.plan;
    film.layers.words.assign(film_->layers.words.size(), 0);
    std::copy_n(film_->layers.center, 3, film.layers.center);
    film.layers.unit_length = film_->layers.unit_length;
    film.layers.names = film_->layers.names;
    part.done.assign(film.pixels.size(), false);
    const auto words = static_cast<size_t>(film.layers.plan.words);
    size_t done = 0;
    for (const PixelRect& tile : tiles_)
        for (int y = tile.y; y < tile.y + tile.height; ++y) {
            const auto width = static_cast<size_t>(tile.width);
            const size_t first =
                static_cast<size_t>(y) * static_cast<size_t>(film.rect.width) + static_cast<size_t>(tile.x);
            for (size_t i = first; i < first + width; ++i) film.pixels.set(i, film_->pixels[i]);
            if (words != 0) std::copy_n(film_->layers.of(first), width * words, film.layers.of(first));
            std::fill_n(part.done.begin() + static_cast<ptrdiff_t>(first), width, true);
            done += width;
        }
    part.fraction = static_cast<double>(done) / static_cast<double>(film.pixels.size());
    return part;
}

}  // namespace cistula
