#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "common/whole_file.h"

namespace percale::scenes {

/// A file that grows over a run, as a checkpoint knows it.
struct GrownFile {
    std::string name;         // relative to the run's folder
    std::uint64_t bytes = 0;  // that belong to the run until then
};

/// The files that show the frames of a run, each whole or absent. All names are relative to the folder and lie in a folder below
/// it, which is made when it is needed and goes again if nothing is in it. What cannot be written or read is a SceneError naming
/// the file.
class FrameFolder {
public:
    /// Creates nothing yet.
    explicit FrameFolder(const std::string& folder) : folder_(folder) {}

    /// A file that is written at once by `write_to`, which gets its path.
    void write(const std::string& name, const std::function<void(const std::string&)>& write_to);
    /// The stream that appends to a file that grows; before its first use the file is empty.
    std::ostream& grown(const std::string& name);
    /// Throws if something that was put into grown files could not be written.
    void check();
    /// The path of a grown file with all that was put into it. It never becomes whole: other files are made from it at the end of
    /// the run, then it is removed, or stays under its temporary name where a checkpoint needs it.
    std::string scratch(const std::string& name);

    /// Copies a file from another run's folder.
    void copy(const std::string& other, const std::string& name);
    /// Takes over a grown file from another run's folder, which may be this one, with its length of that time; with `keep` that
    /// much of it is left if this run fails.
    void go_on(const std::string& other, const GrownFile& file, bool keep);

    /// Flushes all grown files to the disk and returns their lengths.
    std::vector<GrownFile> sync();
    /// Keeps what is there for a checkpoint: `discard` leaves it, grown files under their temporary names.
    void keep();
    /// Removes every file written since the construction or the last call of `keep`.
    void discard();
    /// Makes the grown files whole.
    void finish();

private:
    struct Growing {
        explicit Growing(const std::string& path) : file(path) {}
        Growing(const std::string& path, const std::string& source, std::uint64_t bytes) : file(path, source, bytes) {}
        WholeFile file;
        bool kept = false, whole = false, scratch = false;
    };
    void need_folder_of(const std::string& name);
    std::string path(const std::string& name) const { return folder_ + "/" + name; }

    std::string folder_;
    std::vector<std::string> written_;  // paths
    std::map<std::string, OutputFolder> folders_;
    std::map<std::string, Growing> growing_;  // by name; gone before the folders
};

}  // namespace percale::scenes
