// From the integer sums of a film to the channels of a file.
#pragma once

#include <string>

#include "scene/film/film.h"
#include "scene/image/picture.h"

namespace cistula {

/// Which channels a file has beside R, G, B and A.
struct OutputChannels {
    bool half = false;  // R G B A, error.* and N.* as half; id, samples, cost and Z are always float
    bool error = false, id = false, samples = false, cost = false, z = false, normal = false;
};

/// R G B: the mean radiance. A: the share of samples that hit anything. error.R error.G error.B: the ledger of pruned
/// and cut branches, rounded up, so that it stays a bound in the file's precision (infinity past the largest half).
/// id: 1 + solid, 0 for none. samples: per pixel. cost: rays. Z: distance along the view axis, infinity for none.
/// N.X N.Y N.Z: unit normal in world axes, 0 for none. The data window is the film's rectangle.
LayeredPicture to_layers(const Film& film, const OutputChannels& channels);

/// The mean radiance alone, of the film's rectangle.
ColorPicture to_color(const Film& film);

/// 32 hexadecimal digits: FNV-1a of 128 bits over every pixel's sums, hits, rays, id and the bits of z and normal,
/// least byte first, in the order of the pixels. Nothing else enters: two films with one hash hold the same image.
std::string film_hash(const Film& film);

}  // namespace cistula
