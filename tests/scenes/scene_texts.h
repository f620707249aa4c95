#pragma once

#include <string>

#include "percale/error.h"

namespace percale::scenes {

/// The message of the SceneError that `work` throws; "nothing was thrown" if none.
template <class Work>
std::string error_of(Work work) {
    try {
        work();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

/// A correct scene of seven lines: one fabric 'sheet' (lines 1 and 2), one cloth 'flag' of 5 by 4 vertices (from line 4 on).
inline std::string small_scene() {
    return "[fabric.sheet]\n"
           "springs = { structural = 1000.0, shear = 500.0, bend = 10.0 }\n"
           "\n"
           "[[cloth]]\n"
           "name   = \"flag\"\n"
           "fabric = \"sheet\"\n"
           "grid   = { size = [0.4, 0.3], vertices = [5, 4] }\n";
}

}  // namespace percale::scenes
