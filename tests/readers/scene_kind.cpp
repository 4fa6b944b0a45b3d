// Files that are no scenes, and scenes without an end or without measure.
#include <gtest/gtest.h>

#include <iostream>
#include <streambuf>

#include "scene/readers/read_scene.h"
#include "scene/readers/scene_formats.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using namespace std::literals;

SceneDescription read_unnamed(const std::string& text) {
    return read_scene_text(text, "a", "");
}

/// ASCII as UTF-16.
std::string utf16(const std::string& text, bool big_endian, bool marked) {
    std::string bytes = !marked ? "" : big_endian ? "\xfe\xff" : "\xff\xfe";
    for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
    return bytes;
}

TEST(SceneKind, OtherFilesAreNamedForWhatTheyAre) {
    const std::pair<std::string, const char*> files[] = {
        {"\x89PNG\r\n\x1a\n"s, "a PNG picture"},
        {"\x76\x2f\x31\x01\x02\0\0\0"s, "an OpenEXR picture"},
        {"\xff\xd8\xff\xe0"s, "a JPEG picture"},
        {"GIF89a"s, "a GIF picture"},
        {"II*\0\x08\0\0\0"s, "a TIFF picture"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"s, "a Radiance picture"},
        {"P6\n2 2\n255\n"s, "a PNM picture"},
        {"\x1f\x8b\x08\0"s, "packed by gzip"},
        {"\x28\xb5\x2f\xfd\x04"s, "packed by zstd"},
        {"BZh91AY"s, "packed by bzip2"},
        {"PK\x03\x04\x14\0"s, "a ZIP archive"},
        {"%PDF-1.7\n"s, "a PDF document"},
        {"\x7f"
         "ELF\x02\x01"s,
         "a program"},
        {"#!/bin/sh\n"s, "a script"},
        {"ply\nformat ascii 1.0\n"s, "a PLY mesh"},
        {"# Blender\n\nmtllib a.mtl\nv 0 0 0\n"s, "an OBJ mesh"},
        {"v 0 0 0\r\nv 1 0 0\r\n"s, "an OBJ mesh"},
        {"newmtl glass\n"s, "an MTL library"},
        {"solid cube\n facet normal 0 0 1\n"s, "an STL mesh"},
        {"OFF\n8 6 0\n"s, "an OFF mesh"},
        {"#version 3.7;\n"s, "a POV-Ray scene"},
        {"// Persistence of Vision\n/* mine */\n#include \"colors.inc\"\n"s, "a POV-Ray scene"},
        {"camera{ location <0,0,0> }"s, "a POV-Ray scene"},
        {"LookAt 0 0 0  1 1 1  0 0 1\n"s, "a pbrt scene"},
        {"<!DOCTYPE html>\n<html>"s, "an HTML page"},
        {"\n <html lang=\"en\">"s, "an HTML page"},
        {"<?xml version=\"1.0\"?>"s, "an XML document"},
        {"glTF\x02\0\0\0"s, "a glTF scene"},
        {std::string(5000, '\0'), "binary data"},
        {"\x50\0\0\0\x3c\0\0\0\xff\xff\xff\xff"s, "binary data"},
        {"3\x01\x02\x03"s, "binary data"},
        {utf16("{\"objects\": []}", false, true), "UTF-16"},
        {utf16("{\"objects\": []}", true, true), "UTF-16"},
        {utf16("{\"objects\": []}", false, false), "UTF-16"},
        {utf16(text_input_template(), true, false), "UTF-16"},
        {"\xff\xfe\0\0{\0\0\0"s, "UTF-32"},
    };
    for (const auto& [bytes, name] : files) {
        try {
            read_unnamed(bytes);
            ADD_FAILURE() << "no error: " << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::scene);
            EXPECT_TRUE(std::string(error.what()).starts_with("a: is "s + name + "; ")) << error.what();
        }
    }
    EXPECT_ERROR(read_unnamed(utf16("{}", false, true)), ExitCode::usage, "a: is UTF-16; save it as UTF-8");
    EXPECT_ERROR(read_unnamed("o teapot\n"), ExitCode::usage,
                 "a: is an OBJ mesh; a scene names meshes in its \"objects\", as {\"mesh\": \"FILE\"}");
    EXPECT_ERROR(read_unnamed("<svg>"), ExitCode::usage,
                 "a: is an XML document; expected JSON, which begins with '{', or the text input, which begins with "
                 "the number of frames");
    EXPECT_ERROR(read_unnamed("Dear all,\n"), ExitCode::usage,
                 "a:1: expected number of frames, a whole number from 1 to 1000000, found 'Dear'");
}

TEST(SceneKind, MarksAndLineEndsDoNotMatter) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_FALSE(read_unnamed(mark + "\r\n{\"objects\": []}\r\n").from_text_input);
    EXPECT_TRUE(read_unnamed(mark + text_input_template()).from_text_input);
    EXPECT_ERROR(read_unnamed(mark), ExitCode::usage,
                 "a: the scene is empty; expected JSON or the text of --print-template");
}

