// Files are whole or untouched, whatever goes wrong while they are written, and errors say what to do.
#include "base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "testing/support/expect_error.h"
#include "testing/support/file_size_limit.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST(AtomicFile, WritesAndReplaces) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.bin");
    write_file_atomically(path, "first");
    EXPECT_EQ(bytes_of(path), "first");
    const std::string binary("\0\xff\n\r", 4);
    write_file_atomically(path, binary);
    EXPECT_EQ(bytes_of(path), binary);
    write_file_atomically(path, "");
    EXPECT_EQ(bytes_of(path), "");
    EXPECT_EQ(scratch.names(), Names{"a.bin"});
}

TEST(AtomicFile, TemporariesAreHiddenAndUnique) {
    const ScratchDirectory scratch;
    const AtomicFile one(scratch.file("frame.exr")), two(scratch.file("frame.exr"));
    EXPECT_EQ(one.temporary(), ".frame.exr.0.part");
    EXPECT_EQ(two.temporary(), ".frame.exr.1.part");
    EXPECT_EQ(scratch.names().size(), 2u);
}

TEST(AtomicFile, OldFileStaysWithoutCommit) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt");
    put_bytes(path, "old");
    try {
        AtomicFile file(path);
        file.write("new");
        EXPECT_EQ(scratch.names().size(), 2u);
        throw std::runtime_error("something else failed");
    } catch (const std::runtime_error&) {
    }
    EXPECT_EQ(bytes_of(path), "old");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(AtomicFile, OthersMayWriteThroughTheDescriptor) {
    const ScratchDirectory scratch;
    AtomicFile file(scratch.file("a.txt"));
    ASSERT_EQ(write(file.descriptor(), "by a library", 12), 12);
    EXPECT_FALSE(fs::exists(scratch.file("a.txt")));
    file.commit();
    EXPECT_EQ(bytes_of(scratch.file("a.txt")), "by a library");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt"), link = scratch.file("link.txt");
    put_bytes(path, "old");
    ASSERT_EQ(chmod(path.c_str(), 0604), 0);
    fs::create_symlink("a.txt", link);
    write_file_atomically(link, "new");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(bytes_of(path), "new");
    EXPECT_EQ(static_cast<unsigned>(fs::status(path).permissions()), 0604u);
}

TEST(AtomicFile, SpecialBitsAreNotKept) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt");
    put_bytes(path, "old");
    ASSERT_EQ(chmod(path.c_str(), 07751), 0);
    write_file_atomically(path, "new");
    EXPECT_EQ(static_cast<unsigned>(fs::status(path).permissions()), 0751u);
}

TEST(AtomicFile, LinksThatLeadNowhereAreRefused) {
    const ScratchDirectory scratch;
    const std::string dangling = scratch.file("dangling"), loop = scratch.file("loop");
    fs::create_symlink("gone", dangling);
    fs::create_symlink("loop", loop);
    EXPECT_ERROR(write_file_atomically(dangling, "x"), ExitCode::file,
                 dangling +
                     ": cannot write: it is a symbolic link to a file that does not exist; remove the link or give "
                     "another name");
    EXPECT_ERROR(write_file_atomically(loop, "x"), ExitCode::file,
                 loop + ": cannot write: Too many levels of symbolic links");
    EXPECT_EQ(scratch.names(), (Names{"dangling", "loop"}));
}

TEST(AtomicFile, NamesMayBeAsLongAsTheFileSystemAllows) {
    const ScratchDirectory scratch;
    const std::string longest(255, 'n'), too_long(256, 'n');
    write_file_atomically(scratch.file(longest), "one");
    const AtomicFile other(scratch.file(longest));  // while another is written
    write_file_atomically(scratch.file(longest), "two");
    EXPECT_EQ(bytes_of(scratch.file(longest)), "two");
    EXPECT_ERROR(AtomicFile(scratch.file(too_long)), ExitCode::file,
                 scratch.file(too_long) + ": cannot write: File name too long; give a shorter name");
}

