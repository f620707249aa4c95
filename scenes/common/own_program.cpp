#include "common/own_program.h"

#include <link.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace {

/// The callback of dl_iterate_phdr.
int add_own_library(dl_phdr_info* loaded, std::size_t, void* libraries) {
    const std::string file = loaded->dlpi_name;
    if (std::filesystem::path(file).filename().string().find("libpercale") != std::string::npos)
        static_cast<std::vector<std::string>*>(libraries)->push_back(file);
    return 0;
}

}  // namespace

std::string own_program() {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) throw SceneError("the program's own path cannot be read: " + error.message());
    return path.string();
}

std::vector<std::string> own_files() {
    std::vector<std::string> files;
    dl_iterate_phdr(add_own_library, &files);
    std::ranges::sort(files, {}, [](const std::string& file) { return std::filesystem::path(file).filename().string(); });
    files.insert(files.begin(), own_program());
    return files;
}

}  // namespace percale::scenes
