#pragma once

#include <string>

namespace percale::scenes {

/// The path of the program that runs. Throws SceneError where the system does not tell it.
std::string own_program();

}  // namespace percale::scenes
