// The hash of a picture: a value worked out by another implementation, and what it depends on.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "image/exr/exr.h"
#include "image/picture/picture_hash.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// 2 x 1 pixels at (5, 7) of 20 x 10, of a float and a half.
LayeredPicture float_and_half() {
    LayeredPicture picture;
    picture.width = 2;
    picture.height = 1;
    picture.x = 5;
    picture.y = 7;
    picture.display_width = 20;
    picture.display_height = 10;
    picture.channels = {{"a.Z", true, {0.333f, 65504}}, {"R", false, {0.1f, -0.0f}}};
    round_to_stored(picture);
    return picture;
}

TEST(PictureHash, IsThatOfAnotherImplementation) {
    EXPECT_EQ(picture_hash(float_and_half()), "d654b8f5f7c870e4cf2bd71dd713113f");
}

TEST(PictureHash, TellsApartWhatFilesStore) {
    std::set<std::string> hashes = {picture_hash(float_and_half())};
    const std::function<void(LayeredPicture&)> changes[] = {
        [](LayeredPicture& p) { p.x = 6; },
        [](LayeredPicture& p) { p.y = 6; },
        [](LayeredPicture& p) { std::swap(p.width, p.height); },
        [](LayeredPicture& p) { p.display_width = 21; },
        [](LayeredPicture& p) { p.display_height = 11; },
        [](LayeredPicture& p) { p.channels[1].values[1] = 0.0f; },
        [](LayeredPicture& p) { std::swap(p.channels[1].values[0], p.channels[1].values[1]); },
        [](LayeredPicture& p) { p.channels[0].name = "b.Z"; },
        [](LayeredPicture& p) { p.channels[0].half = false; },
        [](LayeredPicture& p) { p.channels.pop_back(); },
    };
    for (const auto& change : changes) {
        LayeredPicture picture = float_and_half();
        change(picture);
        hashes.insert(picture_hash(picture));
    }
    EXPECT_EQ(hashes.size(), 1 + std::size(changes));
}

TEST(PictureHash, IsThatOfTheFileWhateverItsHeaderAndCompression) {
    const ScratchDirectory folder;
    LayeredPicture picture = float_and_half();
    const std::string hash = picture_hash(picture);
    std::swap(picture.channels[0], picture.channels[1]);
    EXPECT_EQ(picture_hash(picture), hash);
    picture.attributes["comments"] = std::string("rendered on Friday");
    for (const Compression compression : {Compression::none, Compression::zip, Compression::piz}) {
        picture.compression = compression;
        write_exr(folder.file("a.exr"), picture);
        EXPECT_EQ(picture_hash(read_exr(folder.file("a.exr"))), hash);
    }
}

TEST(PictureHash, RoundedPicturesHaveTheBitsOfTheirFiles) {
    const ScratchDirectory folder;
    LayeredPicture picture = float_and_half();
    picture.channels[0].values = {0.3333f, 2049.0f / 2048};  // the second lies between two halves
    write_exr(folder.file("a.exr"), picture);
    EXPECT_NE(read_exr(folder.file("a.exr")).channels[1].values, picture.channels[0].values);
    round_to_stored(picture);
    EXPECT_EQ(read_exr(folder.file("a.exr")).channels[1].values, picture.channels[0].values);
    EXPECT_EQ(picture.channels[0].values[1], 1.0f);
    EXPECT_EQ(picture.channels[1].values[0], 0.1f);
}

}  // namespace
}  // namespace cistula
