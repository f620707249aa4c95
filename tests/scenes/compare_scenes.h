#pragma once

#include <string>

#include "scenes/study/scene_variant.h"

// Scenes of which the error of a scheme is known.
namespace percale::scenes::test {

inline SceneSource source_of(const std::string& text) {
    return [text](std::span<const Override> overrides) { return parse_scene(text, "scene.toml", overrides); };
}

inline bool never_stop() { return false; }

/// A strip of stiff springs, 2 cm wide and 5 cm high, that stands on its lower edge, which is held: it falls over from where
/// nothing pushes it.
inline std::string standing_strip() {
    return R"(
duration = 0.7
[fabric.sheet]
springs = { structural = 50.0, shear = 50.0 }
[[cloth]]
name = "strip"
fabric = "sheet"
grid = { size = [0.02, 0.05], vertices = [2, 2] }
pose = { rotation = [0.7071067811865476, 0.7071067811865476, 0.0, 0.0] }
pin = [2, 3]
)";
}

}  // namespace percale::scenes::test
