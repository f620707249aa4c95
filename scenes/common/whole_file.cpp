#include "common/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace {

[[noreturn]] void refuse(const std::string& file) {
    throw SceneError(file + ": cannot be written: " + std::strerror(errno != 0 ? errno : EIO));
}

/// Makes the disk store what was written to a file or, for a folder, its list of files.
void sync_path(const std::string& path, const std::string& file) {
    const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) refuse(file);
    const bool good = fsync(opened) == 0;
    const int error = errno;
    close(opened);
    errno = error;
    // Not every file system can do that for a folder.
    if (!good && error != EINVAL && error != EROFS) refuse(file);
}

/// What a symbolic link leads to; the name itself otherwise. A device or a folder is refused: renaming would replace it.
std::string target_of(const std::string& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        const bool folder = std::filesystem::is_directory(status);
        throw SceneError(file +
                         ": cannot be written: " + (folder ? std::strerror(EISDIR) : "it is there and not a regular file"));
    }
    const std::filesystem::path target = std::filesystem::weakly_canonical(file, error);
    return error ? file : target.string();
}

}  // namespace

std::string without_part_suffix(std::string file) {
    if (file.ends_with(part_suffix)) file.resize(file.size() - std::string_view(part_suffix).size());
    return file;
}

std::string whole_or_part(const std::string& file) {
    const std::string part = file + part_suffix;
    std::error_code error;
    return std::filesystem::symlink_status(part, error).type() == std::filesystem::file_type::regular ? part : file;
}

WholeFile::WholeFile(const std::string& file) : file_(target_of(file)), temporary_(file_ + part_suffix) {
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!out_) refuse(file_);
}

WholeFile::WholeFile(const std::string& file, const std::string& source, std::uint64_t bytes)
    : file_(target_of(file)), temporary_(file_ + part_suffix) {
    namespace fs = std::filesystem;
    std::error_code error;
    const std::uintmax_t there = fs::file_size(source, error);
    if (error) throw SceneError(source + ": cannot be read: " + error.message());
    if (there < bytes)
        throw SceneError(source + ": has " + std::to_string(there) + " of the bytes that belong to it, not " +
                         std::to_string(bytes));
    if (!fs::equivalent(source, temporary_, error))
        fs::copy_file(source, temporary_, fs::copy_options::overwrite_existing, error);
    if (!error) fs::resize_file(temporary_, bytes, error);
    if (error) throw SceneError(file_ + ": cannot be written: " + error.message());
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::in | std::ios::out | std::ios::ate);
    if (!out_) refuse(file_);
}

WholeFile::~WholeFile() {
    if (kept_) return;
    out_.close();
    std::remove(temporary_.c_str());
}

void WholeFile::check() {
    if (!out_) refuse(file_);
}

std::uint64_t WholeFile::sync() {
    if (out_) errno = 0;  // else it still says why writing failed
    out_.seekp(0, std::ios::end);
    out_.flush();
    check();
    sync_path(temporary_, file_);
    return static_cast<std::uint64_t>(out_.tellp());
}

void WholeFile::commit() {
    if (out_) errno = 0;  // else it still says why writing failed
    out_.close();
    if (!out_) refuse(file_);
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) throw SceneError(file_ + ": cannot be written: " + error.message());
    kept_ = true;
}

void commit_together(std::initializer_list<WholeFile*> files) {
    for (WholeFile* file : files) {
        file->out().flush();
        file->check();
    }
    for (WholeFile* file : files) file->commit();
}

OutputFolder::OutputFolder(const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code error, ignored;
    const fs::path whole = fs::path(folder).lexically_normal();
    for (fs::path path = whole; !path.empty() && !fs::exists(path, ignored); path = path.parent_path())
        made_.push_back(path.string());
    fs::create_directories(whole, error);
    if (!error && fs::is_directory(whole)) return;
    remove_empty();
    throw SceneError(folder + ": cannot be made: " + (error ? error.message() : "it is a file"));
}

OutputFolder::~OutputFolder() { remove_empty(); }

void OutputFolder::remove_empty() {
    std::error_code error;  // a folder with something in it stays
    for (const std::string& folder : made_) std::filesystem::remove(folder, error);
}

void write_whole_file(const std::string& file, const std::string& text) {
    WholeFile whole(file);
    whole.out() << text;
    whole.commit();
}

void write_durable_file(const std::string& file, std::span<const std::byte> bytes) {
    WholeFile whole(file);
    whole.out().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    whole.sync();
    whole.commit();
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    sync_path(folder.empty() ? "." : folder.string(), file);
}

}  // namespace percale::scenes
