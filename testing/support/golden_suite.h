// The golden images of this source tree, golden/suite.json, for tests that render them by intersectors of their own.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace cistula::golden {

/// What the suite expects of a scene, as "hard/slivers", in a precision, "float" or "double".
struct Expected {
    std::string film_hash;
    std::string image;  // the path of its EXR
    int width = 0, height = 0;
};

/// The case SCENE/PRECISION of the suite in ROOT/golden. Throws if there is none.
inline Expected expected(const std::string& root, const std::string& scene, const std::string& precision) {
    const std::string folder = root + "/golden/";
    const auto suite = nlohmann::json::parse(std::ifstream(folder + "suite.json"));
    for (const auto& one : suite.at("cases")) {
        if (one.at("name") != scene + "/" + precision) continue;
        const auto& size = one.contains("resolution") ? one.at("resolution") : suite.at("defaults").at("resolution");
        return {one.at("film_hash"), folder + one.at("golden").get<std::string>(), size.at(0), size.at(1)};
    }
    throw std::runtime_error("golden/suite.json has no case " + scene + "/" + precision);
}

}  // namespace cistula::golden
