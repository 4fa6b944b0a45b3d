// Snapshots of the frame in work, when SIGUSR1 asks for one.
#pragma once

#include <optional>
#include <thread>

#include "apps/common/film_loop.h"
#include "apps/common/film_progress.h"

namespace cistula {

/// While an object of this class exists, SIGUSR1 is caught and counted. Only one object at a time.
class UserSignal {
  public:
    UserSignal();
    ~UserSignal();
    UserSignal(const UserSignal&) = delete;
    UserSignal& operator=(const UserSignal&) = delete;

    /// Waits for a signal; several that came since the last call are one. False once close() was called.
    bool wait();

    /// Ends the wait of another thread, and all later ones.
    void close();
};

/// The attribute of a snapshot's header: the share of its pixels that are done. Finished frames do not have it.
inline constexpr const char* snapshot_attribute = "cistula:snapshot";

/// Writes the finished part of the frame in work to a file beside its own, on a thread of its own, whenever a signal
/// comes, and says so. Pixels that are not done are 0 in every channel. Whatever fails is said, and the film goes on.
class Snapshots {
  public:
    /// All arguments must outlive this object.
    Snapshots(const FilmJob& job, UserSignal& signal, const FinishedTiles& tiles, FilmProgress& report);
    ~Snapshots();
    Snapshots(const Snapshots&) = delete;
    Snapshots& operator=(const Snapshots&) = delete;

    void begin_frame(const CameraFrame& camera);
    void end_frame();

  private:
    void write();
    void write(const CameraFrame& camera, PartialFilm part);
    void say(const std::string& what);

    const FilmJob& job_;
    UserSignal& signal_;
    const FinishedTiles& tiles_;
    FilmProgress& report_;
    std::mutex mutex_;
    std::optional<CameraFrame> camera_;  // of the frame in work
    std::thread thread_;
};

}  // namespace cistula
