#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene_file_error.h"
#include "percale/simulation.h"

namespace percale::scenes {

/// A scene refused because its cloth starts through or inside an obstacle, with the triangles concerned to look at.
class StartRefused : public SceneFileError {
public:
    StartRefused(const SourcePlace& place, const std::string& what, TriangleMesh triangles)
        : SceneFileError(place, what), triangles_(std::move(triangles)) {}
    /// World coordinates; of cloth and obstacle in one mesh.
    const TriangleMesh& triangles() const { return triangles_; }

private:
    TriangleMesh triangles_;
};

/// The cloth triangles that cross the obstacle or have a vertex inside it, and the obstacle triangles that cross them.
TriangleMesh offending_triangles(std::span<const TriangleMesh> cloths, const TriangleMesh& obstacle);

/// "12 vertices of sheet moved out of ball before the start, the farthest by 0.021 m"
std::string start_move_text(const StartMove& move, std::string_view when = "before the start");

constexpr std::string_view when_sewn = "when the seams had closed";

/// Prints what a scene's start needed, or closed seams, from the `first` move on, a line each; returns how many there are in all.
std::size_t print_start_moves(const Simulation& simulation, std::size_t first = 0, std::string_view when = "before the start");

}  // namespace percale::scenes
