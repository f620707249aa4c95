#pragma once

#include <span>
#include <string>
#include <vector>

#include "percale/mesh.h"

// An animation by morph targets, made in two goes: frames are put behind one another into a file of samples as they come, and the
// GLB file is made of that at the end, a frame of it in memory at a time.
//   samples: uint32 shapes; of each uint32 vertices, triangles, moves, then its triangles, uint32, and, if it rests, its
//   vertices; then of each frame the vertices of the shapes that move. Vertices: x, y, z of all positions, then of all unit
//   normals, float32. All little-endian.
namespace percale::scenes {

struct MorphShape {
    const TriangleMesh* mesh = nullptr;  // m, world
    bool moves = false;
};

struct MorphName {
    std::string name;
    bool is_cloth = false;
};

/// The size of a vertex in the samples: a position and a normal.
inline constexpr double morph_bytes_a_vertex = 24.0;

/// The bytes before the first frame.
std::string morph_header(std::span<const MorphShape> shapes);
/// The bytes of one frame.
std::string morph_frame(std::span<const MorphShape> shapes);

/// Unit normals of vertices, sums of those of their triangles by area; 0 where these cancel.
std::vector<Vec3> morph_normals(const TriangleMesh& mesh);

/// The GLB file: frame 0 as the mesh of each shape, the others as targets of those that move. `times`: of all frames in the
/// samples, s, at least one. Whole or not at all. Throws SceneError for samples that cannot be read, and for more than 4 GiB.
void write_morph_glb(const std::string& file, const std::string& samples, std::span<const MorphName> names,
                     std::span<const double> times);

}  // namespace percale::scenes
