#pragma once

#include <string>

namespace percale::scenes {

/// Why this build makes no pictures, as a message; "" if it does.
inline std::string pictures_missing() {
#ifdef PERCALE_HAS_PICTURES
    return {};
#else
    return "this build has no pictures: libembree-dev or libstb-dev was not found when it was configured";
#endif
}

}  // namespace percale::scenes
