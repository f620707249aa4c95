#pragma once

#include <string>

namespace percale::scenes {

/// Where in a file something was said, for messages; line or column 0 = unknown.
struct SourcePlace {
    std::string file;
    int line = 0;
    int column = 0;
};

}  // namespace percale::scenes
