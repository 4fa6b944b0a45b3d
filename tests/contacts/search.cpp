// Generated scenes of bodies that touch: one picture on all of the host's intersectors, and in float that of double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/record/film_picture.h"
#include "testing/support/contacts/contact_search.h"
#include "testing/support/pictures/film_of_all.h"

namespace cistula {
namespace {

using test::ContactSearch;
using test::film_of_all;

struct Neighborhood {
    glm::vec3 low{INFINITY}, high{-INFINITY};
    bool one_id = true;
};

/// The range of colors, and whether there is one id, of a pixel and those around it.
Neighborhood around(const Film& film, const ColorPicture& picture, int x, int y) {
    const int width = film.rect.width, height = film.rect.height;
    Neighborhood found;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
            const size_t i = size_t(v * width + u);
            found.one_id &= film.pixels[i].id == film.pixels[size_t(y * width + x)].id;
            for (int c = 0; c < 3; ++c) {
                found.low[c] = std::min(found.low[c], picture.texels[i][c]);
                found.high[c] = std::max(found.high[c], picture.texels[i][c]);
            }
        }
    return found;
}

struct SearchCounts {
    size_t scenes = 0, pixels = 0, at_edges = 0, differing_at_edges = 0, differing = 0;
    double worst = 0;
};

/// A pixel is at an edge if another id is beside it or if colors there, seen through glass, range over 1/16 or more.
void compare(uint64_t seed, const Film& found_film, const Film& film, SearchCounts& counts) {
    const ColorPicture found = to_color(found_film), expected = to_color(film);
    ++counts.scenes;
    for (int y = 0; y < film.rect.height; ++y)
        for (int x = 0; x < film.rect.width; ++x) {
            const size_t i = size_t(y * film.rect.width + x);
            const Neighborhood near = around(film, expected, x, y);
            bool at_edge = !near.one_id;
            double off = 0;
            for (int c = 0; c < 3; ++c) {
                at_edge |= near.high[c] - near.low[c] > 1.0f / 16;
                off = std::max(off, std::abs(double(found.texels[i][c]) - double(expected.texels[i][c])));
            }
            ++counts.pixels;
            counts.at_edges += at_edge;
            if (off <= 1e-3) continue;
            counts.differing_at_edges += at_edge;
            counts.differing += !at_edge;
            if (!at_edge) {
                counts.worst = std::max(counts.worst, off);
                std::printf("seed %d pixel (%d, %d): %.4f off\n", int(seed), x, y, off);
            }
        }
}

TEST(ContactSearch, IntersectorsAgreeAndFloatIsLikeDouble) {
    SearchCounts of_planes, of_meshes;
    size_t touching = 0;
    for (uint64_t seed = 0; seed < test::contact_scene_count; ++seed) {
        SCOPED_TRACE(seed);
        const ContactSearch search(seed);
        const Film in_float = film_of_all<float>(search.scene()), in_double = film_of_all<double>(search.scene());
        compare(seed, in_float, in_double, search.has_meshes() ? of_meshes : of_planes);
        touching += (test::compile<float>(search.scene())->effects & effect_contacts) != 0;
    }
    for (const auto& [name, counts] : {std::pair("planes", of_planes), std::pair("with meshes", of_meshes)})
        std::printf("%s: %zu scenes, %zu pixels, %zu at edges, of which %zu differ; %zu others differ, by up to %.4f\n",
                    name, counts.scenes, counts.pixels, counts.at_edges, counts.differing_at_edges, counts.differing,
                    counts.worst);
    EXPECT_EQ(touching, test::contact_scene_count);
    EXPECT_EQ(of_planes.differing, 0u);
    EXPECT_EQ(of_meshes.differing, 0u);
}

}  // namespace
}  // namespace cistula
