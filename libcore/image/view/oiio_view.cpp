#include "image/reader/oiio_module.h"

#include <OpenImageIO/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "image/color/color_space.h"

namespace cistula {

struct OiioView {
    OIIO::ColorProcessorHandle processor;
    bool from_aces = false;  // the processor takes ACES2065-1, not linear Rec. 709
    std::string assumed;     // assumed_space; empty: none
};

namespace {

constexpr int first_with_config = 0x02020000;  // of OpenColorIO: the first version that has a config built in

/// The reason of the last failure, which the library forgets.
std::string reason_of(OIIO::ColorConfig& config, const char* otherwise) {
    const std::string reason = config.geterror();
    return reason.empty() ? otherwise : reason;
}

/// A view, and its display.
struct NamedView {
    std::string name, display, view;
};

/// Those of the default display come first.
std::vector<NamedView> views_of(const OIIO::ColorConfig& config) {
    std::vector<NamedView> views;
    const char* const first = config.getDefaultDisplayName();
    if (!first) return views;
    std::vector<std::string> displays = config.getDisplayNames();
    std::stable_partition(displays.begin(), displays.end(), [&](const std::string& name) { return name == first; });
    for (const std::string& display : displays)
        for (const std::string& view : config.getViewNames(display))
            views.push_back({display == first ? view : fmt::format("{} ({})", view, display), display, view});
    return views;
}

/// From linear Rec. 709: by its space in the config, under one of the names in use; by way of ACES2065-1, which the
/// role aces_interchange is defined to be; or, as a guess, from the role scene_linear.
bool connect(OiioView& opened, OIIO::ColorConfig& config, const NamedView& view) {
    const auto from = [&](const char* space) {
        opened.processor = config.createDisplayTransform(view.display, view.view, space);
        return opened.processor != nullptr;
    };
    for (const char* name : {"lin_rec709_scene", "lin_rec709", "Linear Rec.709 (sRGB)", "Linear Rec.709"})
        if (from(name)) return true;
    if (config.getColorSpaceNameByRole("aces_interchange") && from("aces_interchange")) return opened.from_aces = true;
    const char* const linear = config.getColorSpaceNameByRole("scene_linear");
    if (!linear || !from("scene_linear")) return false;
    opened.assumed = linear;
    return true;
}

OiioView* opened_view(const std::string& file, const std::string& name, const OiioViewHost& host) {
    const auto fail = [&](const std::string& reason) {
        host.failed(host.self, reason.c_str());
        return nullptr;
    };
    if (!OIIO::ColorConfig::supportsOpenColorIO()) return fail("this OpenImageIO was built without OpenColorIO");
    const int version = OIIO::ColorConfig::OpenColorIO_version_hex();
    if (file.empty() && version < first_with_config)
        return fail("OpenColorIO " + std::to_string(version >> 24) + '.' + std::to_string(version >> 16 & 0xff) +
                    " has no config of its own, as 2.2 and later have, and $OCIO names none");
    OIIO::ColorConfig config(file.empty() ? "ocio://default" : file);
    const std::vector<NamedView> views = views_of(config);
    if (views.empty()) return fail(reason_of(config, "the config has no views"));
    for (const NamedView& view : views) host.view(host.self, view.name.c_str());
    const auto found =
        std::find_if(views.begin(), views.end(), [&](const NamedView& view) { return view.name == name; });
    if (found == views.end()) return nullptr;
    auto opened = std::make_unique<OiioView>();
    if (connect(*opened, config, *found)) return opened.release();
    return fail(reason_of(config,
                          "the view cannot be made from any of the spaces lin_rec709_scene, lin_rec709, Linear "
                          "Rec.709 (sRGB) and Linear Rec.709, nor from the roles aces_interchange and "
                          "scene_linear"));
}

}  // namespace

OiioView* open_view(const char* config, const char* name, const OiioViewHost* host) noexcept {
    try {
        return opened_view(config, name, *host);
    } catch (const std::bad_alloc&) {
        host->failed(host->self, "Cannot allocate memory");  // as failure_of() takes it
    } catch (const std::exception& error) {
        host->failed(host->self, error.what());
    } catch (...) {
        host->failed(host->self, "OpenColorIO threw an exception of an unknown kind");
    }
    return nullptr;
}

const char* assumed_space(const OiioView* view) noexcept {
    return view->assumed.empty() ? nullptr : view->assumed.c_str();
}

bool apply_view(const OiioView* view, float* rgb, size_t count) noexcept {
    try {
        if (view->from_aces) {
            static const glm::dmat3 matrix =
                color_matrix(*find_color_space("lin_rec709_scene"), *find_color_space("lin_ap0_scene"));
            for (size_t i = 0; i < 3 * count; i += 3) {
                const glm::dvec3 color = matrix * glm::dvec3(rgb[i], rgb[i + 1], rgb[i + 2]);
                for (int c = 0; c < 3; ++c) rgb[i + static_cast<size_t>(c)] = static_cast<float>(color[c]);
            }
        }
        constexpr size_t piece = 1 << 16;  // texels at a time: the library counts in int
        constexpr OIIO::stride_t sample = sizeof(float);
        for (size_t done = 0; done < count; done += piece)
            view->processor->apply(rgb + 3 * done, static_cast<int>(std::min(piece, count - done)), 1, 3, sample,
                                   3 * sample, OIIO::AutoStride);
        return true;
    } catch (...) {
        return false;
    }
}

void close_view(OiioView* view) noexcept {
    delete view;
}

}  // namespace cistula
