// Textures are read within limits, in a child process; whatever becomes of that, this process has an error of one line.
#include "image/reader/picture_reader.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <new>
#include <thread>

#include "image/exr/exr.h"
#include "image/picture/raw_picture.h"
#include "testing/support/expect_error.h"
#include "testing/support/run_program.h"
#include "testing/support/scratch_directory.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

void write_exr_texture(const std::string& path, int width, int height, float value) {
    LayeredPicture layers;
    layers.width = layers.display_width = width;
    layers.height = layers.display_height = height;
    const std::vector<float> values(static_cast<size_t>(width) * static_cast<size_t>(height), value);
    for (const char* name : {"R", "G", "B"}) layers.channels.push_back({name, false, values});
    write_exr(path, layers);
}

/// The child process of this thread; 0 if there is none.
pid_t child_of_this_thread() {
    std::ifstream list("/proc/self/task/" + std::to_string(syscall(SYS_gettid)) + "/children");
    pid_t child = 0;
    list >> child;
    return child;
}

std::string message_of(TextureReader& reader, const std::string& path) {
    try {
        reader.read(path, nullptr);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
        return error.what();
    }
    return "no error";
}

TEST(TextureReader, TheLimitCountsAllTexturesAndIsSeenInTheHeader) {
    const ScratchDirectory scratch;
    const std::string exr = scratch.file("a.exr"), data = scratch.file("a.data");
    write_exr_texture(exr, 10, 10, 0.5f);
    write_raw_picture(data, {10, 10, std::vector<glm::vec3>(100)});
    for (const std::string& first : {exr, data})
        for (const std::string& second : {exr, data}) {
            TextureReader enough({2400, 60}), reader({2399, 60});
            EXPECT_EQ(message_of(enough, first), "no error");
            EXPECT_EQ(message_of(enough, second), "no error");
            EXPECT_EQ(message_of(reader, first), "no error");
            EXPECT_EQ(message_of(reader, second),
                      second +
                          ": cannot read: its size is 10x10, which takes 1.2e-06 GB of memory; textures may take "
                          "2.399e-06 GB, and others take 1.2e-06 GB; give a smaller one, or raise the limit "
                          "(`max_texture_gb` of render)");
        }

    std::string bytes = bytes_of(exr);
    for (const char* name : {"dataWindow", "displayWindow"}) {
        const size_t box = bytes.find(std::string("box2i"), bytes.find(name)) + 6 + 4;  // type, zero, size
        for (const size_t corner : {box + 8, box + 12}) bytes.replace(corner, 4, std::string("\x5f\xea\0\0", 4));
    }
    put_bytes(exr, bytes + std::string(100'000, '\0'));  // room for the table of chunks
    TextureReader reader({1'000'000'000, 60});
    EXPECT_EQ(message_of(reader, exr),
              exr +
                  ": cannot read: its size is 60000x60000, which takes 43.2 GB of memory; textures may take 1 GB; give "
                  "a smaller one, or raise the limit (`max_texture_gb` of render)");
}

TEST(TextureReader, OnlyFilesAreRead) {
    const ScratchDirectory scratch;
    TextureReader reader;
    for (const char* extension : {".png", ".exr", ".data", ".dds"}) {
        const std::string pipe = scratch.file(std::string("pipe") + extension),
                          device = scratch.file(std::string("device") + extension),
                          folder = scratch.file(std::string("folder") + extension),
                          nothing = scratch.file(std::string("nothing") + extension),
                          empty = scratch.file(std::string("empty") + extension);
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        std::filesystem::create_symlink("/dev/zero", device);
        std::filesystem::create_directory(folder);
        put_bytes(empty, "");
        for (const std::string& path : {pipe, device})
            EXPECT_EQ(message_of(reader, path),
                      path + ": cannot read: it is a pipe, a socket or a device; give a file");
        EXPECT_EQ(message_of(reader, folder), folder + ": cannot read: Is a directory; give the name of a file in it");
        EXPECT_EQ(message_of(reader, nothing),
                  nothing + ": cannot read: No such file or directory; check the spelling");
        EXPECT_EQ(message_of(reader, empty), empty + ": cannot read: it is empty; give a picture");
    }
    EXPECT_EQ(child_of_this_thread(), 0) << "none of these needs a decoder";
}

TEST(TextureReader, ValuesThatAreNoRadianceAreClampedAndCounted) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    using test::infinity, test::nan;
    LayeredPicture layers;
    layers.width = layers.display_width = layers.height = layers.display_height = 2;
    layers.channels = {{"R", false, {0, -0.0f, infinity, 3}},
                       {"G", false, {1, -infinity, 2, -0.5f}},
                       {"B", false, {5.5f, nan, infinity, 1}}};
    write_exr(path, layers);
    ClampedTexels clamped;
    const ColorPicture picture = TextureReader().read(path, &clamped);
    EXPECT_EQ(picture.texels, (std::vector<glm::vec3>{{0, 1, 5.5f}, {-0.0f, 0, 0}, {5.5f, 2, 5.5f}, {3, 0, 1}}));
    EXPECT_EQ(
        clamped.warning(),
        "values of its texels that are no radiance: 2 negative (taken as 0), 1 not a number (taken as 0), 2 infinite "
        "(taken as 5.5), of 12; the first one is at (1, 0); \"strict\": true refuses them");
    EXPECT_ERROR(TextureReader().read(path, nullptr), ExitCode::file,
                 path + ": texel (1, 0) has G = -inf, and so 5 of 12 values; texels are finite and not negative");

    // Infinity alone is 1; what needs nothing is not counted.
    for (auto& channel : layers.channels) channel.values = {infinity, 0, -1, 0};
    write_exr(path, layers);
    EXPECT_EQ(TextureReader().read(path, &clamped).texels,
              (std::vector<glm::vec3>{glm::vec3(1), glm::vec3(0), glm::vec3(0), glm::vec3(0)}));
    write_exr_texture(path, 2, 2, 0);
    TextureReader().read(path, &clamped);
    EXPECT_EQ(clamped.count(), 0u);
}

TEST(TextureReader, AChildThatEndsOrHangsIsAnErrorAndTheNextOneWorks) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr"), start = path + ": cannot read: ";
    write_exr_texture(path, 3, 2, 0.5f);
    TextureReader reader({1'000'000, 1});
    const auto after = [&](int number) {
        EXPECT_EQ(message_of(reader, path), "no error");
        const pid_t child = child_of_this_thread();
        EXPECT_GT(child, 0);
        EXPECT_EQ(kill(child, number), 0);
        return message_of(reader, path);
    };
    EXPECT_EQ(after(SIGABRT), start + "its decoder was ended by signal 6 (Aborted); the file is damaged");
    EXPECT_EQ(after(SIGXCPU), start + "decoding it takes more processor time than is allowed; the file is damaged");
    EXPECT_EQ(after(SIGSTOP), start + "decoding it takes more time than is allowed; the file is damaged");
    EXPECT_EQ(message_of(reader, path), "no error");
}

TEST(TextureReader, MemoryThatAChildWasNotAllowedIsNoDamage) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory for itself";
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr"), large = scratch.file("b.exr");
    write_exr_texture(path, 3, 2, 0.5f);
    write_exr_texture(large, 2000, 1000, 0.5f);
    TextureReader reader;
    EXPECT_EQ(message_of(reader, path), "no error");
    const pid_t child = child_of_this_thread();
    rlim_t pages = 0;
    std::ifstream("/proc/" + std::to_string(child) + "/statm") >> pages;
    const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (8 << 20);
    const rlimit limit{bytes, bytes};
    ASSERT_EQ(prlimit(child, RLIMIT_AS, &limit, nullptr), 0);
    EXPECT_THROW(reader.read(large, nullptr), std::bad_alloc);
    EXPECT_EQ(message_of(reader, large), "no error");
}

TEST(TextureReader, LeavesNoProcessAndNoDescriptor) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.exr");
    write_exr_texture(path, 3, 2, 0.5f);
    const auto descriptors = [] {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
        return count;
    };
    const size_t before = descriptors();
    for (int i = 0; i < 3; ++i) {
        TextureReader reader;
        EXPECT_EQ(message_of(reader, path), "no error");
        EXPECT_NE(child_of_this_thread(), 0);
    }
    EXPECT_EQ(child_of_this_thread(), 0);
    EXPECT_EQ(descriptors(), before);
    // Two threads read at once, each by a child of its own.
    std::thread other([&] { EXPECT_EQ(TextureReader().read(path, nullptr).texels.size(), 6u); });
    EXPECT_EQ(TextureReader().read(path, nullptr).texels.size(), 6u);
    other.join();
}

TEST(TextureLimits, Texts) {
    EXPECT_EQ(texture_size_problem(65536, 1, 65536 * 12, 65536 * 12), "");
    EXPECT_EQ(texture_size_problem(65537, 1, no_texture_limit, no_texture_limit),
              "its size is 65537x1; width and height of a texture are 1 to 65536");
    EXPECT_EQ(texture_size_problem(5, -1, no_texture_limit, no_texture_limit),
              "its size is 5x-1; width and height of a texture are 1 to 65536");
    EXPECT_EQ(gigabytes(6'318'999'999), "6.319 GB");
    EXPECT_EQ(seconds_for(20, 1'000'000'000), 40);
    EXPECT_GT(default_texture_bytes(), 1'000'000u);
}

}  // namespace
}  // namespace cistula
