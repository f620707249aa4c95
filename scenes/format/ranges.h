#pragma once

namespace percale::scenes {

/// Largest coordinates and times of a scene.
inline constexpr double farthest = 1e6;  // m
inline constexpr double longest = 1e6;   // s

}  // namespace percale::scenes
