#include "setting.h"

#include <fmt/format.h>

#include "cistula/transport/ray_tree.h"

namespace cistula::report {

void to_json(Json& json, const Setting& setting) {
    json = {{"depth", setting.depth},
            {"cutoff", setting.cutoff},
            {"precision", precision_name(setting.precision)},
            {"supersample", setting.supersample},
            {"target_error", setting.target_error}};
}

void from_json(const Json& json, Setting& setting) {
    setting.depth = json.at("depth");
    setting.cutoff = json.at("cutoff");
    setting.precision = json.at("precision") == "double" ? Precision::double_ : Precision::single_;
    setting.supersample = json.at("supersample");
    setting.target_error = json.at("target_error");
}

Setting with_target(Setting setting, double target_error) {
    setting.target_error = target_error;
    setting.depth = largest_depth;
    setting.cutoff = 0;
    setting.supersample = 1;
    return setting;
}

FrameSettings frame_settings(const Setting& setting, int width, int height) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.supersample = setting.supersample;
    settings.depth = setting.adaptive() ? largest_depth : setting.depth;
    settings.cutoff = setting.cutoff;
    settings.target_error = setting.target_error;
    return settings;
}

std::string setting_name(const Setting& setting) {
    if (setting.adaptive()) return fmt::format("target:{}/{}", setting.target_error, precision_name(setting.precision));
    return fmt::format("depth:{}/cutoff:{}/{}/samples:{}x{}", setting.depth, setting.cutoff,
                       precision_name(setting.precision), setting.supersample, setting.supersample);
}

std::string command_line(const std::string& scene, int width, int height, const Setting& setting,
                         const std::string& backend) {
    const std::string accuracy = setting.adaptive() ? fmt::format("--target-error {}", setting.target_error)
                                                    : fmt::format("--supersample {} --depth {} --cutoff {}",
                                                                  setting.supersample, setting.depth, setting.cutoff);
    return fmt::format("render {} --res {}x{} {} --precision {}{}", scene, width, height, accuracy,
                       precision_name(setting.precision), backend == "embree" ? "" : " --backend " + backend);
}

}  // namespace cistula::report
