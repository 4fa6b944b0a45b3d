// Atomic writing of files: a failure or an interruption leaves the old file unchanged.
#pragma once

#include <string>
#include <string_view>

#include "base/file_bytes.h"

namespace cistula {

/// A file that replaces its target in one step. Write to it, then commit(); without a commit the destructor removes
/// what was written. The temporary is ".NAME.0.part" beside the target (1 and so on for others that write to it at the
/// same time), so that replacing is one rename. It is locked while it is written: what processes that died left behind
/// is removed by the next that writes to the target. A symbolic link is followed once, when the object is made: the
/// file that it points to is replaced, in the directory where it was then. Links that lead nowhere and files that are
/// not regular are refused. Of a file with several names (hard links) the others keep the old contents.
class AtomicFile {
  public:
    /// Creates the temporary, empty, with the permissions of the file that it will replace, but not its set-user-ID,
    /// set-group-ID and sticky bits. Throws Error (file) with the system's reason.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return path_; }
    /// The temporary's name in the target's directory.
    const std::string& temporary() const { return temporary_; }
    /// The temporary, open for writing. It stays this object's.
    int descriptor() const { return descriptor_; }

    /// Appends to the temporary. Throws Error (file).
    void write(std::string_view bytes);

    /// Flushes the bytes to the disk and renames the temporary to the target. Throws Error (file).
    void commit();

    /// Removes the temporaries of a target that processes that died left behind. Throws as the constructor does.
    static void remove_stale(const std::string& path);

  private:
    /// A descriptor that is closed with its object.
    struct Descriptor {
        int number = -1;
        ~Descriptor();
    };

    AtomicFile() = default;
    friend void remove_temporaries() noexcept;
    void find_target();
    std::string prefix() const;
    void create_temporary();
    int open_temporary();
    void close_temporary(bool remove) noexcept;

    std::string path_;      // as the user wrote it, for messages
    std::string name_;      // the target's, in directory_
    int permissions_ = -1;  // of the file that is replaced; -1: none is
    Descriptor directory_;
    std::string temporary_;  // empty once committed
    int descriptor_ = -1;
};

/// Removes the temporaries of all files that this process writes, which must end then. Safe in a handler of signals.
void remove_temporaries() noexcept;

/// Replaces the file by these bytes, or leaves it unchanged and throws Error (file).
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace cistula
