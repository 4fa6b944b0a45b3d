// What the program that reads pictures says is checked: a picture may have made it say anything.
#include "image/reader/reader_reply.h"

#include <gtest/gtest.h>

#include <cstring>

#include "testing/support/pictures/srgb_codes.h"

namespace cistula {
namespace {

template <class T>
std::string raw(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string word(const std::string& text) {
    return text + '\0';
}

std::string part(ReplyKind kind, const std::string& bytes) {
    return raw(ReplyHead{kind, static_cast<uint32_t>(bytes.size())}) + bytes;
}

std::string picture_part(uint32_t width, uint32_t height, uint32_t channels, StoredType type, uint32_t level = 0) {
    std::string names = word("png");
    for (uint32_t i = 0; i < channels; ++i) names += word("same");
    return part(ReplyKind::picture,
                raw(ReplyPicture{0, 0, 0, 0, width, height, width, height, level, channels, type, 0}) + names);
}

constexpr auto uint8 = StoredType::uint8;
const std::string end = part(ReplyKind::end, "");

/// Calls `take` with an answer; what it receives throws also where the answer ends before.
template <class Take>
auto with_answer(const std::string& answer, bool is_texture, uint64_t left, Take take) {
    size_t at = 0;
    const Receive receive = [&](void* to, size_t size) {
        if (size > answer.size() - at) throw std::runtime_error("ended");
        std::memcpy(to, answer.data() + at, size);
        at += size;
    };
    ReaderReply reply(receive, is_texture, left);
    return take(reply);
}

ColorPicture read_answer(const std::string& answer, uint64_t left = 1200) {
    return with_answer(answer, true, left, [](ReaderReply& reply) { return receive_texture(reply, ""); });
}

StoredFile read_stored(const std::string& answer, uint64_t left = 1200) {
    return with_answer(answer, false, left, [](ReaderReply& reply) { return receive_stored(reply); });
}

TEST(ReaderReply, PicturesOfEveryKindOfSample) {
    const std::string codes("\x01\x80\xff\x07\x08\x09", 6);
    const auto code = [](int value) { return linear_from_srgb8(static_cast<uint8_t>(value)); };
    const std::vector<glm::vec3> expected = {{code(1), code(128), code(255)}, {code(7), code(8), code(9)}};
    const auto samples = [](const std::string& bytes) { return part(ReplyKind::samples, bytes); };
    EXPECT_EQ(read_answer(picture_part(1, 2, 3, uint8) + samples(codes) + end).texels, expected);
    const ColorPicture split =
        read_answer(picture_part(2, 1, 3, uint8) + samples(codes.substr(0, 3)) + samples(codes.substr(3)) + end);
    EXPECT_EQ(split.texels, expected);
    EXPECT_EQ(split.width, 2u);
    EXPECT_EQ(split.height, 1u);
    EXPECT_EQ(read_answer(picture_part(1, 1, 1, uint8) + samples("\x80") + end).texels,
              std::vector<glm::vec3>{glm::vec3(code(128))});
    EXPECT_EQ(read_answer(picture_part(1, 1, 1, StoredType::uint16) + samples(raw(uint16_t{40000})) + end).texels,
              std::vector<glm::vec3>{glm::vec3(linear_from_srgb16(40000))});
    EXPECT_EQ(read_answer(picture_part(1, 1, 1, StoredType::float_) + samples(raw(1e-42f)) + end).texels,
              std::vector<glm::vec3>{glm::vec3(1e-42f)});
}

ReplyColors colors_of_ap1() {
    return {{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f}, 1, 0, 1};
}

TEST(ReaderReply, ColorsOfTheFileComeBeforeItsSamples) {
    const std::string samples = part(ReplyKind::samples, raw(0.5f) + raw(0.25f) + raw(0.1f)) + end;
    const auto with = [&](const ReplyColors& colors, const std::string& id) {
        return read_answer(picture_part(1, 1, 3, StoredType::float_) + part(ReplyKind::colors, raw(colors) + id) +
                           samples)
            .texels.at(0);
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
    const std::string good = picture_part(2, 1, 3, uint8), six("abcdef"), values = part(ReplyKind::samples, six);
    const std::string colors = part(ReplyKind::colors, raw(ReplyColors{}));
    const std::string answers[] = {
        picture_part(0, 1, 3, uint8),
        picture_part(1, 0, 3, uint8),
        picture_part(65536, 65536, 3, uint8),
        picture_part(0xffffffff, 0xffffffff, 3, uint8),
        picture_part(2, 1, 0, uint8),
        picture_part(2, 1, 3, StoredType::uint),
        picture_part(2, 1, 3, StoredType{77}),
        picture_part(2, 1, 3, uint8, 1),
        part(ReplyKind::picture, ""),
        part(ReplyKind::picture, raw(ReplyPicture{0, 0, 0, 0, 2, 1, 2, 1, 0, 3, uint8, 0}) + word("png")),
        part(ReplyKind::picture, raw(ReplyPicture{0, 0, 0, 0, 2, 1, 2, 1, 0, 1, uint8, 0}) + word("png") + "Y"),
        part(ReplyKind::picture, raw(ReplyPicture{1 << 31, 0, 0, 0, 2, 1, 2, 1, 0, 1, uint8, 0}) + word("") + word("")),
        part(ReplyKind::picture,
             raw(ReplyPicture{0, 0, 0, 0, 2, 1, 1u << 31, 1, 0, 1, uint8, 0}) + word("") + word("")),
        values,
        colors + good,
        end,
        good + part(ReplyKind::colors, six),
        good + part(ReplyKind::colors, raw(ReplyColors{}) + std::string(largest_reply_id + 1, 'x')),
        good + part(ReplyKind::attribute, word("a") + word("b")),
        good + end,
        good + values + values,
        good + values + colors,
        part(ReplyKind{0}, six),
        part(ReplyKind{77}, six),
        raw(ReplyHead{ReplyKind::picture, 0xffffffff}),
        good + good,
        good + part(ReplyKind::samples, ""),
        good + part(ReplyKind::samples, "ab"),
        good + part(ReplyKind::samples, six + "ghi"),
        good + part(ReplyKind::samples, "abc") + values,
        good + raw(ReplyHead{ReplyKind::samples, largest_reply_part + 1}),
    };
    for (const std::string& answer : answers) {
        EXPECT_THROW(read_answer(answer + std::string(64, 'x')), ReaderBroken);
        EXPECT_THROW(read_stored(answer + std::string(64, 'x')), ReaderBroken);
    }
}

TEST(ReaderReply, TexturesAreOnePictureOfColorsWithinTheLimit) {
    const std::string values = part(ReplyKind::samples, std::string(100, 'x'));
    EXPECT_NO_THROW(read_answer(picture_part(100, 1, 1, uint8) + values + end));
    EXPECT_NO_THROW(read_stored(picture_part(100, 1, 1, uint8) + values + end, 400));
    EXPECT_THROW(read_answer(picture_part(100, 1, 1, uint8) + values + end, 1199), ReaderBroken);
    EXPECT_THROW(read_stored(picture_part(100, 1, 1, uint8) + values + end, 399), ReaderBroken);
    const std::string twice = picture_part(100, 1, 1, uint8) + values + picture_part(100, 1, 1, uint8) + values + end;
    EXPECT_EQ(read_stored(twice).pictures.size(), 2u);
    EXPECT_THROW(read_answer(twice, 1 << 20), ReaderBroken);
    for (const uint32_t channels : {2u, 4u})
        EXPECT_THROW(read_answer(picture_part(1, 1, channels, uint8)), ReaderBroken);
    for (const StoredType type : {StoredType::int8, StoredType::int16, StoredType::uint32, StoredType::int32,
                                  StoredType::half, StoredType::double_})
        EXPECT_THROW(read_answer(picture_part(1, 1, 1, type) + values), ReaderBroken);
}

TEST(ReaderReply, StoredFilesAreAllThatIsSaid) {
    uint64_t left = 1000;
    const std::string answer =
        picture_part(1, 2, 2, StoredType::int16) + part(ReplyKind::attribute, word("a") + word("string") + word("b")) +
        part(ReplyKind::attribute, word("compression") + word("string") + word("zip")) +
        part(ReplyKind::samples, raw(int16_t{-1}) + raw(int16_t{2}) + raw(int16_t{3}) + raw(int16_t{-4})) +
        picture_part(1, 1, 1, StoredType::double_, 1) + part(ReplyKind::samples, raw(0.1)) + end;
    size_t at = 0;
    ReaderReply reply(
        [&](void* to, size_t size) {
            std::memcpy(to, answer.data() + at, size);
            at += size;
        },
        false, left);
    const StoredFile file = receive_stored(reply);
    EXPECT_EQ(at, answer.size());
    EXPECT_EQ(left, 1000u - 16 - 8);
    EXPECT_EQ(file.format, "png");
    ASSERT_EQ(file.pictures.size(), 2u);
    const StoredPicture& first = file.pictures[0];
    EXPECT_EQ(first.attributes.at("a"), (StoredAttribute{"string", "b", "b"}));
    EXPECT_EQ(first.packing.at("compression"), "zip");
    EXPECT_EQ(first.channels[0].name, "same");
    EXPECT_EQ(first.channels[1].name, "same (2)");
    EXPECT_EQ(std::get<std::vector<int32_t>>(first.channels[0].values), (std::vector<int32_t>{-1, 3}));
    EXPECT_EQ(std::get<std::vector<int32_t>>(first.channels[1].values), (std::vector<int32_t>{2, -4}));
    EXPECT_EQ(file.pictures[1].x_level, 1);
    EXPECT_EQ(std::get<std::vector<double>>(file.pictures[1].channels[0].values), std::vector<double>{0.1});
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
    EXPECT_EQ(reason(picture_part(2, 1, 3, uint8) + part(ReplyKind::failed, "late")), "late");
    EXPECT_EQ(reason(part(ReplyKind::failed, std::string(100'000, 'x'))).size(), 1000u);
}

}  // namespace
}  // namespace cistula
