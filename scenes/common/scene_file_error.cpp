#include "common/scene_file_error.h"

namespace percale::scenes {

std::string place_text(const SourcePlace& place) {
    if (place.line <= 0) return place.file;
    const std::string line = place.file + ":" + std::to_string(place.line);
    return place.column <= 0 ? line : line + ":" + std::to_string(place.column);
}

void fail_at(const SourcePlace& place, const std::string& what) { throw SceneFileError(place, what); }

}  // namespace percale::scenes
