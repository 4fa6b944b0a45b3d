#include "apps/common/frame_files.h"

#include <iterator>

#include "scene/film/film_picture.h"

namespace cistula {

std::vector<FrameFile> frame_files(LayeredPicture picture, Split split, const OutputName& name, int frame) {
    FrameFile main{name.for_frame(frame), {}};
    std::vector<FrameFile> files;
    if (split == Split::none) {
        main.parts.push_back({"", std::move(picture)});
    } else {
        main.parts = split_by_layer(std::move(picture), split);
        if (split == Split::parts)
            for (PicturePart& part : main.parts) part.picture.attributes.erase("acesImageContainerFlag");
        if (split == Split::files) {
            for (auto part = std::next(main.parts.begin()); part != main.parts.end(); ++part) {
                FrameFile& own = files.emplace_back(FrameFile{name.for_layer(frame, part->name), {}});
                own.parts.push_back(std::move(*part));
                name_colors_plainly(own.parts.front());
                set_container_flag(own.parts.front().picture);
            }
            main.parts.resize(1);
            set_container_flag(main.parts.front().picture);
        }
    }
    files.push_back(std::move(main));
    return files;
}

}  // namespace cistula
