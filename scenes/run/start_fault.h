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

/// Prints what a scene's start needed, a line each; returns how many.
std::size_t print_start_moves(const Simulation& simulation);
/// Prints the moves after the first `start_moves`, made when seams had closed.
void print_moves_after(std::size_t start_moves, const Simulation& simulation);

}  // namespace percale::scenes
