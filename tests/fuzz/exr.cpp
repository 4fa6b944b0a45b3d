// OpenEXR files, as they are read for --resume, as textures, and for comparisons.
#include "image/exr/exr.h"
#include "checks.h"
#include "image/exr/exr_file.h"
#include "target.h"

FUZZ_TARGET(exr) {
    using namespace cistula;
    const fuzz::MemoryFile file(data, size);
    try {
        const LayeredPicture picture = read_exr(file.path());
        fuzz::require(picture.width > 0 && picture.height > 0);
        for (const LayeredPicture::Channel& channel : picture.channels)
            fuzz::require(channel.values.size() ==
                          static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
        exr_is_complete(file.path());
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    try {
        const ColorPicture picture = read_exr_texture(file.path());
        fuzz::require(picture.texels.size() == static_cast<size_t>(picture.width) * picture.height);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    try {
        const StoredFile stored = read_stored_exr(file.path());
        fuzz::require(!stored.pictures.empty() && stored.pictures.front().is_whole());
        for (const StoredPicture& picture : stored.pictures)
            for (const StoredChannel& channel : picture.channels)
                std::visit([&](const auto& values) { fuzz::require(values.size() == picture.data.pixels()); },
                           channel.values);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
