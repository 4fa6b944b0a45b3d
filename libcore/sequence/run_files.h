// The files of a run: none is written that is read too, or written twice.
#pragma once

#include <sys/types.h>

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cistula {

/// The files that a program reads and writes, told apart by device and inode, whatever the paths that lead to them. A
/// file that does not exist yet is told apart by its folder and its name.
class RunFiles {
  public:
    /// Begins with the files that standard output and standard error are redirected to, and with the config of $OCIO.
    RunFiles();

    /// Adds a file that is read. `what` names it in messages: "the scene". "-": the file that standard input comes
    /// from. No file: "".
    void reads(const std::string& path, const std::string& what);

    /// Adds a scene and the files that it names (SceneSource::files).
    void reads_scene(const std::string& path, const std::vector<std::string>& files);

    /// Adds a file that is written; `what` names it in messages. Throws Error (usage) if it is another one of these:
    /// "PATH: would be both the scene and an image; give each a file of its own". No file: "".
    void writes(const std::string& path, const std::string& what);

  private:
    struct Place {
        dev_t device = 0;
        ino_t inode = 0;   // of the file, or of the nearest folder on its path that exists
        std::string rest;  // from that folder to the file; empty: the file exists

        auto operator<=>(const Place&) const = default;
    };
    struct Use {
        std::string path, what;
    };

    Place place_of(const std::string& path);
    void add_stream(int descriptor, const std::string& what);

    std::map<Place, Use> uses_;
    std::optional<std::string> folder_;  // of the last file that did not exist; others are in the same one
    Place place_of_folder_;
};

}  // namespace cistula
