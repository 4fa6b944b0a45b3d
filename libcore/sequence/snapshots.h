// Snapshots of the frame in work, when one is asked for.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "sequence/sequence_loop.h"

namespace cistula {

/// Asks for snapshots, from any thread or from a handler of signals.
class SnapshotRequests {
  public:
    SnapshotRequests();
    ~SnapshotRequests();
    SnapshotRequests(const SnapshotRequests&) = delete;
    SnapshotRequests& operator=(const SnapshotRequests&) = delete;

    /// Safe in a handler of signals.
    void ask();

    /// Waits until somebody asks; requests since the last call are one. False once close() was called.
    bool wait();

    /// Ends the wait of another thread, and all later ones.
    void close();

  private:
    sem_t asked_;
    std::atomic<bool> closed_{false};
};

/// The attribute of a snapshot's header: the share of its pixels that are done. Finished frames do not have it.
inline constexpr const char* snapshot_attribute = "cistula:snapshot";

/// Writes the finished part of the frame in work to a file beside its own, on a thread of its own, whenever one
/// is asked for, and says so. Pixels that are not done are 0 in every channel. Whatever fails is said, and the
/// sequence goes on.
class Snapshots {
  public:
    /// All arguments must outlive this object.
    Snapshots(const SequenceJob& job, SnapshotRequests& requests, const FinishedTiles& tiles);
    ~Snapshots();
    Snapshots(const Snapshots&) = delete;
    Snapshots& operator=(const Snapshots&) = delete;

    void begin_frame(const CameraFrame& camera);
    void end_frame();

  private:
    void write();
    void write(const CameraFrame& camera, const PartialFilm& part);

    const SequenceJob& job_;
    SnapshotRequests& requests_;
    const FinishedTiles& tiles_;
    std::mutex mutex_;
    std::optional<CameraFrame> camera_;  // of the frame in work
    std::thread thread_;
};

}  // namespace cistula
