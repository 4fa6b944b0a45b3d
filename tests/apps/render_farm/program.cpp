// `render-farm` from outside: its job by make, by Open Job Description and by Slurm, and what may happen to tasks.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <random>

#include <nlohmann/json.hpp>

#include "image/exr/exr.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

class RenderFarm : public RenderProgram {
  protected:
    static ProgramResult shell(const std::string& command, const std::string& directory) {
        return RunningProgram("/bin/sh", {"-c", command}, directory).wait();
    }
    ProgramResult shell(const std::string& command) const { return shell(command, file("")); }

    void write_job(Arguments arguments) const {
        arguments.insert(arguments.begin(), "s.json");
        const ProgramResult result = RunningProgram(CISTULA_BIN_DIR "/render-farm", arguments, file("")).wait();
        ASSERT_EQ(result.code, 0) << result.error;
    }
    void expect_refused_job(Arguments arguments, ExitCode code, const std::string& part) const {
        const ProgramResult result = RunningProgram(CISTULA_BIN_DIR "/render-farm", arguments, file("")).wait();
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error;
    }
    /// Renders the film in one run, to whole/.
    void render_whole(Arguments options) const {
        options.insert(options.begin(), {"s.json", "-q", "-o", "whole/f.##.exr"});
        expect_done(options);
    }
    /// Compares all files of whole/ with those of out/, and the manifest with these.
    void expect_whole() const {
        size_t files = 0;
        for (const auto& entry : std::filesystem::directory_iterator(file("whole"))) {
            const std::string name = entry.path().filename().string();
            ASSERT_TRUE(exists("out/" + name)) << name;
            EXPECT_EQ(bytes_of(file("whole/" + name)), bytes_of(file("out/" + name))) << name;
            ++files;
        }
        const ProgramResult manifest =
            shell("sha256sum -c --quiet farm/manifest.sha256 && wc -l <farm/manifest.sha256");
        EXPECT_EQ(manifest.code, 0) << manifest.error;
        EXPECT_EQ(std::stoul(manifest.out), files);
        EXPECT_EQ(shell("ls -A out | grep -c part").out, "0\n");
    }
    std::vector<std::string> tasks() const {
        std::vector<std::string> lines;
        std::istringstream text(bytes_of(file("farm/tasks.txt")));
        for (std::string line; std::getline(text, line);) lines.push_back(line);
        return lines;
    }
};

