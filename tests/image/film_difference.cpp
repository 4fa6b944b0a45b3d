// Two films compared integer by integer: every field of a pixel and of a frame counts.
#include "scene/film/film_difference.h"

#include <gtest/gtest.h>

namespace cistula {
namespace {

Film two_pixels() {
    Film film;
    film.full_width = film.rect.width = 2;
    film.full_height = film.rect.height = 1;
    film.pixels.push_back({{1, 2, 3}});
    film.pixels.push_back({{4, 5, 6}});
    return film;
}

TEST(FilmDifference, CountsEveryIntegerOfAPixel) {
    const Film a = two_pixels();
    Film b = a;
    EXPECT_EQ(film_difference(a, b).compared, 2 * 20 + 5u);
    EXPECT_EQ(film_difference(a, b).differing, 0u);
    b.pixels[0].radiance[2] += 1;
    b.pixels[1].rays += 1;
    b.pixels[0].samples += 1;
    b.pixels[0].unmet = 1;
    b.pixels[0].checked = 1;
    b.pixels[1].off = 1;
    b.pixels[1].normal[0] = -0.0f;  // another bit
    b.rays.shadow = 7;
    EXPECT_EQ(film_difference(a, b).differing, 8u);
    b.pixels.pop_back();
    EXPECT_EQ(film_difference(a, b).differing, film_difference(a, b).compared);
}

}  // namespace
}  // namespace cistula
