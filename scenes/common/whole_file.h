#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace percale::scenes {

/// What the temporary name of a file that is being written ends in.
constexpr const char* part_suffix = ".part";

/// The name of a file, whole or not.
std::string without_part_suffix(std::string file);

/// Where a file that was not made whole can be gone on with: its temporary name if a regular file has that, else its own.
std::string whole_or_part(const std::string& file);

/// A file that is either whole or absent: written under a temporary name beside the wanted one and renamed by `commit`.
/// Without `commit` nothing is left but after `leave`. A symbolic link is followed. Throws SceneError naming the file if it
/// cannot be written or if something that is not a regular file has that name.
class WholeFile {
public:
    explicit WholeFile(const std::string& file);
    /// Goes on after the first `bytes` of `source`, which is copied unless it is this file's own temporary one. Throws SceneError
    /// if it has fewer. What is there may be overwritten (seekp).
    WholeFile(const std::string& file, const std::string& source, std::uint64_t bytes);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::ostream& out() { return out_; }
    /// Throws SceneError if something that was written until now could not be.
    void check();
    /// Brings what was written until now to the disk; returns how long the file is, bytes.
    std::uint64_t sync();
    /// The file is not whole, but what is there of it stays under the temporary name.
    void leave() { kept_ = true; }
    void commit();

private:
    std::string file_, temporary_;
    std::ofstream out_;
    bool kept_ = false;
};

/// Commits all files, or none where one could not be written.
void commit_together(std::initializer_list<WholeFile*> files);

/// A folder for output, made where there is none and gone again if it was new and nothing is in it at the end. Throws SceneError
/// if it cannot be made.
class OutputFolder {
public:
    explicit OutputFolder(const std::string& folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

private:
    void remove_empty();

    std::vector<std::string> made_;  // the innermost first
};

/// A table and its diagram, FOLDER/NAME.csv and .svg. Without `commit` nothing is left of them, nor of a folder made for them.
struct TableFiles {
    TableFiles(const std::string& in, const std::string& name)
        : folder(in), table(in + "/" + name + ".csv"), diagram(in + "/" + name + ".svg") {}
    void commit() { commit_together({&table, &diagram}); }

    OutputFolder folder;
    WholeFile table, diagram;
};

/// Text as a whole file.
void write_whole_file(const std::string& file, const std::string& text);

/// Bytes as a whole file that survives a loss of power: an older one of that name is there until this one is on the disk.
void write_durable_file(const std::string& file, std::span<const std::byte> bytes);

}  // namespace percale::scenes