/// Input that repeats a text without an end.
class Endless : public std::streambuf {
  public:
    Endless(std::string start, std::string text) : start_(std::move(start)), text_(std::move(text)) {
        while (text_.size() < 4096) text_ += text_;
    }
    uint64_t taken = 0;

  private:
    int_type underflow() override {
        std::string& next = taken == 0 && !start_.empty() ? start_ : text_;
        taken += next.size();
        setg(next.data(), next.data(), next.data() + next.size());
        return traits_type::to_int_type(next[0]);
    }
    std::string start_, text_;
};

TEST(SceneKind, InputWithoutAnEndIsRefused) {
    const auto refused = [](const std::string& start, const std::string& text, uint64_t most, const std::string& what) {
        Endless input(start, text);
        std::streambuf* const before = std::cin.rdbuf(&input);
        std::cin.clear();
        try {
            read_scene("-");
            ADD_FAILURE() << what;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::scene);
            EXPECT_TRUE(std::string(error.what()).starts_with("standard input" + what)) << error.what();
        }
        std::cin.rdbuf(before);
        EXPECT_LE(input.taken, most);
    };
    refused("", "y\n", 10000, ":1: expected number of frames, ");
    refused("", std::string(1000, '\0'), 10000, ": is binary data; ");
    refused("", "\x89PNG", 10000, ": is a PNG picture; ");
    const uint64_t limit = largest_scene_bytes + 100000;
    const std::string too_large = ": is larger than 64 MiB, which no scene may be; ";
    refused("", std::string(1000, ' '), limit, too_large);
    refused("", "1 ", limit, too_large);
    refused("{\"objects\": [", "{}, ", limit, too_large);
    refused("{\"$comment\": \"", "x", limit, too_large);
}

TEST(SceneKind, AFileThatIsTooLargeIsRefused) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("a.json"), "{\"objects\": []}");
    std::filesystem::resize_file(scratch.file("a.json"), uint64_t{1} << 40);  // all but the first bytes are holes
    EXPECT_ERROR(read_scene(scratch.file("a.json")), ExitCode::usage,
                 scratch.file("a.json") +
                     ": is larger than 64 MiB, which no scene may be; put large meshes into files "
                     "of their own, PLY or OBJ, and name these in \"objects\"");
    EXPECT_ERROR(read_scene("/dev/zero"), ExitCode::usage,
                 "/dev/zero: is binary data; expected JSON, which begins with '{', or the text input, which begins "
                 "with the number of frames");
}

TEST(SceneKind, DepthOfNestingIsLimited) {
    const auto nested = [](size_t levels) {
        return "{\"objects\": [], \"$comment\": [" + std::string(levels - 2, '[') + std::string(levels - 2, ']') + "]}";
    };
    EXPECT_ERROR(read_unnamed(nested(64)), ExitCode::usage,
                 "a: /$comment: expected a string or an array of strings, found an array of 1");
    for (const size_t levels : {size_t{65}, size_t{1000000}}) {
        std::string place = "a: /$comment";
        for (int i = 0; i < 63; ++i) place += "/0";
        EXPECT_ERROR(read_unnamed(nested(levels)), ExitCode::usage,
                     place + ": more than 64 levels deep; a scene has 6 at most");
    }
    std::string objects = "{";
    for (int i = 0; i < 100000; ++i) objects += "\"a\":{";
    EXPECT_THROW(read_unnamed(objects), Error);
}

TEST(SceneKind, LongNumbersNamesAndStringsMakeShortMessages) {
    const std::string digits(300000, '7'), name(300000, 'n');
    const std::string huge[] = {
        "{\"depth\": " + digits + ", \"objects\": []}",
        "{\"depth\": " + digits + "e-999999, \"objects\": []}",
        "{\"depth\": 0." + digits + ", \"objects\": []}",
        "{\"" + name + "\": 1}",
        "{\"" + name + "\": 1, \"" + name + "\": 1}",
        "{\"materials\": {\"" + name + "\": {\"index\": 0}}, \"objects\": []}",
        "{\"materials\": {\"" + name + "\": {}}, \"objects\": [{\"solid\": \"cube\", \"material\": \"x\"}]}",
        "{\"objects\": [{\"solid\": \"" + name + "\", \"material\": \"x\"}]}",
        "{\"objects\": [], \"$comment\": \"" + name + "\x01\"}",
        "{\"objects\": [], \"$comment\": " + name + "}",
        digits,
        "-0." + digits,
        "8 " + name + " " + name,
        "8 a.data " + name,
    };
    for (const std::string& text : huge) {
        try {
            read_unnamed(text);
            ADD_FAILURE() << text.substr(0, 40);
        } catch (const Error& error) {
            EXPECT_LT(std::string(error.what()).size(), 400u) << error.what();
        }
    }
}

TEST(SceneKind, ManyNamesTakeTimeInProportion) {
    std::string text = "{\"objects\": [], \"materials\": {";
    for (int i = 0; i < 50000; ++i) text += "\"m" + std::to_string(i) + "\": {},";
    text.back() = '}';
    EXPECT_EQ(read_unnamed(text + "}").materials.size(), 50000u);
}

}  // namespace
}  // namespace cistula
