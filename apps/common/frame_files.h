// The image files of a frame.
#pragma once

#include <string>
#include <vector>

#include "apps/common/output_name.h"
#include "scene/film/split_picture.h"

namespace cistula {

struct FrameFile {
    std::string path;
    std::vector<PicturePart> parts;
};

/// The files that a frame's channels go to, the main one last: when it is complete, so are the others.
std::vector<FrameFile> frame_files(LayeredPicture picture, Split split, const OutputName& name, int frame);

}  // namespace cistula
