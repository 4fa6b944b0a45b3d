// Two films compared integer by integer: every field of a pixel and of a frame counts.
#include "render/record/film_difference.h"

#include <gtest/gtest.h>

namespace cistula {
namespace {

Film two_pixels() {
    Film film;
    film.full_width = film.rect.width = 2;
    film.full_height = film.rect.height = 1;
    film.pixels.begin(2);
    film.pixels.set(0, {{{1, 2, 3}}});
    film.pixels.set(1, {{{4, 5, 6}}});
    return film;
}

TEST(FilmDifference, CountsEveryIntegerOfAPixel) {
    const Film a = two_pixels();
    Film b = a;
    EXPECT_EQ(film_difference(a, b).compared, 2 * 20 + 35u);
    EXPECT_EQ(film_difference(a, b).differing, 0u);
    b.pixels.change(0, [](PixelRecord& pixel) {
        pixel.radiance[2] += 1;
        pixel.samples += 1;
        pixel.unmet = 1;
        pixel.checked = 1;
    });
    b.pixels.change(1, [](PixelRecord& pixel) {
        pixel.rays += 1;
        pixel.off = 1;
        pixel.normal[0] = -0.0f;  // another bit
    });
    b.rays.shadow = 7;
    b.totals.cut[2].most = 1;
    EXPECT_EQ(film_difference(a, b).differing, 9u);
    for (const KeptParts& parts : {KeptParts{true, false}, KeptParts{false, true}}) {
        b.pixels.assign(2, {}, parts);
        EXPECT_EQ(film_difference(a, b).differing, film_difference(a, b).compared);
    }
    b.pixels.assign(1);
    EXPECT_EQ(film_difference(a, b).differing, film_difference(a, b).compared);
}

}  // namespace
}  // namespace cistula
