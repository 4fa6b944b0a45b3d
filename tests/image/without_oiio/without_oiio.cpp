// What a build without OpenImageIO (CISTULA_WITH_OIIO=OFF) still reads and writes, and what it says about the rest. The
// program that reads pictures is that of such a build here, whichever this one is.
#include <gtest/gtest.h>

#include "image/exr/exr.h"
#include "image/picture/picture_io.h"
#include "image/picture/raw_picture.h"
#include "image/reader/picture_reader.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// What is said of the module that is not beside the program that reads pictures.
const std::string lack = " need the module libcistula_oiio.so, which is not in " CISTULA_MODULE_FOLDER
                         "; builds with OpenImageIO have it: `make build` installs and uses that";

TEST(WithoutOpenImageIO, OtherFormatsAreAClearError) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("x.png");
    const std::string message = path + ": cannot read: formats other than EXR and .data" + lack;
    put_bytes(path, "anything");
    EXPECT_ERROR(read_texture(path), ExitCode::file, message);
    EXPECT_EQ(bytes_of(path), "anything");
}

TEST(WithoutOpenImageIO, PicturesToCompareAreEXRs) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("x.png");
    write_preview(path, ColorPicture{1, 1, {{1, 0, 1}}});
    EXPECT_ERROR(StoredReader().read(path), ExitCode::file, path + ": cannot read: formats other than EXR" + lack);
    LayeredPicture layers;
    layers.width = layers.height = layers.display_width = layers.display_height = 1;
    layers.channels = {{"Y", true, {0.5f}}};
    write_exr(path, layers);
    EXPECT_EQ(StoredReader().read(path).pictures[0].channels[0].name, "Y");
}

TEST(WithoutOpenImageIO, PreviewsAreWritten) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("x.png");
    write_preview(path, ColorPicture{1, 1, {{1, 0, 1}}});
    EXPECT_EQ(bytes_of(path).substr(1, 3), "PNG");
}

TEST(WithoutOpenImageIO, DataAndExrAreRead) {
    const ScratchDirectory scratch;
    write_raw_picture(scratch.file("a.data"), ColorPicture{1, 1, {{1, 0, 1}}});
    EXPECT_EQ(read_texture(scratch.file("a.data")).texels, (std::vector<glm::vec3>{{1, 0, 1}}));
    LayeredPicture layers;
    layers.width = layers.height = layers.display_width = layers.display_height = 1;
    layers.channels = {{"Y", true, {0.5f}}};
    write_exr(scratch.file("a.exr"), layers);
    EXPECT_EQ(read_texture(scratch.file("a.exr")).texels, std::vector<glm::vec3>{glm::vec3(0.5f)});
}

}  // namespace
}  // namespace cistula
