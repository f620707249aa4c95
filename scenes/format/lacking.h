#pragma once

#include <string_view>

// Keys and words of scene files that are specified but not in this build, so that they are not taken for slips.
namespace percale::scenes {

/// Whether this build lacks the key with this path, written as in scene_keys(): "fabric.preset".
bool lacks_key(std::string_view path);

/// Whether this build lacks this word as a value of the key with this path: "bdf2" of "step.scheme".
bool lacks_choice(std::string_view path, std::string_view word);

}  // namespace percale::scenes
