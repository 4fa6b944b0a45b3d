// Metrics against their definitions: relative MSE by hand, SSIM by a loop over whole windows, FLIP against its program.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "apps/render_compare/fixture.h"
#include "image/color/srgb_codes.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

class CompareMetrics : public RenderCompare {
  protected:
    nlohmann::json metrics(const std::string& list, int code = 1, Arguments more = {}) const {
        more.insert(more.begin(), {"a.exr", "b.exr", "--json", "r.json", "--metrics", list});
        expect_code(code, more);
        return nlohmann::json::parse(bytes_of(file("r.json")));
    }

    /// The output of a run that finds no programs but those of a folder.
    std::string run_with_path(const std::string& path) const {
        const ProgramResult result =
            RunningProgram(CISTULA_BIN_DIR "/render-compare", {"a.exr", "b.exr", "--metrics", "flip"}, file(""), "",
                           [&] { setenv("PATH", path.c_str(), 1); })
                .wait();
        EXPECT_EQ(result.code, 1);
        EXPECT_EQ(result.error, "");
        return result.out;
    }
};

TEST_F(CompareMetrics, RelativeMseIsRelativeToTheFirst) {
    const auto r = compare(1, {first_r}, {second_r}).at("channels")[0];
    EXPECT_DOUBLE_EQ(r.at("relative_mse").get<double>(), (0.0625 / 0.26 + 0.25 / 4.01) / 8);
    const auto other = compare(1, {second_r}, {first_r}).at("channels")[0];
    EXPECT_DOUBLE_EQ(other.at("relative_mse").get<double>(), (0.0625 / (0.5625 + 0.01) + 0.25 / 2.26) / 8);
    const Channel infinite{"R", false, {0, test::infinity, 1, 2, 0, 0, 0, 0}};
    EXPECT_EQ(compare(1, {first_r}, {infinite}).at("channels")[0].at("relative_mse"), 0);
}

constexpr int width = 17, height = 13;

/// A picture of 8-bit sRGB codes as linear values.
LayeredPicture of_codes(const std::vector<int>& codes, int columns = width) {
    LayeredPicture picture;
    picture.width = picture.display_width = columns;
    picture.height = picture.display_height = static_cast<int>(codes.size()) / columns;
    for (const char* name : {"B", "G", "R"}) {
        Channel channel{name, false, {}};
        for (const int code : codes) channel.values.push_back(srgb8_to_linear(static_cast<uint8_t>(code)));
        picture.channels.push_back(std::move(channel));
    }
    return picture;
}

/// SSIM as in its paper, window by window, of codes from 0 to 255. `counts(i)`: whether a pixel counts. Windows have
/// the size of smaller pictures.
template <class Counts>
double ssim_of_paper(const std::vector<int>& a, const std::vector<int>& b, Counts counts, int columns = width) {
    const int rows = static_cast<int>(a.size()) / columns, across = std::min(columns, 11), down = std::min(rows, 11);
    const double c1 = std::pow(0.01 * 255, 2), c2 = std::pow(0.03 * 255, 2);
    double sum = 0;
    int windows = 0;
    for (int top = 0; top + down <= rows; ++top)
        for (int left = 0; left + across <= columns; ++left) {
            const auto mean = [&](auto value) {
                double total = 0, weights = 0;
                for (int y = 0; y < down; ++y)
                    for (int x = 0; x < across; ++x) {
                        const double right = x - (across - 1) / 2.0, below = y - (down - 1) / 2.0;
                        const double weight = std::exp(-(right * right + below * below) / (2 * 1.5 * 1.5));
                        total += weight * value(static_cast<size_t>((top + y) * columns + left + x));
                        weights += weight;
                    }
                return total / weights;
            };
            if (mean([&](size_t i) { return counts(i) ? 0.0 : 1.0; }) > 0) continue;
            const double p = mean([&](size_t i) { return a[i]; }), q = mean([&](size_t i) { return b[i]; });
            const double pp = mean([&](size_t i) { return (a[i] - p) * (a[i] - p); });
            const double qq = mean([&](size_t i) { return (b[i] - q) * (b[i] - q); });
            const double pq = mean([&](size_t i) { return (a[i] - p) * (b[i] - q); });
            sum += (2 * p * q + c1) * (2 * pq + c2) / ((p * p + q * q + c1) * (pp + qq + c2));
            ++windows;
        }
    return sum / windows;
}

