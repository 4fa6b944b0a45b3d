#include "scene/image/stored_exr.h"

#include <numeric>
#include <utility>

#include "scene/image/exr_file.h"

namespace cistula {
namespace {

StoredChannel stored(ExrChannel&& channel) {
    StoredChannel result;
    result.name = std::move(channel.name);
    result.x_sampling = channel.x_sampling;
    result.y_sampling = channel.y_sampling;
    switch (channel.type) {
        case ExrChannel::Type::half:
            result.type = StoredType::half;
            break;
        case ExrChannel::Type::float_:
            result.type = StoredType::float_;
            break;
        case ExrChannel::Type::uint:
            result.type = StoredType::uint;
            result.values = std::move(channel.numbers);
            return result;
    }
    result.values = std::move(channel.values);
    return result;
}

StoredPicture read_level(const ExrFile& file, size_t number, ExrLevel level) {
    const ExrPart& part = file.parts()[number];
    StoredPicture picture;
    picture.name = part.name;
    picture.x_level = level.x;
    picture.y_level = level.y;
    picture.display = part.display;
    if (picture.is_whole()) {  // those of the part, once
        picture.attributes = part.header;
        picture.packing = part.packing;
    }
    std::vector<size_t> channels(part.channels.size());
    std::iota(channels.begin(), channels.end(), size_t{0});
    for (ExrChannel& channel : file.read(number, channels, level, picture.data))
        picture.channels.push_back(stored(std::move(channel)));
    return picture;
}

}  // namespace

StoredFile read_stored_exr(const std::string& path) {
    const ExrFile file(path);
    StoredFile result;
    result.format = "openexr";
    for (size_t part = 0; part < file.parts().size(); ++part)
        for (const ExrLevel level : file.parts()[part].levels) result.pictures.push_back(read_level(file, part, level));
    return result;
}

}  // namespace cistula
