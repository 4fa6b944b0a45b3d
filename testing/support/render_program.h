// A fixture that runs the built `render` in a scratch directory with a small scene.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "apps/common/command_line.h"
#include "testing/support/endless_scene.h"
#include "testing/support/run_program.h"

namespace cistula {

using Arguments = std::vector<std::string>;

inline constexpr const char* scene_text = R"({
    "film": {"width": 40, "height": 24, "frames": 3},
    "depth": 6,
    "camera": {"path": {"position": {"r0": 5, "z0": 3, "wphi": 0.1}}, "fov": 60},
    "textures": {"checker": {"checker": [0.8, 0.3], "repeat": [4, 4]}},
    "materials": {
        "glass": {"color": [0.9, 0.5, 0.1], "specular": 0.4, "reflection": 0.2, "transmission": 0.6, "index": 1.3},
        "floor": {"texture": "checker", "reflection": 0.2}
    },
    "objects": [
        {"name": "gem", "solid": "octahedron", "center": [0, 0, 1.5], "material": "glass"},
        {"name": "floor", "quad": [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]], "material": "floor"}
    ],
    "lights": [{"position": [-4, 4, 5]}]
})";

class RenderProgram : public testing::Test {
  protected:
    RenderProgram() { put_bytes(folder_.file("s.json"), scene_text); }

    std::string file(const std::string& name) const { return folder_.file(name); }
    bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }

    ProgramResult run(const Arguments& arguments, const std::string& input = "") const {
        return RunningProgram(program_, arguments, file(""), input).wait();
    }

    void expect_done(const Arguments& arguments, const std::string& input = "") const {
        const ProgramResult result = run(arguments, input);
        EXPECT_EQ(result.code, 0) << result.error;
    }

    /// Expects an error: one line on standard error that begins with "render: " and nothing on standard output.
    void expect_refused(const Arguments& arguments, ExitCode code, const std::string& part) const {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(result.error.rfind("render: ", 0), 0u) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
        EXPECT_EQ(result.out, "");
    }

    /// Expects that SIGINT, SIGTERM, SIGHUP and SIGPIPE each end a frame that would take years.
    void expect_interrupted_within_a_pixel(const Arguments& more) const {
        put_bytes(file("room.json"), test::room_of_mirrors_text);
        Arguments arguments{"room.json", "-v", "-o", "room.exr", "--depth", "256"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
            RunningProgram running(program_, arguments, file(""));
            ASSERT_TRUE(
                running.wait_until([&] { return running.error_so_far().find("scene hash") != std::string::npos; }, 60));
            std::this_thread::sleep_for(std::chrono::seconds(2));  // well into the frame
            const auto sent = std::chrono::steady_clock::now();
            running.send(number);
            const ProgramResult result = running.wait();
            EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
            EXPECT_EQ(result.code, 130) << result.error;
            EXPECT_NE(result.error.find("render: interrupted; 0 of 1 frames"), std::string::npos) << result.error;
            EXPECT_FALSE(exists("room.exr"));
        }
    }

    bool has_part_files() const {
        for (const std::string& name : folder_.names())
            if (name.find(".part") != std::string::npos) return true;
        return false;
    }

    const ScratchDirectory folder_;
    const std::string program_ = CISTULA_BIN_DIR "/render";
};

}  // namespace cistula
