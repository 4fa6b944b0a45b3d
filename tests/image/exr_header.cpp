// Headers of EXR files that claim more than the file has, or that the library reads as something else than they say,
// are refused before the library takes memory for them.
#include "image/exr/exr_checks.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

std::string number(int64_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(static_cast<uint64_t>(value) >> 8 * i);
    return bytes;
}
std::string word(const std::string& text) {
    return text + '\0';
}
std::string attribute(const std::string& name, const std::string& type, const std::string& value, int64_t size = -1) {
    return word(name) + word(type) + number(size < 0 ? static_cast<int64_t>(value.size()) : size) + value;
}
std::string window(int32_t right, int32_t bottom) {
    return attribute("dataWindow", "box2i", number(0) + number(0) + number(right) + number(bottom));
}

class ExrHeader : public ::testing::Test {
  protected:
    void check(const std::string& attributes, int flags = 0) {
        put_bytes(folder_.file("a.exr"), number(20000630) + number(2 | flags) + attributes);
        check_exr_header(folder_.file("a.exr"));
    }
    void expect_message(const std::string& attributes, const std::string& message, int flags = 0) {
        try {
            check(attributes, flags);
            ADD_FAILURE() << "not refused: " << message;
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(std::string(error.what()), message);
        }
    }
    void expect_refused(const std::string& attributes, const std::string& what, int flags = 0) {
        expect_message(attributes,
                       "its header says that it has " + what + ", more than its bytes can hold; it is damaged", flags);
    }
    void expect_wrong_size(const std::string& attributes, const std::string& name, const std::string& type) {
        expect_message(attributes, "the attribute '" + name + "' of its header does not have the size of its type, '" +
                                       type + "'; it is damaged");
    }

    ScratchDirectory folder_;
};

TEST_F(ExrHeader, AttributesLieInTheFile) {
    EXPECT_NO_THROW(check(attribute("a", "string", "four") + std::string(1, '\0')));
    expect_refused(attribute("a", "string", "four", 2'000'000'000), "an attribute 'a' of 2000000000 bytes");
    expect_refused(attribute("b", "string", "four") + attribute("a", "floatvector", "", 0x70000000),
                   "an attribute 'a' of 1879048192 bytes");
    expect_refused(attribute("a", "string", "four", 0xffffffff), "an attribute 'a' of 4294967295 bytes");
}

TEST_F(ExrHeader, PartsOfAttributesLieInThem) {
    EXPECT_NO_THROW(check(attribute("a", "stringvector", number(2) + "ab" + number(0))));
    expect_refused(attribute("a", "stringvector", number(2) + "ab" + number(0x7fffffff)), "a text too long in 'a'");
    EXPECT_NO_THROW(check(attribute("p", "preview", number(1) + number(1) + "rgba")));
    expect_refused(attribute("p", "preview", number(40000) + number(40000) + "rgba"), "a preview too large");
    expect_refused(attribute("m", "idmanifest", number(2'000'000'000) + "x"), "a manifest too large");
}

/// The library reads a value by its type and goes on behind it. What this check reads must be what the library reads.
TEST_F(ExrHeader, SizesAreThoseOfTypes) {
    EXPECT_NO_THROW(check(attribute("a", "int", number(1))));
    for (const char* type : {"int", "float", "double", "v2f", "m44f", "chromaticities", "compression", "tiledesc"})
        for (const size_t size : {0u, 3u, 200u})
            expect_wrong_size(attribute("a", type, std::string(size, '\1')), "a", type);
    EXPECT_NO_THROW(check(attribute("a", "floatvector", number(1) + number(2))));
    expect_wrong_size(attribute("a", "floatvector", number(1) + "ab"), "a", "floatvector");
    expect_wrong_size(attribute("a", "stringvector", number(2) + "ab" + "c"), "a", "stringvector");
    expect_wrong_size(attribute("p", "preview", number(1) + number(1) + "rgbarest"), "p", "preview");
}

/// The library reads channels up to an empty name.
TEST_F(ExrHeader, ChannelsFillTheirAttribute) {
    const std::string channel = word("A") + number(2) + number(0) + number(1) + number(1), end(1, '\0');
    EXPECT_NO_THROW(check(attribute("channels", "chlist", channel + end)));
    EXPECT_NO_THROW(check(attribute("channels", "chlist", end)));
    for (const std::string& channels :
         {channel + end + "rest", channel, std::string(), channel + "B", channel + "B" + end,
          channel + word("B") + number(2), channel + std::string(300, 'B') + end})
        expect_wrong_size(attribute("channels", "chlist", channels), "channels", "chlist");
}

/// Each chunk has eight bytes in a table.
TEST_F(ExrHeader, TablesOfChunksLieInTheFile) {
    const std::string one_by_one = attribute("tiles", "tiledesc", number(1) + number(1) + std::string(1, '\0'));
    expect_refused(window(59999, 59999) + one_by_one + std::string(1, '\0'), "60000x60000 pixels");
    expect_refused(window(0, 2'000'000'000) + std::string(1, '\0'), "1x2000000001 pixels");
    EXPECT_NO_THROW(check(window(3, 3) + one_by_one + std::string(1, '\0') + std::string(16 * 8, '\0')));
}

TEST_F(ExrHeader, AllPartsAreLookedAt) {
    const std::string end(1, '\0');
    expect_refused(attribute("a", "string", "x") + end + attribute("b", "string", "x", 1 << 30) + end,
                   "an attribute 'b' of 1073741824 bytes", 0x1000);
    EXPECT_NO_THROW(check(attribute("a", "string", "x") + end + attribute("b", "string", "x") + end + end, 0x1000));
}

TEST_F(ExrHeader, OtherFilesAreTheLibrarys) {
    put_bytes(folder_.file("b.exr"), "no EXR");
    EXPECT_NO_THROW(check_exr_header(folder_.file("b.exr")));
    put_bytes(folder_.file("c.exr"), number(20000630));
    EXPECT_NO_THROW(check_exr_header(folder_.file("c.exr")));
    EXPECT_NO_THROW(check(std::string(1000, 'a')));
}

TEST_F(ExrHeader, ReadersRefuseInOneLine) {
    put_bytes(folder_.file("a.exr"), number(20000630) + number(2) + attribute("a", "string", "", 1 << 30));
    const std::string file = folder_.file("a.exr");
    EXPECT_THROW(read_exr(file), Error);
    EXPECT_THROW(read_exr_texture(file), Error);
    EXPECT_FALSE(exr_is_complete(file));
}

}  // namespace
}  // namespace cistula
