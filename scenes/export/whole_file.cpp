#include "export/whole_file.h"

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

}  // namespace

WholeFile::WholeFile(const std::string& file) : file_(file), temporary_(file + ".part") {
    errno = 0;
    out_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!out_) refuse(file_);
}

WholeFile::~WholeFile() {
    if (committed_) return;
    out_.close();
    std::remove(temporary_.c_str());
}

void WholeFile::commit() {
    errno = 0;
    out_.close();
    if (!out_) refuse(file_);
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) throw SceneError(file_ + ": cannot be written: " + error.message());
    committed_ = true;
}

void write_whole_file(const std::string& file, const std::string& text) {
    WholeFile whole(file);
    whole.out() << text;
    whole.commit();
}

}  // namespace percale::scenes
