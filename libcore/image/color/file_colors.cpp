#include "image/color/file_colors.h"

#include <fmt/format.h>

#include <stdexcept>

#include "base/suggest.h"

namespace cistula {
namespace {

/// Throws what is wrong with a file's colors, and what the user can do.
[[noreturn]] void refuse(const std::string& problem) {
    throw std::runtime_error(
        fmt::format("{}; the key \"colorspace\" of a scene's texture overrides what the file says: it is one of {}",
                    problem, fmt::join(color_encoding_names, ", ")));
}

FileEncoding encoding_of(const ColorEncoding& encoding) {
    return {*find_color_space(encoding.space), encoding.curve};
}

/// The space of a file's chromaticities.
ColorSpace stated_space(const Chromaticities& chromaticities) {
    try {
        return color_space_of(chromaticities);
    } catch (const std::runtime_error& problem) {
        refuse(problem.what());
    }
}

/// The chromaticities, for messages.
std::string shown(const ColorSpace& space) {
    if (!space.id.empty()) return "those of " + std::string(space.id);
    const auto xy = [](const double(&p)[2]) { return fmt::format("({:.5g}, {:.5g})", p[0], p[1]); };
    return fmt::format("red {}, green {}, blue {}, white {}", xy(space.red), xy(space.green), xy(space.blue),
                       xy(space.white));
}

}  // namespace

FileEncoding file_encoding(std::string_view name, const FileColors& colors, bool is_floating) {
    if (!name.empty()) {
        if (const ColorEncoding* told = find_color_encoding(name)) return encoding_of(*told);
        throw std::runtime_error(
            fmt::format("its colorspace {} is not known; {}", quoted(name),
                        suggestion(name, {color_encoding_names.begin(), color_encoding_names.end()}, "values")));
    }
    if (!colors.profile.empty())
        refuse(fmt::format("its color profile {} is none of the encodings known here", quoted(colors.profile)));
    std::string_view id = colors.id == "unknown" ? std::string_view() : colors.id;
    if (colors.is_aces) {
        constexpr std::string_view aces = "lin_ap0_scene";
        if (!id.empty() && id != aces)
            refuse(fmt::format("its colorInteropID is {}, but its acesImageContainerFlag says {}", quoted(id), aces));
        id = aces;
    }
    const ColorEncoding* const stated = find_color_encoding(id);
    if (!id.empty() && !stated) refuse(fmt::format("its colorInteropID {} is not known", quoted(id)));
    if (stated && (!colors.chromaticities || id == "data")) return encoding_of(*stated);
    FileEncoding encoding = encoding_of(*find_color_encoding(is_floating ? "linear" : "srgb"));
    if (!colors.chromaticities) return encoding;
    encoding.space = stated_space(*colors.chromaticities);
    if (!stated) return encoding;
    if (encoding.space.id != stated->space)
        refuse(fmt::format("its {} {}, but its chromaticities are {}",
                           colors.is_aces ? "acesImageContainerFlag says" : "colorInteropID is", id,
                           shown(encoding.space)));
    return encoding_of(*stated);
}

}  // namespace cistula
