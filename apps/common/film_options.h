// Options for rendering a film, besides the scene and the settings of its frames.
#pragma once

#include <string>

#include "apps/common/backends.h"
#include "apps/common/status_line.h"
#include "scene/film/film_picture.h"
#include "scene/film/renderer.h"
#include "scene/film/split_picture.h"
#include "scene/image/view/picture_view.h"

namespace cistula {

struct FilmOptions {
    Backend backend = Backend::embree;
    Precision precision = Precision::single_;
    OutputChannels channels;
    Split split = Split::none;  // of the layers
    PictureView view;           // of previews
    std::string stats;          // file for times and counts, as given; empty: none
    bool resume = false, quiet = false, verbose = false;
    bool strict = false;  // values that the file's type does not hold are an error
    ProgressStyle progress = ProgressStyle::automatic;
};

}  // namespace cistula