TEST_F(CompareMetrics, SsimIsThatOfItsPaper) {
    std::vector<int> first, second;
    for (int i = 0; i < width * height; ++i) {
        first.push_back((i * 37 + i / width * 91) % 256);
        second.push_back((i * 37 + i / width * 91 + (i % 5 == 0 ? 60 : 0)) % 256);
    }
    put("a.exr", of_codes(first));
    put("b.exr", of_codes(second));
    const double expected = ssim_of_paper(first, second, [](size_t) { return true; });
    EXPECT_LT(expected, 0.95);
    const auto result = metrics("ssim");
    for (const auto& channel : result.at("channels")) EXPECT_NEAR(channel.at("ssim").get<double>(), expected, 1e-9);
    EXPECT_TRUE(result.at("flip").is_null());
    // Only windows with all their pixels count.
    LayeredPicture mask = of_codes(std::vector<int>(width * height, 255));
    for (Channel& channel : mask.channels) channel.values[16] = 0;  // top right
    put("mask.exr", mask);
    const double masked = ssim_of_paper(first, second, [](size_t i) { return i != 16; });
    EXPECT_NE(masked, expected);
    EXPECT_NEAR(metrics("ssim", 1, {"--mask", "mask.exr"}).at("channels")[0].at("ssim").get<double>(), masked, 1e-9);
    put("b.exr", of_codes(first));
    EXPECT_EQ(metrics("ssim", 0).at("channels")[0].at("ssim"), 1);
}

TEST_F(CompareMetrics, SsimHasSmallerWindowsWherePicturesAreSmaller) {
    for (const auto& [columns, rows] : {std::pair{1, 1}, {4, 3}, {10, 10}, {11, 2}, {2, 30}, {12, 10}, {11, 11}}) {
        std::vector<int> first, second;
        for (int i = 0; i < columns * rows; ++i) {
            first.push_back((i * 53 + 20) % 256);
            second.push_back((i * 53 + 20 + (i % 3 == 0 ? 60 : 0)) % 256);
        }
        put("a.exr", of_codes(first, columns));
        put("b.exr", of_codes(second, columns));
        const double expected = ssim_of_paper(
            first, second, [](size_t) { return true; }, columns);
        EXPECT_NEAR(metrics("ssim").at("channels")[0].at("ssim").get<double>(), expected, 1e-9)
            << columns << 'x' << rows;
        expect_code(1, {"a.exr", "b.exr", "--failssim", "1"});
        EXPECT_TRUE(contains(expect_code(0, {"a.exr", "a.exr", "--failssim", "1"}), "least SSIM 1.000000"));
    }
    std::vector<int> codes(width * height, 90);
    put("a.exr", of_codes(codes));
    put("b.exr", of_codes(codes));
    for (size_t i = 0; i < codes.size(); i += 5) codes[i] = 0;  // leaves no window
    put("mask.exr", of_codes(codes));
    EXPECT_TRUE(metrics("ssim", 0, {"--mask", "mask.exr"}).at("channels")[0].at("ssim").is_null());
}

TEST_F(CompareMetrics, SsimIsOfColors) {
    LayeredPicture first = of_codes(std::vector<int>(width * height, 100));
    for (const char* name : {"Z", "N.Y", "diffuse.G"})
        first.channels.push_back({name, true, std::vector<float>(width * height, 2)});
    LayeredPicture second = first;
    for (Channel& channel : second.channels) channel.values[50] = 30;
    second.channels.front().values[50] = std::numeric_limits<float>::quiet_NaN();
    put("a.exr", first);
    put("b.exr", second);
    const nlohmann::json ssim = metrics("ssim");
    for (const auto& channel : ssim.at("channels")) {
        const std::string name = channel.at("name");
        EXPECT_EQ(channel.at("ssim").is_null(), name == "Z" || name == "N.Y") << name;
    }
    const std::string text = expect_code(1, {"a.exr", "b.exr", "--metrics", "ssim"});
    EXPECT_TRUE(contains(text, " ssim ")) << text;
    EXPECT_FALSE(contains(expect_code(1, {"a.exr", "b.exr"}), "ssim"));
}

TEST_F(CompareMetrics, FlipIsAbsentWithoutItsProgram) {
    put("a.exr", of_codes(std::vector<int>(width * height, 100)));
    put("b.exr", of_codes(std::vector<int>(width * height, 101)));
    const std::string absent = "flip: absent: NVIDIA's program flip is not on PATH; pip install flip-evaluator";
    EXPECT_TRUE(contains(run_with_path(file("none")), absent));
    // Another program of that name.
    std::filesystem::create_directory(file("bin"));
    put_bytes(file("bin/flip"), "#!/bin/sh\necho 'usage: flip [-t|-u|-d|-m] filename'\nexit 1\n");
    ASSERT_EQ(chmod(file("bin/flip").c_str(), 0700), 0);
    EXPECT_TRUE(contains(run_with_path(file("bin")), absent));
    put_bytes(file("bin/flip"), "#!/bin/sh\n[ $1 = --help ] && echo 'FLIP v1.7. --reference' || echo Error: no\n");
    EXPECT_TRUE(contains(run_with_path(file("bin")), "flip: absent: flip says no Mean, but: Error: no\\n\n"));
}

TEST_F(CompareMetrics, FlipIsAbsentWhereItIsNotDefined) {
    put("a.exr", picture_of({first_r}));
    put("b.exr", picture_of({second_r}));
    EXPECT_EQ(metrics("flip").at("flip").at("absent"), "no part has R, G and B in both images");
    const LayeredPicture picture = of_codes(std::vector<int>(width * height, 100));
    LayeredPicture infinite = picture;
    infinite.channels[1].values[5] = test::infinity;
    put("a.exr", picture);
    put("b.exr", infinite);
    put("mask.exr", picture);
    EXPECT_EQ(metrics("flip", 1, {"--mask", "mask.exr"}).at("flip").at("absent"),
              "it looks at neighbors, and a mask leaves some out");
}

