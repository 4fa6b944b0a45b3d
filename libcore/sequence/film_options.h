// Options for rendering a film, besides the scene and the settings of its frames.
#pragma once

#include <string>

#include "image/view/picture_view.h"
#include "render/record/film_picture.h"
#include "render/record/split_picture.h"
#include "render/renderer.h"
#include "sequence/backends.h"

namespace cistula {

struct FilmOptions {
    Backend backend = Backend::embree;
    Precision precision = Precision::single_;
    OutputChannels channels;
    Split split = Split::none;  // of the layers
    PictureView view;           // of previews
    std::string stats;          // file for times and counts, as given; empty: none
    bool resume = false;
    bool strict = false;  // values that the file's type does not hold are an error
};

}  // namespace cistula