/// A process group that runs a task.
class TaskProcess {
  public:
    TaskProcess(const std::string& folder, size_t task) : process_(fork()) {
        if (process_ == 0) {
            setpgid(0, 0);
            const std::string command =
                fmt::format("cd '{}' && exec sh farm/task.sh {} -q >/dev/null 2>&1", folder, task);
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(127);
        }
        setpgid(process_, process_);
    }
    void kill() const { ::kill(-process_, SIGKILL); }
    /// The exit code; 1000 + signal if a signal ended it.
    int wait() const {
        int status = 0;
        waitpid(process_, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }

  private:
    pid_t process_;
};

/// Sixty tiles, each a task.
const Arguments sixty{"-f", "0-4", "--res", "200x120", "--supersample", "3", "--layers", "diffuse,cryptomatte"};

Arguments job_of_sixty() {
    Arguments arguments = sixty;
    arguments.insert(arguments.end(),
                     {"-o", "out/f.##.exr", "--tiles", "4x3", "--to", "farm", "--task-seconds", "0.001", "-q"});
    return arguments;
}

TEST_F(RenderFarm, KilledTasksCostNothingButThemselves) {
    render_whole(sixty);
    write_job(job_of_sixty());
    const size_t count = tasks().size();
    ASSERT_EQ(count, 60u);
    std::mt19937 random(40);
    std::vector<size_t> order(count);
    for (size_t i = 0; i < count; ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(TaskProcess(file(""), order[count - 1]).wait(), 0);
    const auto length = std::chrono::steady_clock::now() - start;
    int killed = 0;
    for (size_t i = 0; i < 40; ++i) {
        const TaskProcess task(file(""), order[i]);
        std::this_thread::sleep_for(length * std::uniform_real_distribution<>(0, 1)(random));
        task.kill();
        killed += task.wait() == 1000 + SIGKILL;
    }
    EXPECT_GE(killed, 10) << "too few were still at work";
    const ProgramResult made = shell("make -s -j 2 -f farm/Makefile");
    ASSERT_EQ(made.code, 0) << made.error;
    expect_whole();
}

TEST_F(RenderFarm, TwoWorkersOnATaskDoIt) {
    render_whole(sixty);
    write_job(job_of_sixty());
    for (size_t task = 0; task < 4; ++task) {
        const TaskProcess one(file(""), task), other(file(""), task);
        EXPECT_EQ(one.wait(), 0);
        EXPECT_EQ(other.wait(), 0);
    }
    ASSERT_EQ(shell("make -s -j 2 -f farm/Makefile").code, 0);
    expect_whole();
}

TEST_F(RenderFarm, AFullDiskFailsATaskAndLosesNothing) {
    render_whole({"-f", "0-1", "--res", "200x120"});
    write_job({"-f", "0-1", "--res", "200x120", "-o", "out/f.##.exr", "--to", "farm", "-q"});
    ASSERT_EQ(tasks().size(), 1u);
    // The first frame fits, the second does not. With room the same task goes on.
    const size_t room = std::filesystem::file_size(file("whole/f.00.exr")) * 3 / 2;
    const std::string drill = fmt::format(
        "mkdir -p out && mount -t tmpfs -o size={} none out || exit 77\n"
        "sh farm/task.sh 0 -q; echo $?; ls -A out; mount -o remount,size=64m out\n"
        "sh farm/task.sh 0 -q && sh farm/finish.sh && mkdir copy && cp out/* copy",
        room);
    put_bytes(file("drill.sh"), drill);
    const ProgramResult result = shell("unshare -rm sh drill.sh");
    if (result.code == 77 || result.error.find("unshare") != std::string::npos)
        GTEST_SKIP() << "no disk can be made here that gets full: " << result.error;
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(result.out, "3\nf.00.exr\n") << result.error;
    EXPECT_NE(result.error.find("No space left on device"), std::string::npos) << result.error;
    std::filesystem::remove(file("out"));
    std::filesystem::rename(file("copy"), file("out"));
    expect_whole();
}

TEST_F(RenderFarm, AWorkerOfAnotherVersionIsRefusedAndRepeated) {
    const Arguments film{"-f", "0", "--res", "80x48"};
    render_whole(film);
    write_job({"-f", "0", "--res", "80x48", "-o", "out/f.##.exr", "--to", "farm", "--tiles", "2x2", "-q"});
    const size_t count = tasks().size();
    for (size_t task = 0; task < count; ++task) ASSERT_EQ(TaskProcess(file(""), task).wait(), 0);
    std::vector<PicturePart> parts = read_exr_parts(file("out/f.tile2.00.exr"));
    parts[0].picture.attributes["cistula:version"] = std::string("0.0.9");
    write_exr(file("out/f.tile2.00.exr"), parts);
    const ProgramResult refused = shell("sh farm/finish.sh");
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.error.find("out/f.tile2.00.exr: cistula:version is '0.0.9'"), std::string::npos) << refused.error;
    EXPECT_FALSE(exists("out/f.00.exr") || exists("farm/manifest.sha256"));
    ASSERT_EQ(shell("make -s -f farm/Makefile").code, 0);
    expect_whole();
}

TEST_F(RenderFarm, AFinishWithoutItsTasksSaysWhatIsMissing) {
    write_job(job_of_sixty());
    ASSERT_EQ(TaskProcess(file(""), 0).wait(), 0);
    const ProgramResult result = shell("sh farm/finish.sh");
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.error.find("of its 12 tiles are missing"), std::string::npos) << result.error;
    EXPECT_EQ(shell("sh farm/task.sh 60").code, 2);
}