TEST_F(CompareMetrics, AnInterruptionLeavesNothingOfFlip) {
    put("a.exr", of_codes(std::vector<int>(width * height, 100)));
    for (const char* folder : {"bin", "temporary"}) std::filesystem::create_directory(file(folder));
    put_bytes(file("bin/flip"),
              "#!/bin/sh\n[ $1 = --help ] && echo 'FLIP v1.7. --reference' && exit\n: > started\nexec /bin/sleep 60\n");
    ASSERT_EQ(chmod(file("bin/flip").c_str(), 0700), 0);
    RunningProgram program(CISTULA_BIN_DIR "/render-compare",
                           {"a.exr", "a.exr", "--metrics", "flip", "--json", "r.json"}, file(""), "", [&] {
                               setenv("PATH", file("bin").c_str(), 1);
                               setenv("TMPDIR", file("temporary").c_str(), 1);
                           });
    ASSERT_TRUE(program.wait_until([&] { return exists("started"); }, 30));
    EXPECT_FALSE(std::filesystem::is_empty(file("temporary")));
    program.send(SIGTERM);
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result = program.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    EXPECT_EQ(result.code, 130);
    EXPECT_EQ(result.error, "render-compare: interrupted while flip runs; nothing was written\n");
    EXPECT_TRUE(std::filesystem::is_empty(file("temporary")));
    EXPECT_FALSE(exists("r.json"));
}

TEST_F(CompareMetrics, FlipIsWhatItsProgramSays) {
    std::vector<int> codes(width * height, 100);
    put("a.exr", of_codes(codes));
    codes[100] = 250;
    put("b.exr", of_codes(codes));
    const auto flip = metrics("flip,ssim").at("flip");
    if (flip.contains("absent")) GTEST_SKIP() << flip.at("absent");
    EXPECT_EQ(flip.at("kind"), "HDR-FLIP");
    EXPECT_GT(flip.at("mean").get<double>(), 0);
    EXPECT_GT(flip.at("max").get<double>(), flip.at("mean").get<double>());
    const ProgramResult direct =
        RunningProgram("/bin/sh", {"-c", "flip -r a.exr -t b.exr -nexm -nerm"}, file("")).wait();
    EXPECT_TRUE(contains(direct.out, fmt::format("Mean: {:.6f}\n", flip.at("mean").get<double>()))) << direct.out;
    put("b.exr", of_codes(std::vector<int>(width * height, 100)));
    EXPECT_EQ(metrics("flip", 0).at("flip").at("mean"), 0);
}

TEST_F(CompareMetrics, AreThresholds) {
    std::vector<int> codes(width * height, 100);
    put("a.exr", of_codes(codes));
    codes[100] = 250;
    put("b.exr", of_codes(codes));
    EXPECT_TRUE(
        contains(expect_code(0, {"a.exr", "b.exr", "--failssim", "0.1"}), "within the thresholds: least SSIM "));
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr", "--failssim", "0.9999"}), "differ: least SSIM "));
    std::filesystem::create_directory(file("bin"));
    put_bytes(file("bin/flip"),
              "#!/bin/sh\n[ $1 = --help ] && echo 'FLIP v1.7. --reference' && exit\n"
              "for n in Mean 'Weighted median' Min Max; do echo \" $n: 0.25\"; done\n");
    ASSERT_EQ(chmod(file("bin/flip").c_str(), 0700), 0);
    const auto run_flip = [&](const std::string& bin, const char* most) {
        return RunningProgram(CISTULA_BIN_DIR "/render-compare", {"a.exr", "b.exr", "--failflip", most}, file(""), "",
                              [&] { setenv("PATH", bin.c_str(), 1); })
            .wait();
    };
    const ProgramResult within = run_flip(file("bin"), "0.25"), over = run_flip(file("bin"), "0.2");
    EXPECT_EQ(within.code, 0) << within.out << within.error;
    EXPECT_TRUE(contains(over.out, "\ndiffer: FLIP 0.250000, --failflip 0.2\n")) << over.out;
    EXPECT_EQ(over.code, 1);
    const ProgramResult absent = run_flip(file("none"), "1");
    EXPECT_EQ(absent.code, 1);
    EXPECT_TRUE(contains(absent.out, "differ: FLIP is not known: NVIDIA's program")) << absent.out;
}

TEST_F(CompareMetrics, AreRefusedByName) {
    put("a.exr", picture_of({first_r}));
    expect_refused({"a.exr", "a.exr", "--metrics", "sim"}, ExitCode::usage,
                   "--metrics sim: must be ssim or flip; did you mean 'ssim'?");
}

}  // namespace
}  // namespace cistula
