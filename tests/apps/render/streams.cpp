// Standard streams that are closed, full or broken: images do not notice.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderStreams : public RenderProgram {
  protected:
    ProgramResult run_with(const Arguments& arguments, const std::function<void()>& prepare) const {
        return RunningProgram(program_, arguments, file(""), "", prepare).wait();
    }
};

TEST_F(RenderStreams, ClosedStreamsLeaveTheImageAsItIs) {
    const Arguments arguments{"s.json", "-o", "a.exr", "--preview", "a.png", "--progress", "plain"};
    ASSERT_EQ(run(arguments).code, 0);
    const std::string image = bytes_of(file("a.exr")), preview = bytes_of(file("a.png"));
    for (int closed = 1; closed < 8; ++closed) {
        std::filesystem::remove(file("a.exr"));
        std::filesystem::remove(file("a.png"));
        const ProgramResult result = run_with(arguments, [closed] {
            for (int stream = 0; stream < 3; ++stream)
                if ((closed >> stream & 1) != 0) close(stream);
        });
        EXPECT_EQ(result.code, 0) << closed;
        EXPECT_EQ(bytes_of(file("a.exr")), image) << closed;
        EXPECT_EQ(bytes_of(file("a.png")), preview) << closed;
    }
}

TEST_F(RenderStreams, AnErrorStreamThatCannotBeWrittenChangesNothing) {
    const Arguments arguments{"s.json", "-v", "-o", "a.exr", "--progress", "plain"};
    ASSERT_EQ(run(arguments).code, 0);
    const std::string image = bytes_of(file("a.exr"));
    const auto full = [] { dup2(open("/dev/full", O_WRONLY), STDERR_FILENO); };
    const auto broken = [] {
        int ends[2];
        if (pipe(ends) != 0) _exit(125);
        close(ends[0]);
        dup2(ends[1], STDERR_FILENO);
    };
    for (const std::function<void()>& prepare : {std::function<void()>(full), std::function<void()>(broken)}) {
        std::filesystem::remove(file("a.exr"));
        EXPECT_EQ(run_with(arguments, prepare).code, 0);
        EXPECT_EQ(bytes_of(file("a.exr")), image);
    }
}

TEST_F(RenderStreams, OutputThatIsTheResultIsAnErrorWhereItCannotBeWritten) {
    const auto full = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
    EXPECT_EQ(run_with({"s.json", "--explain"}, full).code, static_cast<int>(ExitCode::file));
    EXPECT_EQ(run_with({"--version"}, full).code, static_cast<int>(ExitCode::file));
    for (const int closed : {1, 3, 6}) {  // bits of streams
        const ProgramResult result = run_with({"--version"}, [closed] {
            for (int stream = 0; stream < 3; ++stream)
                if ((closed >> stream & 1) != 0) close(stream);
        });
        EXPECT_EQ(result.code, closed == 1 ? 0 : static_cast<int>(ExitCode::file)) << closed;
        if (closed == 3) {
            EXPECT_EQ(result.error, "render: standard output: cannot write: Bad file descriptor\n");
        }
    }
}

TEST_F(RenderStreams, APipeInTheOutputsPlaceIsRefusedAtOnce) {
    ASSERT_EQ(mkfifo(file("a.exr").c_str(), 0600), 0);
    for (const bool resume : {false, true}) {
        Arguments arguments{"s.json", "-q", "-o", "a.exr"};
        if (resume) arguments.push_back("--resume");
        expect_refused(arguments, ExitCode::file, "a.exr: cannot write: it is a device or a pipe");
    }
    EXPECT_TRUE(std::filesystem::is_fifo(file("a.exr")));
    EXPECT_FALSE(has_part_files());
}

}  // namespace
}  // namespace cistula
