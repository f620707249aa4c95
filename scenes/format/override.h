#pragma once

#include <string>

namespace percale::scenes {

/// One `--set KEY=VALUE`: a dotted key of the scene file and a TOML value (a bare word is taken as a string). An option that
/// stands for a key, such as --fps, is named in messages in place of `--set KEY`.
struct Override {
    std::string key;
    std::string value;
    std::string option = {};
};

}  // namespace percale::scenes
