// What tests of the built `render-compare` share: small pictures, and runs in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/common/command_line.h"
#include "image/exr/exr.h"
#include "testing/support/run_program.h"

namespace cistula {

using Arguments = std::vector<std::string>;
using Channel = LayeredPicture::Channel;

inline const std::string source = CISTULA_SOURCE_DIR;

/// 4 x 2 pixels at (5, 7) of 20 x 10.
inline LayeredPicture picture_of(std::vector<Channel> channels) {
    LayeredPicture picture;
    picture.width = 4;
    picture.height = 2;
    picture.x = 5;
    picture.y = 7;
    picture.display_width = 20;
    picture.display_height = 10;
    picture.channels = std::move(channels);
    picture.attributes = {{"cistula:depth", 4}, {"cistula:sceneHash", std::string("abc")}};
    return picture;
}

inline const Channel first_r{"R", false, {0, 0.5f, 1, 2, 0, 0, 0, 0}};
inline const Channel second_r{"R", false, {0, 0.75f, 1, 1.5f, 0, 0, 0, 0}};
inline const Channel zeros{"G", false, std::vector<float>(8)};

class RenderCompare : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return folder_.file(name); }
    bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }

    ProgramResult run(const Arguments& arguments) const {
        return RunningProgram(CISTULA_BIN_DIR "/render-compare", arguments, file("")).wait();
    }

    /// The standard output of a run that ends with `code` and says nothing on standard error.
    std::string expect_code(int code, const Arguments& arguments) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, code) << result.out << result.error;
        EXPECT_EQ(result.error, "");
        return result.out;
    }

    void expect_refused(const Arguments& arguments, ExitCode code, const std::string& part) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(result.error.rfind("render-compare: ", 0), 0u) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
        EXPECT_EQ(result.out, "");
    }

    void put(const std::string& name, const LayeredPicture& picture) const { write_exr(file(name), picture); }

    /// a.exr and b.exr of these channels; more arguments; the JSON.
    nlohmann::json compare(int code, const std::vector<Channel>& a, const std::vector<Channel>& b,
                           Arguments more = {}) const {
        put("a.exr", picture_of(a));
        put("b.exr", picture_of(b));
        more.insert(more.begin(), {"a.exr", "b.exr", "--json", "result.json"});
        expect_code(code, more);
        return nlohmann::json::parse(bytes_of(file("result.json")));
    }

    const ScratchDirectory folder_;
};

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace cistula
