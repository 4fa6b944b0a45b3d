#include "sequence/frame_list.h"

#include <gtest/gtest.h>

#include "testing/support/expect_error.h"

namespace cistula {
namespace {

using Frames = std::vector<int>;

TEST(FrameList, OneFrame) {
    EXPECT_EQ(parse_frames("7"), Frames{7});
    EXPECT_EQ(parse_frames("0"), Frames{0});
    EXPECT_EQ(parse_frames("0012"), Frames{12});
    EXPECT_EQ(parse_frames("9999999"), Frames{9999999});
}

TEST(FrameList, RangesAndSteps) {
    EXPECT_EQ(parse_frames("3-6"), (Frames{3, 4, 5, 6}));
    EXPECT_EQ(parse_frames("4-4"), Frames{4});
    EXPECT_EQ(parse_frames("0-20x5"), (Frames{0, 5, 10, 15, 20}));
    EXPECT_EQ(parse_frames("0-19x5"), (Frames{0, 5, 10, 15}));
    EXPECT_EQ(parse_frames("0-3x100"), Frames{0});
    EXPECT_EQ(parse_frames("9999998-9999999x9999999"), Frames{9999998});
    EXPECT_EQ(parse_frames("0-299x5").size(), 60u);
}

TEST(FrameList, ListsKeepTheirOrderAndNameAFrameOnce) {
    EXPECT_EQ(parse_frames("0-10x5,7"), (Frames{0, 5, 10, 7}));
    EXPECT_EQ(parse_frames("5,3,5,0-5x1"), (Frames{5, 3, 0, 1, 2, 4}));
}

TEST(FrameList, Errors) {
    const auto malformed = [](const std::string& item) {
        return "\"" + item +
               "\" is no frame (0 to 9999999), no range A-B and no range with a step A-BxS; a list looks like "
               "0-299x5,7";
    };
    for (const std::string text : {"", "a", "-3", "3-", "3-x2", "1x2", "0-9x", "0-9x-1", "0-9x2x3", "1.5", " 1", "1 ",
                                   "+1", "10000000", "99999999999999999999", "0-10000000", "1-2-3"})
        EXPECT_ERROR(parse_frames(text), ExitCode::usage, malformed(text));
    EXPECT_ERROR(parse_frames("1,,2"), ExitCode::usage, malformed(""));
    EXPECT_ERROR(parse_frames("1,2,"), ExitCode::usage, malformed(""));
    EXPECT_ERROR(parse_frames("1;2"), ExitCode::usage, malformed("1;2"));
    EXPECT_ERROR(parse_frames("1,9-3"), ExitCode::usage, "9-3 runs backward; write 3-9");
    EXPECT_ERROR(parse_frames("0-9x0"), ExitCode::usage, "the step of 0-9x0 must be 1 or more");
    EXPECT_ERROR(parse_frames("0-1000000"), ExitCode::usage, "more than 1000000 frames; render them in several runs");
    EXPECT_EQ(parse_frames("0-999999").size(), 1000000u);
    EXPECT_EQ(frames_from(parse_frames("9000000-9999999"), 999998, 9), (Frames{9999998, 9999999}));
    std::string many;
    for (int i = 0; i < 9999; ++i) many += "0-999999x1,";
    try {  // what is written counts, so that a list takes no longer than a million frames
        parse_frames(many + "0");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_LT(std::string(error.what()).size(), 300u);
        EXPECT_TRUE(std::string(error.what()).starts_with("more than 1000000 frames; render them in several runs"));
    }
}

TEST(FrameList, FormatIsReadBack) {
    EXPECT_EQ(format_frames({1, 2, 3, 7}), "1-3,7");
    EXPECT_EQ(format_frames({}), "");
    EXPECT_EQ(format_frames({4}), "4");
    EXPECT_EQ(format_frames({3, 2, 1}), "3,2,1");
    EXPECT_EQ(format_frames({0, 5, 10, 15, 7, 9}), "0-15x5,7,9");
    EXPECT_EQ(format_frames(parse_frames("3-999999x3"), 2), "9-999999x3");
    EXPECT_EQ(format_frames(parse_frames("3-999999x3"), 333333), "");
    for (const Frames& frames : {Frames{0, 5, 10, 7}, Frames{9, 10, 11, 12, 3, 4}, Frames{2, 3}})
        EXPECT_EQ(parse_frames(format_frames(frames)), frames);
}

}  // namespace
}  // namespace cistula
