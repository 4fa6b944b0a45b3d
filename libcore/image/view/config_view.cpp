#include "image/view/config_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/suggest.h"
#include "image/color/srgb_codes.h"
#include "image/reader/oiio_module.h"
#include "image/reader/reader_process.h"

namespace cistula {
namespace {

/// What the module says while it opens a view.
struct Answers {
    std::vector<std::string> views;
    std::string failure;
};

OiioViewHost host_of(Answers& answers) {
    return {&answers,
            [](void* self, const char* name) noexcept { static_cast<Answers*>(self)->views.emplace_back(name); },
            [](void* self, const char* reason) noexcept { static_cast<Answers*>(self)->failure = reason; }};
}

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<std::string>& views,
                               const std::string& why_no_more) {
    const std::vector<std::string_view> known(views.begin(), views.end());
    throw Error(ErrorKind::usage, "there is no such view",
                nearest_first(name, known, "views") + (why_no_more.empty() ? "" : "; ") + why_no_more)
        .of("view", name);
}

}  // namespace

ConfigView::ConfigView(const std::string& name, const std::vector<std::string>& own) {
    Answers answers;
    const char* const variable = std::getenv("OCIO");
    const std::string config = variable ? variable : "";
    try {
        const std::string users = "views other than srgb and filmic";
        module_ = &load_oiio(std::filesystem::path(reader_path(users)).parent_path(), users);
        const OiioViewHost host = host_of(answers);
        view_ = module_->open_view(config.c_str(), name.c_str(), &host);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail_unknown(name, own, error.what());
    }
    if (view_) return;
    if (!config.empty() && !answers.failure.empty())
        throw Error(ErrorKind::file, answers.failure).at("$OCIO, " + config).of("view", name);
    answers.views.insert(answers.views.begin(), own.begin(), own.end());
    fail_unknown(name, answers.views, answers.failure);
}

ConfigView::~ConfigView() {
    if (view_) module_->close_view(view_);
}

void ConfigView::apply(ColorPicture& picture) const {
    if (picture.texels.empty()) return;
    if (!module_->apply_view(view_, &picture.texels.front()[0], picture.texels.size())) throw std::bad_alloc();
    for (glm::vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c) {
            const float code = texel[c] > 0 ? std::min(texel[c], 1.0f) : 0;  // NaN is 0
            texel[c] = srgb8_to_linear(static_cast<uint8_t>(std::lround(255 * code)));
        }
}

std::string ConfigView::warning() const {
    const char* const assumed = module_->assumed_space(view_);
    return assumed ? fmt::format(
                         "`view`: the config of $OCIO has neither a space of the name lin_rec709_scene nor the "
                         "role aces_interchange; linear Rec. 709 is taken for its scene_linear, {}",
                         assumed)
                   : "";
}

}  // namespace cistula
