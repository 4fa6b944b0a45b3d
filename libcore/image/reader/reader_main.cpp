// cistula-read-picture: reads pictures for another process, which starts it (reader_process.h), each by a fork of its
// own, so that a picture that makes a library crash or take memory or time without end harms nothing else.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "base/machine.h"
#include "image/color/stated_colors.h"
#include "image/exr/exr.h"
#include "image/reader/reader_answer.h"
#include "image/reader/texture_limits.h"

namespace cistula {
namespace {

/// Answers by the module for OpenImageIO.
void answer_oiio(const std::string& path, Answer& answer, const OiioModule& oiio) {
    const OiioHost host = {
        &answer,
        answer.is_texture(),
        answer.left(),
        [](void* self, const OiioPicture* picture) noexcept { return static_cast<Answer*>(self)->picture(*picture); },
        [](void* self, const void* bytes, size_t count) noexcept {
            static_cast<const Answer*>(self)->profile({static_cast<const char*>(bytes), count});
        },
        [](void* self, const char* name, const char* type, const char* text) noexcept {
            static_cast<const Answer*>(self)->attribute(name, type, text);
        },
        [](void* self, const void* from, size_t texels) noexcept {
            static_cast<const Answer*>(self)->samples(from, texels);
        },
        [](void* self, const char* reason) noexcept { static_cast<const Answer*>(self)->fail(reason); }};
    if (oiio.read(path.c_str(), &host)) answer.end();
}

void answer_exr(const std::string& path, Answer& answer) {
    ColorPicture picture;
    FileColors colors;
    try {
        picture = read_exr_texture(
            path, [&](int64_t width, int64_t height) { return answer.size_problem(width, height, texel_bytes); },
            &colors);
    } catch (const std::bad_alloc&) {
        errno = ENOMEM;
        return answer.fail("decoding it takes more memory than is allowed");
    } catch (const std::exception& error) {
        const std::string_view message = error.what();
        const std::string before = path + ": cannot read: ";  // which the other process says, too
        return answer.fail(std::string(message.starts_with(before) ? message.substr(before.size()) : message));
    }
    const char* const names[] = {"R", "G", "B"};
    const auto width = static_cast<int32_t>(picture.width);
    const auto height = static_cast<int32_t>(picture.height);
    if (!answer.picture({0, 0, width, height, 0, 0, width, height, 0, 3, StoredType::float_, "openexr", names})) return;
    answer.colors(colors);
    answer.samples(picture.texels.data(), picture.texels.size());
    answer.end();
}

MemoryLimit memory_limit(const ReadRequest& request) {
    constexpr uint64_t beside_texels = 1 << 30;
    const uint64_t own = address_space() + beside_texels + 2 * request.left;
    rlimit inherited = {};
    if (getrlimit(RLIMIT_AS, &inherited) == 0 && inherited.rlim_cur < own) return {inherited.rlim_cur, true};
    return {own, false};
}

/// Answers within the limits, and ends this process. `oiio`: null for an EXR.
[[noreturn]] void answer_and_end(const std::string& path, const ReadRequest& request, const MemoryLimit& memory,
                                 const OiioModule* oiio) {
    limit(RLIMIT_AS, memory.bytes);
    if (memory.is_inherited) std::set_new_handler(end_out_of_memory);
    errno = 0;
    Answer answer(request, memory, request.kind == ReadKind::texture ? stated_colors(path) : std::nullopt);
    if (oiio)
        answer_oiio(path, answer, *oiio);
    else
        answer_exr(path, answer);
    _exit(0);
}

/// The directory of this program, in which the module for OpenImageIO lies.
std::filesystem::path own_directory() {
    std::error_code failure;
    return std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
}

/// Ends this process if the one that started it has ended, or ends.
void end_with(pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
}

/// Ends as a child process has ended, unless that was well.
void end_like(int status, const MemoryLimit& memory) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);  // libraries abort, or use the null pointer that they got for memory
        if (memory.is_inherited && (number == SIGABRT || number == SIGSEGV || number == SIGBUS)) end_out_of_memory();
        limit(RLIMIT_CORE, 0);
        std::signal(number, SIG_DFL);
        raise(number);
    }
    if (status != 0) _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
}

/// Answers one request by a process of its own, so that what a picture breaks there harms no other picture. Libraries
/// are loaded before, once.
void answer_one() {
    ReadRequest request;
    receive(&request, sizeof request);
    std::string path(request.path_size, '\0');
    receive(path.data(), path.size());
    const OiioModule* oiio = nullptr;
    try {
        if (request.kind != ReadKind::exr_texture)
            oiio = &load_oiio(own_directory(), request.kind == ReadKind::texture ? "formats other than EXR and .data"
                                                                                 : "formats other than EXR");
    } catch (const std::bad_alloc&) {
        end_out_of_memory();
    } catch (const std::exception& error) {
        return send_failure(error.what());
    }
    const MemoryLimit memory = memory_limit(request);
    const pid_t self = getpid();
    const pid_t child = fork();
    if (child == 0) {
        end_with(self);
        answer_and_end(path, request, memory, oiio);
    }
    if (child < 0 && errno == ENOMEM) end_out_of_memory();
    if (child < 0) return send_failure("no process can be started to decode it");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    end_like(status, memory);
}

}  // namespace
}  // namespace cistula

int main(int count, char** arguments) {
    using namespace cistula;
    if (count != 2 || std::string_view(arguments[1]) != reader_protocol) {
        std::fputs("cistula-read-picture: is started by programs that read textures, and does nothing by itself\n",
                   stderr);
        return reader_wrong_protocol;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    prctl(PR_SET_DUMPABLE, 0);  // no core file of a crash that is expected
    limit(RLIMIT_FSIZE, 0);
    for (;;) answer_one();
}
