#include "sequence/snapshots.h"

#include "base/error.h"

#include <fmt/format.h>

#include "image/exr/exr.h"
#include "image/picture/raw_picture.h"
#include "render/record/film_picture.h"
#include "render/record/split_picture.h"

#include <cerrno>

namespace cistula {
namespace {

/// Sets the pixels that are not done to 0.
void clear_others(LayeredPicture& picture, const std::vector<bool>& done) {
    for (LayeredPicture::Channel& channel : picture.channels)
        for (size_t i = 0; i < done.size(); ++i)
            if (!done[i]) channel.values[i] = 0;
}

}  // namespace

Snapshots::Snapshots(const SequenceJob& job, SnapshotRequests& requests, const FinishedTiles& tiles)
    : job_(job), requests_(requests), tiles_(tiles), thread_([this] {
          while (requests_.wait()) write();
      }) {}

Snapshots::~Snapshots() {
    requests_.close();
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

void Snapshots::write() {
    std::optional<CameraFrame> camera;
    std::optional<PartialFilm> part;
    try {
        {
            const std::lock_guard lock(mutex_);
            camera = camera_;
            if (camera) part = tiles_.copy();
        }
        if (!camera) return job_.events.remark("no snapshot: no frame is in work");
        if (job_.request.backend == Backend::cuda)
            return job_.events.remark(fmt::format(
                "no snapshot: frame {} is on a GPU, which gives its pixels back when all are done", camera->frame));
        if (!part || part->fraction == 0)
            return job_.events.remark(fmt::format("no snapshot: no pixel of frame {} is done", camera->frame));
        write(*camera, *part);
    } catch (const std::exception& error) {
        job_.events.remark(fmt::format("no snapshot: {}", failure_of(error, "it copies the frame").text));
    }
}

void Snapshots::write(const CameraFrame& camera, const PartialFilm& part) {
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
    job_.events.remark(fmt::format("snapshot of frame {} at {:.0f} %: {}", camera.frame, 100 * part.fraction, path));
    job_.events.snapshot(camera.frame, path, part.fraction);
}

SnapshotRequests::SnapshotRequests() {
    sem_init(&asked_, 0, 0);
}

SnapshotRequests::~SnapshotRequests() {
    sem_destroy(&asked_);
}

void SnapshotRequests::ask() {
    sem_post(&asked_);
}

bool SnapshotRequests::wait() {
    while (sem_wait(&asked_) != 0 && errno == EINTR) {
    }
    while (sem_trywait(&asked_) == 0) {
    }
    return !closed_;
}

void SnapshotRequests::close() {
    closed_ = true;
    sem_post(&asked_);
}

}  // namespace cistula
