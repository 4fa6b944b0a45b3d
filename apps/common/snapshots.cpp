#include "apps/common/snapshots.h"

#include <fmt/format.h>
#include <semaphore.h>

#include "apps/common/command_line.h"
#include "apps/common/progress_record.h"
#include "scene/film/film_picture.h"
#include "scene/film/split_picture.h"
#include "scene/image/exr/exr.h"
#include "scene/image/picture/raw_picture.h"

#include <atomic>
#include <cerrno>
#include <csignal>

namespace cistula {
namespace {

/// Sets the pixels that are not done to 0.
void clear_others(LayeredPicture& picture, const std::vector<bool>& done) {
    for (LayeredPicture::Channel& channel : picture.channels)
        for (size_t i = 0; i < done.size(); ++i)
            if (!done[i]) channel.values[i] = 0;
}

}  // namespace

Snapshots::Snapshots(const FilmJob& job, UserSignal& signal, const FinishedTiles& tiles, FilmProgress& report)
    : job_(job), signal_(signal), tiles_(tiles), report_(report), thread_([this] {
          while (signal_.wait()) write();
      }) {}

Snapshots::~Snapshots() {
    signal_.close();
    thread_.join();
}

void Snapshots::begin_frame(const CameraFrame& camera) {
    const std::lock_guard lock(mutex_);
    camera_ = camera;
}

void Snapshots::end_frame() {
    const std::lock_guard lock(mutex_);
    camera_.reset();
}

void Snapshots::say(const std::string& what) {
    if (!job_.request.quiet) report_.say("render: " + what);
}

void Snapshots::write() {
    std::optional<CameraFrame> camera;
    std::optional<PartialFilm> part;
    try {
        {
            const std::lock_guard lock(mutex_);
            camera = camera_;
            if (camera) part = tiles_.copy();
        }
        if (!camera) return say("no snapshot: no frame is in work");
        if (job_.request.backend == Backend::cuda)
            return say(fmt::format("no snapshot: frame {} is on a GPU, which gives its pixels back when all are done",
                                   camera->frame));
        if (!part || part->fraction == 0)
            return say(fmt::format("no snapshot: no pixel of frame {} is done", camera->frame));
        write(*camera, std::move(*part));
    } catch (const std::exception& error) {
        say(fmt::format("no snapshot: {}", failure_of(error, "it copies the frame").text));
    }
}

void Snapshots::write(const CameraFrame& camera, PartialFilm part) {
    const std::string path = snapshot_of(job_.output, camera.frame);
    if (file_kind(path) == FileKind::raw) {
        write_raw_picture(path, to_color(part.film));
    } else {
        LayeredPicture picture = to_layers(part.film, job_.request.channels);
        clear_others(picture, part.done);
        picture.attributes.merge(attributes_of(job_, camera));
        picture.attributes[snapshot_attribute] = part.fraction;
        set_container_flag(picture);
        if (job_.request.split == Split::parts)
            write_exr(path, split_by_layer(std::move(picture), Split::parts));
        else
            write_exr(path, picture);
    }
    say(fmt::format("snapshot of frame {} at {:.0f} %: {}", camera.frame, 100 * part.fraction, path));
    report_.record({"snapshot", camera.frame, path, part.fraction});
}

namespace {

sem_t snapshot_asked_for;  // posted by the handler: sem_post is safe there
std::atomic<bool> no_more_asked_for{false};
struct sigaction action_before;

void on_user_signal(int) {
    const int kept = errno;
    sem_post(&snapshot_asked_for);
    errno = kept;
}

}  // namespace

UserSignal::UserSignal() {
    sem_init(&snapshot_asked_for, 0, 0);
    no_more_asked_for = false;
    struct sigaction action = {};
    action.sa_handler = on_user_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, &action_before);
}

UserSignal::~UserSignal() {
    sigaction(SIGUSR1, &action_before, nullptr);
    sem_destroy(&snapshot_asked_for);
}

bool UserSignal::wait() {
    while (sem_wait(&snapshot_asked_for) != 0 && errno == EINTR) {
    }
    while (sem_trywait(&snapshot_asked_for) == 0) {
    }
    return !no_more_asked_for;
}

void UserSignal::close() {
    no_more_asked_for = true;
    sem_post(&snapshot_asked_for);
}

}  // namespace cistula
