// How linear colors become a picture to look at: exposure, bloom, and a curve that keeps them within 0 and 1.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "image/picture/picture.h"
#include "image/view/config_view.h"

namespace cistula {

/// What becomes of colors above 1.
enum class ViewCurve {
    srgb,    // cut off at 1
    filmic,  // filmic_color
};

/// What a PNG shows of linear colors; by default the colors as they are.
struct PictureView {
    double exposure = 0;  // stops: colors are multiplied by 2^exposure
    ViewCurve curve = ViewCurve::srgb;
    double bloom = 0;                            // how often the light above white is added to what is around it
    std::string name{};                          // that of a view of an OpenColorIO config, in place of the curve
    std::shared_ptr<const ConfigView> config{};  // the view of a config, once it is open
};

/// A color in [0, 1] that tells bright colors apart. With m, the largest of r, g and b (below 0 they count as 0):
/// t = m^1.2 / (m^1.2 + k), where k = 0.18^1.2 * 0.82 / 0.18 keeps middle gray, 0.18, where it is; w = t^6;
/// result = t * ((1 - w) * color / m + w). So hues stay, and colors turn to white the brighter they are: m = 1 gives
/// 0.63, 4 gives 0.9, 16 gives 0.98. NaN counts as 0.
glm::vec3 filmic_color(const glm::vec3& color);

/// Half the width in pixels of the boxes by which light is spread in a frame of this height: 1/64 of it, at least 1.
/// Their standard deviation together is half a pixel more.
uint32_t bloom_radius(uint32_t full_height);

/// Adds `amount` times the light above white, spread over the pixels around: three boxes of 2 * bloom_radius + 1
/// pixels, one after the other, in each direction, so nearly a Gaussian. The light above white of a color whose largest
/// channel m is above 1 is the color times (m - 1) / m, each channel from 0 to 65,504 (NaN counts as 0). What falls
/// outside of the picture is lost. One thread, one order of sums: the same bits everywhere.
void add_bloom(ColorPicture& picture, double amount, uint32_t full_height);

/// The picture as `view` shows it, for an encoder that clamps to [0, 1]: exposure, bloom (add_bloom), curve. The
/// default view changes no bit. `full_height` is that of the frame of which the picture may be a crop.
ColorPicture viewed(ColorPicture linear, const PictureView& view, uint32_t full_height);

}  // namespace cistula
