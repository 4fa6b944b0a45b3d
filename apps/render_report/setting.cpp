#include "setting.h"

#include <fmt/format.h>

namespace cistula::report {

void to_json(Json& json, const Setting& setting) {
    json = {{"depth", setting.depth},
            {"cutoff", setting.cutoff},
            {"precision", precision_name(setting.precision)},
            {"supersample", setting.supersample},
            {"intersector", setting.intersector}};
}

void from_json(const Json& json, Setting& setting) {
    setting.depth = json.at("depth");
    setting.cutoff = json.at("cutoff");
    setting.precision = json.at("precision") == "double" ? Precision::double_ : Precision::single_;
    setting.supersample = json.at("supersample");
    setting.intersector = json.at("intersector");
}

FrameSettings frame_settings(const Setting& setting, int width, int height) {
    FrameSettings settings;
    settings.full_width = width;
    settings.full_height = height;
    settings.crop = {0, 0, width, height};
    settings.supersample = setting.supersample;
    settings.depth = setting.depth;
    settings.cutoff = setting.cutoff;
    return settings;
}

std::string setting_name(const Setting& setting) {
    return fmt::format("depth:{}/cutoff:{}/{}/samples:{}x{}{}", setting.depth, setting.cutoff,
                       precision_name(setting.precision), setting.supersample, setting.supersample,
                       setting.intersector == "exact" ? "" : "/" + setting.intersector);
}

std::string command_line(const std::string& scene, int width, int height, const Setting& setting,
                         const std::string& backend) {
    return fmt::format("render {} --res {}x{} --supersample {} --depth {} --cutoff {} --precision {}{}{}", scene, width,
                       height, setting.supersample, setting.depth, setting.cutoff, precision_name(setting.precision),
                       setting.intersector == "exact" ? "" : " --intersector " + setting.intersector,
                       backend == "embree" ? "" : " --backend " + backend);
}

const char* precision_name(Precision precision) {
    return precision == Precision::double_ ? "double" : "float";
}

}  // namespace cistula::report
