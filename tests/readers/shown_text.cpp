// Names and messages as they are shown: one line, whole characters, nothing that acts on a terminal.
#include "base/shown_text.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "base/error.h"

namespace cistula {
namespace {

TEST(ShownText, ControlsAreEscaped) {
    EXPECT_EQ(one_line("a\nb\tc\x01"), "a\\nb\\tc\\x01");
    EXPECT_EQ(one_line("\x1b[31mred\x1b[0m\x7f\r"), "\\x1b[31mred\\x1b[0m\\x7f\\x0d");
    EXPECT_EQ(one_line(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(one_line("\xc2\x9b"
                       "31m"),
              "\\u009b31m");  // CSI in one character
    EXPECT_EQ(one_line("gpj.\xe2\x80\xae"
                       "exr"),
              "gpj.\\u202e"
              "exr");  // right to left
    EXPECT_EQ(one_line("a\xe2\x80\xa8"
                       "b\xef\xbb\xbf"),
              "a\\u2028b\\ufeff");
    EXPECT_EQ(one_line("\xe2\x81\xa6\xd8\x9c"), "\\u2066\\u061c");
}

TEST(ShownText, CharactersStayAndBrokenOnesAreEscapedByteByByte) {
    for (const char* text : {"", "glas", "Gl\xc3\xa4ser", "\xe6\xb0\xb4", "\xf0\x9f\x94\xae", "C:\\new\\x1b"})
        EXPECT_EQ(one_line(text), text);
    EXPECT_EQ(one_line("\xff"), "\\xff");
    EXPECT_EQ(one_line("h\xf6he"), "h\\xf6he");  // Latin-1
    EXPECT_EQ(one_line("\xc3"), "\\xc3");        // cut
    EXPECT_EQ(one_line("\xf0\x9f\x94"), "\\xf0\\x9f\\x94");
    EXPECT_EQ(one_line("\xc0\x8a"), "\\xc0\\x8a");  // a line end, overlong
    EXPECT_EQ(one_line("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");
    EXPECT_EQ(one_line("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half of a pair
    EXPECT_EQ(one_line("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last character
    EXPECT_EQ(one_line("\xc3(\xa4"), "\\xc3(\\xa4");
}

TEST(ShownText, NamesBecomeUtf8AndStayWhatTheyAreIfTheyAreThat) {
    for (const char* text :
         {"", "Gl\xc3\xa4ser", "\xe6\xb0\xb4", "C:\\new", "50%", "100% wool", "a%20b", "%2", "%7F", "%e9", "%"})
        EXPECT_EQ(utf8_name(text), text);
    EXPECT_EQ(utf8_name("caf\xe9"), "caf%E9");   // Latin-1
    EXPECT_EQ(utf8_name("\x94\xa0"), "%94%A0");  // Shift-JIS
    EXPECT_EQ(utf8_name("\xed\xa0\x80\xc3\xa9"), "%ED%A0%80\xc3\xa9");
    EXPECT_EQ(utf8_name("caf%E9"), "caf%25E9") << "unlike that of the byte";
    EXPECT_EQ(utf8_name("%25%\x80"), "%2525%%80");
}

TEST(ShownText, NamesOfDifferentBytesAreDifferent) {
    constexpr std::string_view parts[] = {"%", "E", "9", "25", "%E9", "\xe9", "\xc3", "\xa9", "e"};
    std::map<std::string, std::string> bytes_of;
    for (int i = 0; i < 9 * 9 * 9 * 9 * 9; ++i) {
        std::string bytes;
        for (int rest = i; rest > 0; rest /= 9) bytes += parts[rest % 9];
        const std::string name = utf8_name(bytes);
        EXPECT_TRUE(is_utf8(name)) << name;
        EXPECT_EQ(bytes_of.try_emplace(name, bytes).first->second, bytes) << name;
    }
}

TEST(ShownText, CutsAreBetweenCharacters) {
    std::string word;
    for (int i = 0; i < 40; ++i) word += "\xe6\xb0\xb4";
    EXPECT_EQ(quoted(std::string_view(word)), "'" + word + "'");
    EXPECT_EQ(quoted(word + "x"), "'" + word + "...'");
    EXPECT_EQ(quoted(std::string(41, 'a')), "'" + std::string(40, 'a') + "...'");
    EXPECT_EQ(quoted(std::string_view("it's\n")), "'it's\\n'");
    EXPECT_EQ(first_characters("\xc3\xa4\xc3\xb6\xc3\xbc", 2), "\xc3\xa4\xc3\xb6");
    EXPECT_EQ(first_characters("\x1b\x1b", 1), "\\x1b");
    EXPECT_EQ(first_characters("abc", 9), "abc");
}

TEST(ShownText, AnyBytesBecomeALineOfCharactersThatStaysAsItIs) {
    std::mt19937 random(7);
    for (int round = 0; round < 2000; ++round) {
        std::string bytes(random() % 40, '\0');
        for (char& c : bytes) c = static_cast<char>(random());
        const std::string line = one_line(bytes);
        EXPECT_EQ(one_line(line), line);
        for (const char c : line) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
    }
}

TEST(ShownText, MessagesAreCutInTheirMiddle) {
    const Error error(ErrorKind::file, std::string(100000, 'a') + "\n" + std::string(100000, 'b'));
    const std::string message = error.what();
    EXPECT_EQ(message.size(), 4005u);
    EXPECT_TRUE(message.starts_with("aaa") && message.ends_with("bbb")) << message;
    EXPECT_NE(message.find("a ... b"), std::string::npos);
    std::string long_name;
    for (int i = 0; i < 4001; ++i) long_name += "\xc3\xa4";
    EXPECT_EQ(message_line(long_name).size(), 2 * 4000u + 5);
    EXPECT_EQ(message_line(long_name.substr(2)), long_name.substr(2));
    EXPECT_STREQ(Error(ErrorKind::file, "a\x1b[2Jb: cannot\nbe").what(), "a\\x1b[2Jb: cannot\\nbe");
}

}  // namespace
}  // namespace cistula
