#pragma once

#include <string>

namespace percale::scenes {

/// Keeps a folder for one run as long as it lives. The lock is the kernel's, on the folder itself: it leaves no file, and ends
/// with the process, however that ends. On a file system without such locks it keeps nothing.
class FolderLock {
public:
    /// Throws SceneError where another lock of the folder lives, in this process or in any other.
    explicit FolderLock(const std::string& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int opened_ = -1;
};

}  // namespace percale::scenes
