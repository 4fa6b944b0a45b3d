#include "preview.h"

#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/image/color/color_space.h"
#include "scene/image/picture/picture.h"
#include "scene/image/picture/picture_io.h"

namespace cistula {
namespace {

const std::vector<float>& channel(const LayeredPicture& frame, const char* name, const std::string& path) {
    if (const LayeredPicture::Channel* found = channel_of(frame, name)) return found->values;
    throw Error(ExitCode::usage, fmt::format("--preview {}: the tiles have no channel {}", path, name));
}

}  // namespace

void write_merged_preview(const std::string& path, const LayeredPicture& frame, const PictureView& view) {
    const auto refuse = [&](const char* what) {
        throw Error(ExitCode::usage, fmt::format("--preview {}: {}; render-view shows the merged file", path, what));
    };
    if (frame.attributes.count("cistula:background") != 0) refuse("the tiles' background was left out");
    const auto* id = attribute_of<std::string>(frame, "colorInteropID");
    if (id != nullptr && *id != color_spaces().front().id) refuse("the tiles are of another color space");
    const std::vector<float>&r = channel(frame, "R", path), &g = channel(frame, "G", path),
          &b = channel(frame, "B", path);
    ColorPicture picture{static_cast<uint32_t>(frame.width), static_cast<uint32_t>(frame.height), {}};
    picture.texels.reserve(r.size());
    for (size_t i = 0; i < r.size(); ++i) picture.texels.emplace_back(r[i], g[i], b[i]);
    write_preview(path, viewed(std::move(picture), view, static_cast<uint32_t>(frame.display_height)));
}

}  // namespace cistula