TEST(AtomicFile, OtherNamesOfAFileKeepTheOldContents) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt"), other = scratch.file("b.txt");
    put_bytes(path, "old");
    fs::create_hard_link(path, other);
    write_file_atomically(path, "new");
    EXPECT_EQ(bytes_of(path), "new");
    EXPECT_EQ(bytes_of(other), "old");
}

TEST(AtomicFile, WhatIsSwappedInMeanwhileIsNotFollowed) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt"), victim = scratch.file("victim");
    put_bytes(path, "old");
    put_bytes(victim, "kept");
    fs::create_directory(scratch.file("d"));
    AtomicFile file(path), inside(scratch.file("d/b.txt"));
    fs::remove(path);
    fs::create_symlink("victim", path);
    fs::rename(scratch.file("d"), scratch.file("e"));
    fs::create_symlink(".", scratch.file("d"));
    file.write("new");
    file.commit();
    inside.write("inside");
    inside.commit();
    EXPECT_FALSE(fs::is_symlink(path));
    EXPECT_EQ(bytes_of(path), "new");
    EXPECT_EQ(bytes_of(victim), "kept");
    EXPECT_EQ(bytes_of(scratch.file("e/b.txt")), "inside");
    EXPECT_FALSE(fs::exists(scratch.file("b.txt")));
}

TEST(AtomicFile, WhatDeadProcessesLeftIsRemovedByTheNextOfThatName) {
    const ScratchDirectory scratch;
    const auto exists = [&](const char* name) { return fs::exists(scratch.file(name)); };
    for (const char* name : {".a.exr.0.part", ".a.exr.1.part", ".a.exr.3.part", ".b.exr.0.part"})
        put_bytes(scratch.file(name), "half");
    const int locked = open(scratch.file(".a.exr.0.part").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(flock(locked, LOCK_EX), 0);
    write_file_atomically(scratch.file("a.exr"), "whole");
    EXPECT_TRUE(exists(".a.exr.0.part"));  // its writer lives
    EXPECT_FALSE(exists(".a.exr.1.part") || exists(".a.exr.3.part"));
    EXPECT_TRUE(exists(".b.exr.0.part"));
    close(locked);
    write_file_atomically(scratch.file("a.exr"), "whole");
    EXPECT_FALSE(exists(".a.exr.0.part"));
    EXPECT_EQ(bytes_of(scratch.file("a.exr")), "whole");
    // What is no regular file is passed over.
    fs::create_directory(scratch.file(".a.exr.0.part"));
    write_file_atomically(scratch.file("a.exr"), "again");
    EXPECT_EQ(bytes_of(scratch.file("a.exr")), "again");
}

TEST(AtomicFile, WhatDeadProcessesLeftIsRemovedWithoutWriting) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("a.exr"), "whole");
    fs::create_symlink("a.exr", scratch.file("link.exr"));
    for (const char* name : {".a.exr.1.part", ".a.exr.2.part", ".a.exr.9.part"}) put_bytes(scratch.file(name), "half");
    const AtomicFile living(scratch.file("b.exr"));
    const int locked = open(scratch.file(".a.exr.2.part").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(flock(locked, LOCK_EX), 0);
    AtomicFile::remove_stale(scratch.file("link.exr"));
    AtomicFile::remove_stale(scratch.file("b.exr"));
    close(locked);
    Names left = scratch.names();
    std::sort(left.begin(), left.end());
    EXPECT_EQ(left, (Names{".a.exr.2.part", ".b.exr.0.part", "a.exr", "link.exr"}));
    EXPECT_EQ(bytes_of(scratch.file("a.exr")), "whole");
}

TEST(AtomicFile, NewFilesObeyTheUmask) {
    const ScratchDirectory scratch;
    const mode_t old = umask(027);
    write_file_atomically(scratch.file("a.txt"), "x");
    umask(old);
    EXPECT_EQ(static_cast<unsigned>(fs::status(scratch.file("a.txt")).permissions()), 0640u);
}

