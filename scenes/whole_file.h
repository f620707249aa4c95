#pragma once

#include <fstream>
#include <string>

namespace percale::scenes {

/// A text file that is either whole or absent: written under a temporary name beside the wanted one and renamed by `commit`.
/// Without `commit` nothing is left. A symbolic link is followed. Throws SceneError naming the file if it cannot be written or if
/// something that is not a regular file has that name.
class WholeFile {
public:
    explicit WholeFile(const std::string& file);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::ostream& out() { return out_; }
    /// Throws SceneError if something that was written until now could not be.
    void check();
    void commit();

private:
    std::string file_, temporary_;
    std::ofstream out_;
    bool committed_ = false;
};

/// Makes a folder where there is none and returns its name. Throws SceneError if it cannot be made.
std::string made_folder(const std::string& folder);

/// Text as a whole file.
void write_whole_file(const std::string& file, const std::string& text);

}  // namespace percale::scenes
