#pragma once

#include <string>

// Scenes small enough for unit tests, as the text of scene files.
namespace percale::scenes::test {

/// A free sheet of 4 x 4 vertices, 0.3 m wide, without damping: it falls as a whole, so every figure is known. Its springs are so
/// weak that the explicit step is stable and what rounding does to their lengths does not grow.
inline std::string falling_sheet() {
    return R"(
duration = 0.1
[step]
time_step = 0.01
scheme = "symplectic_euler"
damping_form = "velocity"
[fabric.sheet]
area_density = 0.2
springs = { structural = 1.0, shear = 0.5, bend = 0.01 }
spring_damping = 0.0
[[cloth]]
name = "sheet"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [4, 4] }
pose = { translation = [0.0, 2.0, 0.0] }
[output]
fps = 50.0
)";
}

/// A sheet of 6 x 6 vertices that falls 1 cm onto a box whose top is at 0, and lies there.
inline std::string sheet_on_box() {
    return R"(
title = "sheet on a box"
duration = 0.2
[step]
time_step = 0.016666666666666666
[fabric.sheet]
area_density = 0.2
thickness = 0.005
springs = { structural = 1.0, shear = 0.5, bend = 0.01 }
[[cloth]]
name = "sheet"
fabric = "sheet"
grid = { size = [0.3, 0.3], vertices = [6, 6] }
pose = { translation = [0.0, 0.015, 0.0] }
[[obstacle]]
name = "box"
shape = { box = { size = [1.0, 0.5, 1.0] } }
pose = { translation = [0.0, -0.25, 0.0] }
[output]
fps = 30.0
)";
}

}  // namespace percale::scenes::test
