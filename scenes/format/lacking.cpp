#include "format/lacking.h"

#include <algorithm>
#include <span>

namespace percale::scenes {
namespace {

/// Without words the key itself.
struct Lacking {
    std::string_view path;
    std::span<const std::string_view> words = {};
};

constexpr std::string_view later_frame_formats[] = {"ply", "glb", "pc2", "mdd", "vtp"};

constexpr Lacking lacking[] = {
    {.path = "output.frames", .words = later_frame_formats},
    {.path = "cloth.pattern"},
    {.path = "event.detach"},
};

}  // namespace

bool lacks_key(std::string_view path) {
    return std::any_of(std::begin(lacking), std::end(lacking),
                       [&](const Lacking& entry) { return entry.words.empty() && entry.path == path; });
}

bool lacks_choice(std::string_view path, std::string_view word) {
    for (const Lacking& entry : lacking)
        if (entry.path == path && std::find(entry.words.begin(), entry.words.end(), word) != entry.words.end()) return true;
    return false;
}

}  // namespace percale::scenes
