#include "common/own_program.h"

#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

std::string own_program() {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) throw SceneError("the program's own path cannot be read: " + error.message());
    return path.string();
}

}  // namespace percale::scenes
