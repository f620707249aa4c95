#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace percale::scenes {

/// What the temporary name of a file that is being written ends in.
constexpr const char* part_suffix = ".part";

/// A file that is either whole or absent: written under a temporary name beside the wanted one and renamed by `commit`.
/// Without `commit` nothing is left but after `leave`. A symbolic link is followed. Throws SceneError naming the file if it
/// cannot be written or if something that is not a regular file has that name.
class WholeFile {
public:
    explicit WholeFile(const std::string& file);
    /// Goes on after the first `bytes` of `source`, which is copied unless it is this file's own temporary one. Throws SceneError
    /// if it has fewer.
    WholeFile(const std::string& file, const std::string& source, std::uint64_t bytes);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::ostream& out() { return out_; }
    /// Throws SceneError if something that was written until now could not be.
    void check();
    /// Brings what was written until now to the disk; returns how many bytes that is.
    std::uint64_t sync();
    /// The file is not whole, but what is there of it stays under the temporary name.
    void leave() { kept_ = true; }
    void commit();

private:
    std::string file_, temporary_;
    std::ofstream out_;
    bool kept_ = false;
};

/// Makes a folder where there is none and returns its name. Throws SceneError if it cannot be made.
std::string made_folder(const std::string& folder);

/// Text as a whole file.
void write_whole_file(const std::string& file, const std::string& text);

/// Bytes as a whole file that survives a loss of power: an older one of that name is there until this one is on the disk.
void write_durable_file(const std::string& file, std::span<const std::byte> bytes);

/// Throws SceneError naming the file if it cannot be read.
std::vector<std::byte> read_bytes(const std::string& file);

}  // namespace percale::scenes
