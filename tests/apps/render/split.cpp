// --split: the layers of a frame in parts or files of their own hold what one part holds.
#include "render/record/split_picture.h"

#include <map>

#include "image/exr/exr.h"
#include "testing/support/expect_error.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderSplit : public RenderProgram {
  protected:
    Arguments film(const std::string& name, const std::string& split) const {
        return {"s.json",  "-o",  name,      "-f", "0,2", "--layers", "path,light,data,cryptomatte",
                "--split", split, "--resume"};
    }

    static std::vector<std::string> channels_of(const LayeredPicture& picture) {
        std::vector<std::string> names;
        for (const LayeredPicture::Channel& channel : picture.channels) names.push_back(channel.name);
        return names;
    }

    /// The values of all parts, by the names that they have in a file of one part.
    using Values = std::map<std::string, std::vector<float>>;
    static void add(const LayeredPicture& picture, const std::string& layer, Values& values) {
        for (const LayeredPicture::Channel& channel : picture.channels) {
            const bool plain = !layer.empty() && std::string("RGB").find(channel.name) != std::string::npos;
            EXPECT_TRUE(values.emplace(plain ? layer + '.' + channel.name : channel.name, channel.values).second)
                << layer << ' ' << channel.name;
        }
    }
    Values values_of(const std::string& name) const {
        Values values;
        for (const PicturePart& part : read_exr_parts(file(name))) add(part.picture, "", values);
        return values;
    }

    void expect_resumed(const std::string& name, const std::string& split, const std::string& frames) {
        const ProgramResult result = run(film(name, split));
        EXPECT_EQ(result.code, 0) << result.error;
        EXPECT_NE(result.error.find(frames + " of 2 frames are complete"), std::string::npos) << result.error;
    }
};

TEST_F(RenderSplit, PartsHoldWhatOneHolds) {
    expect_done(film("one.##.exr", "none"));
    expect_done(film("parts.##.exr", "parts"));
    EXPECT_EQ(values_of("parts.02.exr"), values_of("one.02.exr"));

    const LayeredPicture one = read_exr(file("one.02.exr"));
    const std::vector<PicturePart> parts = read_exr_parts(file("parts.02.exr"));
    EXPECT_EQ(parts.front().name, "Combined");
    EXPECT_EQ(channels_of(parts.front().picture), (std::vector<std::string>{"A", "B", "G", "R"}));
    size_t mattes = 0;
    for (const PicturePart& part : parts) {
        LayeredPicture rest = one;
        const bool is_matte = part.name.starts_with("Crypto");
        mattes += is_matte;
        for (auto known = rest.attributes.begin(); known != rest.attributes.end();)
            known = known->first.starts_with("cryptomatte/") ? rest.attributes.erase(known) : std::next(known);
        const size_t own = part.name == main_part ? 3 * 4 : is_matte ? 4 : 0;  // Blender looks in the first
        EXPECT_EQ(part.picture.attributes.size(), rest.attributes.size() + own) << part.name;
        const std::vector<std::string> channels = channels_of(part.picture);
        const bool is_color = part.name == main_part || channels.back() == part.name + ".R";
        for (const auto& [name, value] : part.picture.attributes)
            if (name == "colorInteropID" && !is_color)
                EXPECT_EQ(std::get<std::string>(value), "data") << part.name;
            else
                EXPECT_EQ(one.attributes.at(name), value) << name;
        for (const std::string& channel : channels)
            EXPECT_TRUE(part.name == main_part || channel == part.name || channel.starts_with(part.name + '.'))
                << part.name << ' ' << channel;
    }
    EXPECT_EQ(mattes, 3u * 3u);

    expect_resumed("parts.##.exr", "parts", "2");
    const std::string whole = bytes_of(file("parts.02.exr"));
    put_bytes(file("parts.02.exr"), whole.substr(0, whole.size() - 1));
    expect_resumed("parts.##.exr", "parts", "1");
    EXPECT_EQ(bytes_of(file("parts.02.exr")), whole);
    EXPECT_ERROR(read_exr(file("parts.02.exr")), ExitCode::file,
                 file("parts.02.exr") + ": cannot read: it has " + std::to_string(parts.size()) +
                     " parts; give a file of one part");
}

