#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace percale::scenes {

/// The ending of the temporary name of a file that is being written.
constexpr const char* part_suffix = ".part";

/// The name of a file, whole or not.
std::string without_part_suffix(std::string file);

/// The path at which an unfinished file can be continued: its temporary name if a regular file has that name, else its own.
std::string whole_or_part(const std::string& file);

/// A file that is either whole or absent: written under a temporary name beside the wanted one and renamed by `commit`. Without
/// `commit` nothing is left, unless `leave` was called. A symbolic link is followed. Throws SceneError naming the file if it
/// cannot be written or if something that is not a regular file has that name.
class WholeFile {
public:
    explicit WholeFile(const std::string& file);
    /// Continues after the first `bytes` of `source`, which is copied unless it is this file's own temporary one. Throws
    /// SceneError if it has fewer. The bytes that are there may be overwritten (seekp).
    WholeFile(const std::string& file, const std::string& source, std::uint64_t bytes);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::ostream& out() { return out_; }
    /// Throws SceneError if anything put into the file so far could not be written.
    void check();
    /// Flushes all that was written so far to the disk; returns the length of the file, bytes.
    std::uint64_t sync();
    /// Keeps the unfinished file under its temporary name.
    void leave() { kept_ = true; }
    void commit();

private:
    std::string file_, temporary_;
    std::ofstream out_;
    bool kept_ = false;
};

/// Commits all files, or none where one could not be written.
void commit_together(std::initializer_list<WholeFile*> files);

/// A folder for output. It is made if there is none, and a new one is removed again if it is empty at the end. Throws SceneError
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

/// A table and its diagram, FOLDER/NAME.csv and .svg. Without `commit` neither they nor a folder made for them are left.
struct TableFiles {
    TableFiles(const std::string& in, const std::string& name)
        : folder(in), table(in + "/" + name + ".csv"), diagram(in + "/" + name + ".svg") {}
    void commit() { commit_together({&table, &diagram}); }

    OutputFolder folder;
    WholeFile table, diagram;
};

/// Writes text as a whole file.
void write_whole_file(const std::string& file, const std::string& text);

/// Writes bytes as a whole file that survives a loss of power: an older file of that name stays until this one is on the disk.
void write_durable_file(const std::string& file, std::span<const std::byte> bytes);

}  // namespace percale::scenes
