// What the program that reads pictures says is checked: a picture may have made it say anything.
#include "scene/image/reader_reply.h"

#include <gtest/gtest.h>

#include <cstring>

#include "scene/image/texture_limits.h"
#include "testing/support/srgb_codes.h"

namespace cistula {
namespace {

template <class T>
std::string raw(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string part(ReplyKind kind, const std::string& bytes) {
    return raw(ReplyHead{kind, static_cast<uint32_t>(bytes.size())}) + bytes;
}

std::string size_part(uint32_t width, uint32_t height, uint32_t channels, uint32_t sample_bytes) {
    return part(ReplyKind::size, raw(ReplySize{width, height, channels, sample_bytes}));
}

/// The picture of an answer; throws also where the answer ends before.
ColorPicture read_answer(const std::string& answer, uint64_t left = 1200) {
    size_t at = 0;
    const Receive receive = [&](void* to, size_t size) {
        if (size > answer.size() - at) throw std::runtime_error("ended");
        std::memcpy(to, answer.data() + at, size);
        at += size;
    };
    const ReplyStart start = receive_start(receive, left);
    const bool is_floating = start.size.sample_bytes == 4;
    const FileEncoding encoding = file_encoding("", start.colors, is_floating);
    return receive_texels(receive, start.size, {encoding, start.size.sample_bytes, start.colors.is_half});
}

TEST(ReaderReply, PicturesOfEveryKindOfSample) {
    const std::string codes("\x01\x80\xff\x07\x08\x09", 6);
    const auto code = [](int value) { return linear_from_srgb8(static_cast<uint8_t>(value)); };
    const std::vector<glm::vec3> expected = {{code(1), code(128), code(255)}, {code(7), code(8), code(9)}};
    EXPECT_EQ(read_answer(size_part(1, 2, 3, 1) + part(ReplyKind::samples, codes)).texels, expected);
    const ColorPicture split = read_answer(size_part(2, 1, 3, 1) + part(ReplyKind::samples, codes.substr(0, 3)) +
                                           part(ReplyKind::samples, codes.substr(3)));
    EXPECT_EQ(split.texels, expected);
    EXPECT_EQ(split.width, 2u);
    EXPECT_EQ(split.height, 1u);
    EXPECT_EQ(read_answer(size_part(1, 1, 1, 1) + part(ReplyKind::samples, "\x80")).texels,
              std::vector<glm::vec3>{glm::vec3(code(128))});
    EXPECT_EQ(read_answer(size_part(1, 1, 1, 2) + part(ReplyKind::samples, raw(uint16_t{40000}))).texels,
              std::vector<glm::vec3>{glm::vec3(linear_from_srgb16(40000))});
    EXPECT_EQ(read_answer(size_part(1, 1, 1, 4) + part(ReplyKind::samples, raw(1e-42f))).texels,
              std::vector<glm::vec3>{glm::vec3(1e-42f)});
}

ReplyColors colors_of_ap1() {
    return {{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f}, 1, 0, 1};
}

TEST(ReaderReply, ColorsOfTheFileComeBeforeItsSize) {
    const std::string samples = size_part(1, 1, 3, 4) + part(ReplyKind::samples, raw(0.5f) + raw(0.25f) + raw(0.1f));
    const auto with = [&](const ReplyColors& colors, const std::string& id) {
        return read_answer(part(ReplyKind::colors, raw(colors) + id) + samples).texels.at(0);
    };
    const glm::vec3 converted = with(colors_of_ap1(), "");
    EXPECT_NEAR(converted.x, 0.688752f, 2e-6f);
    EXPECT_EQ(with(colors_of_ap1(), "lin_ap1_scene"), converted);
    EXPECT_EQ(with({}, "lin_ap1_scene"), converted);
    EXPECT_EQ(with({}, ""), glm::vec3(0.5f, 0.25f, 0.1f));
    EXPECT_EQ(with({}, "data"), glm::vec3(0.5f, 0.25f, 0.1f));
    EXPECT_NE(with({{}, 0, 1, 0}, ""), converted);
    EXPECT_THROW(with(colors_of_ap1(), "lin_rec709_scene"), std::runtime_error);
    EXPECT_THROW(with({}, std::string(largest_reply_id, 'x')), std::runtime_error);
}

TEST(ReaderReply, WhatMakesNoSenseIsRefused) {
    const std::string good = size_part(2, 1, 3, 1), six("abcdef");
    const std::string answers[] = {
        size_part(0, 1, 3, 1),
        size_part(1, 0, 3, 1),
        size_part(101, 1, 3, 1),  // of the 100 texels that are left
        size_part(65536, 65536, 3, 1),
        size_part(0xffffffff, 0xffffffff, 3, 1),
        size_part(2, 1, 2, 1),
        size_part(2, 1, 0, 1),
        size_part(2, 1, 4, 1),
        size_part(2, 1, 3, 0),
        size_part(2, 1, 3, 3),
        size_part(2, 1, 3, 8),
        part(ReplyKind::size, raw(ReplySize{2, 1, 3, 1}) + "x"),
        part(ReplyKind::size, ""),
        part(ReplyKind::samples, six),
        part(ReplyKind::colors, six),
        part(ReplyKind::colors, raw(ReplyColors{}) + std::string(largest_reply_id + 1, 'x')) + good,
        part(ReplyKind::colors, raw(ReplyColors{})) + part(ReplyKind::colors, raw(ReplyColors{})) + good,
        good + part(ReplyKind::colors, raw(ReplyColors{})),
        part(ReplyKind{0}, six),
        part(ReplyKind{77}, six),
        raw(ReplyHead{ReplyKind::size, 0xffffffff}),
        good + good,
        good + part(ReplyKind::samples, ""),
        good + part(ReplyKind::samples, "ab"),
        good + part(ReplyKind::samples, six + "ghi"),
        good + part(ReplyKind::samples, "abc") + part(ReplyKind::samples, six),
        good + raw(ReplyHead{ReplyKind::samples, largest_reply_part + 1}),
    };
    for (const std::string& answer : answers) EXPECT_THROW(read_answer(answer + std::string(64, 'x')), ReaderBroken);
    EXPECT_NO_THROW(read_answer(size_part(100, 1, 1, 1) + part(ReplyKind::samples, std::string(100, 'x'))));
}

TEST(ReaderReply, ReasonsAreOneShortLine) {
    const auto reason = [](const std::string& answer) {
        try {
            read_answer(answer);
        } catch (const PictureRefused& refused) {
            return std::string(refused.what());
        }
        return std::string("no reason");
    };
    EXPECT_EQ(reason(part(ReplyKind::failed, "bad\nfile\x1b[31m")), "bad file\\x1b[31m");
    EXPECT_EQ(reason(size_part(2, 1, 3, 1) + part(ReplyKind::failed, "late")), "late");
    EXPECT_EQ(reason(part(ReplyKind::failed, std::string(100'000, 'x'))).size(), 1000u);
}

}  // namespace
}  // namespace cistula