TEST(AtomicFile, LongNames) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file(std::string(255, 'n'));
    write_file_atomically(path, "x");
    EXPECT_EQ(bytes_of(path), "x");
}

TEST(AtomicFile, Errors) {
    const ScratchDirectory scratch;
    const std::string missing = scratch.file("no/x.exr");
    EXPECT_ERROR(write_file_atomically(missing, "x"), ExitCode::file,
                 missing + ": cannot write: No such file or directory; create the directory " + scratch.file("no") +
                     " first, or give another");
    const std::string directory = scratch.file("directory");
    fs::create_directory(directory);
    EXPECT_ERROR(write_file_atomically(directory, "x"), ExitCode::file,
                 directory + ": cannot write: Is a directory; give the name of a file in it");
    EXPECT_ERROR(write_file_atomically(directory + "/", "x"), ExitCode::file,
                 directory + "/: cannot write: Is a directory; give the name of a file in it");
    put_bytes(scratch.file("file"), "x");
    EXPECT_ERROR(write_file_atomically(scratch.file("file/x"), "x"), ExitCode::file,
                 scratch.file("file/x") + ": cannot write: Not a directory; " + scratch.file("file") +
                     " is not a directory, give another");
    EXPECT_ERROR(write_file_atomically("", "x"), ExitCode::file,
                 ": cannot write: No such file or directory; give a file name");
    EXPECT_ERROR(write_file_atomically(scratch.file(std::string(256, 'n')), "x"), ExitCode::file,
                 scratch.file(std::string(256, 'n')) + ": cannot write: File name too long; give a shorter name");
}

TEST(AtomicFile, DevicesAreNotReplaced) {
    EXPECT_ERROR(write_file_atomically("/dev/null", "x"), ExitCode::file,
                 "/dev/null: cannot write: it is a device or a pipe; give the name of a regular file");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, FailedRenameLeavesNothing) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a");
    {
        AtomicFile file(path);
        fs::create_directory(path);
        EXPECT_ERROR(file.commit(), ExitCode::file,
                     path + ": cannot write: Is a directory; give the name of a file in it");
    }
    EXPECT_EQ(scratch.names(), Names{"a"});
}

TEST(AtomicFile, FullDiskLeavesTheOldFile) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.txt");
    put_bytes(path, "old");
    {
        const FileSizeLimit limit(1000);
        EXPECT_ERROR(write_file_atomically(path, std::string(5000, 'x')), ExitCode::file,
                     path +
                         ": cannot write: File too large; raise the limit on file sizes (ulimit -f), or give a place "
                         "on another disk");
    }
    EXPECT_EQ(bytes_of(path), "old");
    EXPECT_EQ(scratch.names(), Names{"a.txt"});
}

TEST(FileBytes, ReadsWholeFilesAndStarts) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a");
    std::string bytes;
    for (int i = 0; i < 1000003; ++i) bytes += static_cast<char>(i * 7 % 251);
    put_bytes(path, bytes);
    EXPECT_EQ(read_file(path), bytes);
    EXPECT_EQ(read_file_start(path, 5), bytes.substr(0, 5));
    put_bytes(path, "");
    EXPECT_EQ(read_file(path), "");
    EXPECT_ERROR(read_file(scratch.file("b")), ExitCode::file,
                 scratch.file("b") + ": cannot read: No such file or directory; check the spelling");
    EXPECT_ERROR(read_file(scratch.file("")), ExitCode::file,
                 scratch.file("") + ": cannot read: Is a directory; give the name of a file in it");
}

TEST(FileBytes, Extensions) {
    EXPECT_EQ(lower_extension("a.b/c.EXR"), ".exr");
    EXPECT_EQ(lower_extension("a.b/c"), "");
    EXPECT_EQ(file_error("p", "read", std::string("  two\n  lines. \n")).what(),
              std::string("p: cannot read: two lines"));
}

}  // namespace
}  // namespace cistula
