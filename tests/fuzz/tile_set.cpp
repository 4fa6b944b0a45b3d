// Tiles as render-merge takes them: EXR files one after the other.
#include <deque>

#include "checks.h"
#include "sequence/merge.h"
#include "target.h"

FUZZ_TARGET(tile_set) {
    using namespace cistula;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    std::deque<fuzz::MemoryFile> files;
    for (size_t begin = 0; begin < size;) {
        const size_t end = std::min(bytes.find("v/1\x01", begin + 1), size);  // as every EXR begins
        files.emplace_back(data + begin, end - begin);
        begin = end;
    }
    try {
        Merge merge(std::nullopt);
        for (const fuzz::MemoryFile& file : files) {
            is_layer_file(file.path(), "diffuse");
            merge.add(file.path());
        }
        if (files.empty()) return 0;
        merge.check_whole();
        merge.check_beside(merge);
        const std::vector<PicturePart> whole = std::move(merge).whole();
        fuzz::require(!whole.empty());
        for (const PicturePart& part : whole) {
            const LayeredPicture& picture = part.picture;
            fuzz::require(picture.width == picture.display_width && picture.height == picture.display_height);
            for (const LayeredPicture::Channel& channel : picture.channels)
                fuzz::require(channel.values.size() ==
                              static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
        }
    } catch (const Error& error) {
        fuzz::require(error.kind() == ErrorKind::failed || error.kind() == ErrorKind::file);
        fuzz::check_line(error.what());
    }
    return 0;
}
