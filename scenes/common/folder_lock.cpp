#include "common/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "percale/error.h"

namespace percale::scenes {

FolderLock::FolderLock(const std::string& folder) {
    // OutputFolder normalises paths likewise: "none/../out" is "out", even if there is no folder "none".
    opened_ = open(std::filesystem::path(folder).lexically_normal().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (opened_ < 0 && errno != ENOENT)
        throw SceneError(folder, std::string("cannot be kept from other runs: ") + std::strerror(errno));
    if (opened_ < 0 || flock(opened_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    close(opened_);
    throw SceneError(folder, "another run writes into it; wait for its end, or name another folder");
}

FolderLock::~FolderLock() {
    if (opened_ >= 0) close(opened_);
}

}  // namespace percale::scenes