TEST_F(RenderSplit, FilesHoldWhatOneHolds) {
    expect_done(film("one.##.exr", "none"));
    expect_done(film("d/files.##.exr", "files"));
    Values values;
    for (const auto& entry : std::filesystem::directory_iterator(file("d"))) {
        const std::string name = entry.path().filename().string(), end = ".02.exr";
        ASSERT_TRUE(name.starts_with("files.") && name.ends_with(".exr")) << name;
        if (!name.ends_with(end)) continue;
        const bool main = name == "files.02.exr";
        add(read_exr(entry.path().string()), main ? "" : name.substr(6, name.size() - 6 - end.size()), values);
    }
    EXPECT_EQ(values, values_of("one.02.exr"));

    expect_resumed("d/files.##.exr", "files", "2");
    std::filesystem::remove(file("d/files.diffuse.02.exr"));
    expect_resumed("d/files.##.exr", "files", "1");
    EXPECT_TRUE(exists("d/files.diffuse.02.exr"));
    // Layers that lie elsewhere are not those that are asked for.
    const ProgramResult result = run(film("d/files.##.exr", "parts"));
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(result.error.find("are complete"), std::string::npos) << result.error;
    EXPECT_EQ(values_of("d/files.02.exr"), values);
}

/// Files that hold no colors claim no color space, and only those that are ACES containers say that they are.
TEST_F(RenderSplit, FilesSayWhatTheyHold) {
    const Arguments aces = {"s.json",        "-q",   "--layers",     "N,diffuse",    "--bits", "half",
                            "--compression", "none", "--colorspace", "lin_ap0_scene"};
    const auto with = [&](const Arguments& more) {
        Arguments all = aces;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const auto attributes = [&](const std::string& name) { return read_exr(file(name)).attributes; };
    expect_done(with({"-o", "a.exr", "--split", "files"}));
    EXPECT_EQ(std::get<std::string>(attributes("a.N.exr").at("colorInteropID")), "data");
    EXPECT_EQ(attributes("a.N.exr").count("chromaticities"), 0u);
    EXPECT_EQ(attributes("a.N.exr").count("acesImageContainerFlag"), 0u);
    for (const char* name : {"a.exr", "a.diffuse.exr"}) {
        EXPECT_EQ(std::get<std::string>(attributes(name).at("colorInteropID")), "lin_ap0_scene") << name;
        EXPECT_EQ(attributes(name).count("acesImageContainerFlag"), 1u) << name;
    }
    expect_done(with({"-o", "one.exr"}));
    EXPECT_EQ(attributes("one.exr").count("acesImageContainerFlag"), 0u);
    expect_done(with({"-o", "parts.exr", "--split", "parts"}));
    for (const PicturePart& part : read_exr_parts(file("parts.exr")))
        EXPECT_EQ(part.picture.attributes.count("acesImageContainerFlag"), 0u) << part.name;
}

TEST_F(RenderSplit, WhatHasNoLayersIsNotSplit) {
    expect_refused({"s.json", "-o", "a.exr", "--split", "parts"}, ExitCode::usage, "--split parts: is for --layers");
    expect_refused({"s.json", "-o", "a.exr", "--layers", "Z", "--split", "part"}, ExitCode::usage,
                   "--split part: must be none or parts or files; did you mean 'parts'?");
    // Layers without a dot in their names belong to the beauty.
    expect_done({"s.json", "-q", "-o", "a.exr", "--layers", "Z,id", "--split", "files"});
    expect_done({"s.json", "-q", "-o", "b.exr", "--layers", "Z,id"});
    EXPECT_EQ(bytes_of(file("a.exr")), bytes_of(file("b.exr")));
}

TEST_F(RenderSplit, NoLayersFileIsAnother) {
    std::filesystem::copy_file(file("s.json"), file("a.N.exr"));
    expect_refused({"a.N.exr", "-o", "a.exr", "--layers", "N", "--split", "files"}, ExitCode::usage,
                   "a.N.exr: would be both the scene and a layer's image; give each a file of its own");
    std::filesystem::remove(file("a.N.exr"));
    std::filesystem::create_directory(file("a.N.exr"));
    const ProgramResult result = run({"s.json", "-o", "a.exr", "--layers", "N", "--split", "files"});
    EXPECT_EQ(result.code, 3) << result.error;
    EXPECT_NE(result.error.find("a.N.exr"), std::string::npos) << result.error;
    EXPECT_FALSE(exists("a.exr"));
}

}  // namespace
}  // namespace cistula
