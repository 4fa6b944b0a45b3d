#include "compare/metrics/command.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

#include "base/file_bytes.h"

namespace cistula {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() : path_((fs::temp_directory_path() / "render-compare-XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw file_error(path_, "write", errno);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::optional<CommandEnd> run_command(std::vector<std::string> words, const std::string& folder,
                                      const TemporaryFolder& temporary, StopSignal stop) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string output = temporary.file("said");
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
    posix_spawnattr_t attributes;  // a group of its own, so that what it starts can be ended, too
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t child = -1;
    const int failure = posix_spawnp(&child, pointers[0], &files, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) return std::nullopt;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {  // a signal does not end a wait
        if (stop.is_given()) kill(-child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (stop.is_given())
        throw Error(ErrorKind::interrupted, "interrupted while " + words[0] + " runs; nothing was written");
    return CommandEnd{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(output)};
}

}  // namespace cistula
