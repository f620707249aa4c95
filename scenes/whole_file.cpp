#include "whole_file.h"

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

WholeFile::WholeFile(const std::string& file) : file_(target_of(file)), temporary_(file_ + ".part") {
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!out_) refuse(file_);
}

WholeFile::~WholeFile() {
    if (committed_) return;
    out_.close();
    std::remove(temporary_.c_str());
}

void WholeFile::check() {
    if (!out_) refuse(file_);
}

void WholeFile::commit() {
    if (out_) errno = 0;  // else it still says why writing failed
    out_.close();
    if (!out_) refuse(file_);
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) throw SceneError(file_ + ": cannot be written: " + error.message());
    committed_ = true;
}

std::string made_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw SceneError(folder + ": cannot be made: " + (error ? error.message() : "it is a file"));
    return folder;
}

void write_whole_file(const std::string& file, const std::string& text) {
    WholeFile whole(file);
    whole.out() << text;
    whole.commit();
}

}  // namespace percale::scenes