TEST_F(RenderFarm, NamesWithBlanksAndQuotes) {
    std::filesystem::rename(file("s.json"), file("it's a scene.json"));
    const ProgramResult result =
        RunningProgram(CISTULA_BIN_DIR "/render-farm",
                       {"it's a scene.json", "-o", "my out/f #.exr", "-f", "0-1", "--to", "my farm", "-q"}, file(""))
            .wait();
    ASSERT_EQ(result.code, 0) << result.error;
    const ProgramResult made = shell("make -s -j 2 -f 'my farm/Makefile'");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_TRUE(exists("my out/f 0.exr") && exists("my out/f 1.exr"));
    EXPECT_EQ(shell("sha256sum -c --quiet 'my farm/manifest.sha256'").code, 0);
}

TEST_F(RenderFarm, RefusesInOneLine) {
    expect_refused_job({}, ExitCode::usage, "no scene is given");
    expect_refused_job({"-", "-o", "a.exr"}, ExitCode::usage, "every task reads the scene");
    expect_refused_job({"s.json", "-o", "a.out"}, ExitCode::usage, "name it *.exr");
    expect_refused_job({"s.json", "-o", "a.exr", "--resume"}, ExitCode::usage, "--resume: is of a run of render");
    expect_refused_job({"s.json", "-o", "a.#.exr", "--preview", "p.png"}, ExitCode::usage, "put #### into the name");
    expect_refused_job({"s.json", "-o", "a.exr", "--tiles", "50x1"}, ExitCode::usage, "more than there are pixels");
    expect_refused_job({"none.json", "-o", "a.exr"}, ExitCode::file, "none.json");
    expect_refused_job({"s.json", "-o", "a.exr", "--to", "s.json"}, ExitCode::file, "s.json");
    EXPECT_FALSE(exists("s.farm"));
}

TEST_F(RenderFarm, OpenJobDescriptionRunsTheJob) {
    const char* given = std::getenv("CISTULA_OPENJD");
    const std::string openjd = given ? given : "openjd";
    if (shell("command -v " + openjd).code != 0)
        GTEST_SKIP() << "openjd is not installed (PyPI: openjd-cli), and CISTULA_OPENJD does not name it";
    const Arguments film{"-f", "0-1", "--res", "80x48", "--layers", "Z"};
    render_whole(film);
    Arguments arguments = film;
    arguments.insert(arguments.end(), {"-o", "out/f.##.exr", "--tiles", "2x1", "--to", "farm", "-q"});
    write_job(arguments);
    const ProgramResult check = shell(openjd + " check farm/job.openjd.json");
    ASSERT_EQ(check.code, 0) << check.out << check.error;
    const ProgramResult result = shell(openjd + " run farm/job.openjd.json");
    EXPECT_EQ(result.code, 0) << result.out << result.error;
    EXPECT_NE(result.out.find("openjd_progress: 100.00"), std::string::npos) << result.out;
    expect_whole();
}

TEST_F(RenderFarm, SlurmRunsTheJob) {
    const Arguments film{"-f", "0-1", "--res", "80x48", "--layers", "Z"};
    render_whole(film);
    Arguments arguments = film;
    arguments.insert(arguments.end(), {"-o", "out/f.##.exr", "--tiles", "2x1", "--to", "farm", "-q"});
    write_job(arguments);
    put_bytes(file("wait.sh"),
              "sh farm/submit.sh || exit 1\n"
              "for i in $(seq 300); do [ -z \"$(squeue -h)\" ] && exit 0; sleep 0.2; done; squeue; exit 1\n");
    const ProgramResult result =
        shell("bash " CISTULA_SOURCE_DIR "/tests/apps/render_farm/slurm.sh \"$PWD/slurm\" sh wait.sh");
    if (result.code == 77) GTEST_SKIP() << result.error;
    ASSERT_EQ(result.code, 0) << result.out << result.error;
    ASSERT_TRUE(exists("farm/manifest.sha256")) << bytes_of(file("farm/finish.log"));
    EXPECT_TRUE(exists("farm/task-0.log"));
    expect_whole();
}

}  // namespace
}  // namespace cistula
