#pragma once

#include <string>
#include <vector>

namespace percale::scenes {

/// The path of the program that runs. Throws SceneError if the system does not report it.
std::string own_program();

/// The files that hold the project's code in this program: its own, then the libraries libpercale* that it has loaded, by name.
/// Throws SceneError like own_program.
std::vector<std::string> own_files();

}  // namespace percale::scenes
