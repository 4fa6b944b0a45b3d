// Runs a built program as a user would and collects its output.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "testing/support/scratch_directory.h"

namespace cistula {

struct ProgramResult {
    int code = -1;  // exit code; 1000 + signal if a signal ended it
    std::string out, error;
};

/// Whether programs are built with the address sanitizer, which needs more memory for itself than limits leave.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool needs_all_memory = true;
#else
inline constexpr bool needs_all_memory = false;
#endif

/// A running program with a working directory and files for its three streams.
class RunningProgram {
  public:
    /// `prepare` runs in the child process before the program (for limits, signals).
    RunningProgram(
        const std::string& program, const std::vector<std::string>& arguments, const std::string& directory,
        const std::string& input = "", const std::function<void()>& prepare = [] {}) {
        put_bytes(streams_.file("in"), input);
        std::vector<char*> argv{const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        for (const char* stream : {"out", "error"}) put_bytes(streams_.file(stream), "");
        const std::string in = streams_.file("in"), out = streams_.file("out"), error = streams_.file("error");
        child_ = fork();
        if (child_ < 0) throw std::runtime_error("cannot fork");
        if (child_ == 0) {
            signal(SIGINT, SIG_DFL);  // a test that runs in the background of a shell inherits SIG_IGN
            signal(SIGTERM, SIG_DFL);
            signal(SIGHUP, SIG_DFL);
            signal(SIGPIPE, SIG_DFL);
            redirect(in, O_RDONLY, STDIN_FILENO);
            redirect(out, O_WRONLY | O_CREAT, STDOUT_FILENO);
            redirect(error, O_WRONLY | O_CREAT, STDERR_FILENO);
            if (chdir(directory.c_str()) != 0) _exit(126);
            prepare();
            execv(program.c_str(), argv.data());
            _exit(127);
        }
    }
    ~RunningProgram() {
        if (child_ > 0) {
            ::kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
    }
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    std::string output_so_far() const { return bytes_of(streams_.file("out")); }
    std::string error_so_far() const { return bytes_of(streams_.file("error")); }

    void send(int signal_number) const { ::kill(child_, signal_number); }

    ProgramResult wait() {
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = 0;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), bytes_of(streams_.file("out")),
                bytes_of(streams_.file("error"))};
    }

    /// Waits until `condition` holds; false if it does not within `seconds` or the program ends before.
    bool wait_until(const std::function<bool()>& condition, double seconds) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        while (!condition()) {
            siginfo_t state{};
            const bool ended =
                waitid(P_PID, static_cast<id_t>(child_), &state, WEXITED | WNOHANG | WNOWAIT) != 0 || state.si_pid != 0;
            if (ended || std::chrono::steady_clock::now() > end) return condition();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return true;
    }

  private:
    static void redirect(const std::string& path, int flags, int descriptor) {
        const int file = open(path.c_str(), flags, 0666);
        if (file < 0 || dup2(file, descriptor) < 0) _exit(125);
    }

    ScratchDirectory streams_;
    pid_t child_ = 0;
};

}  // namespace cistula
