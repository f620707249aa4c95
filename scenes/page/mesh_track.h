#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshes/mesh_fields.h"
#include "page/packing.h"
#include "percale/mesh.h"

// One mesh of a run over the frames that a page shows.
namespace percale::scenes {

/// A field of vertices over frames, packed.
struct PlaybackField {
    std::string name;
    bool of_frames = true;         // false: the page's own, not in the files of the run
    PackRange range;               // of all frames
    double low = 0.0, high = 0.0;  // what 2 % and 98 % of the finite values do not exceed
    std::string values;            // base64: frame by frame two bytes a vertex
};

struct PlaybackMesh {
    std::string name;
    bool is_cloth = true, moves = true;  // not: one frame stands for all
    std::size_t vertices = 0, triangles = 0;
    std::array<PackRange, 3> axes;  // x, y, z, m
    std::string corners;            // base64: four bytes a corner
    std::string positions;          // base64: frame by frame x, y and z of a vertex, two bytes each
    std::vector<PlaybackField> fields;
};

/// Gathers the frames of one mesh.
class MeshTrack {
public:
    /// `first`: its shape in frame 0, m, world. `own_fields`: names of fields that no file has.
    MeshTrack(PlaybackMesh described, TriangleMesh first, std::vector<std::string> own_fields);

    const TriangleMesh& first() const { return first_; }
    /// Adds a frame and its fields of vertices. Throws SceneError naming the file where the mesh has other vertices or triangles
    /// than in frame 0, or other fields than in the frame added first.
    void add(const std::string& file, const TriangleMesh& mesh, const std::vector<MeshField>& fields);
    PlaybackMesh packed_mesh() const;

private:
    PlaybackMesh described_;
    TriangleMesh first_;
    std::vector<std::string> own_fields_;
    std::array<std::vector<float>, 3> axes_;  // all frames, one after the other
    std::vector<std::string> names_;          // of the fields
    std::vector<std::vector<float>> values_;
    bool empty_ = true;
};

/// The mean of (l - l0)/l0 over the sides of the triangles at each vertex, l0 as in `first`; 0 without triangles. Sides without
/// length in `first` do not count.
std::vector<double> edge_change(const TriangleMesh& first, const std::vector<Vec3>& now);

}  // namespace percale::scenes
