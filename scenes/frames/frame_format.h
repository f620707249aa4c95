#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meshes/mesh_fields.h"
#include "percale/mesh.h"

// What a format of frames has to be: one file that makes a FrameFormat, and one row in frame_formats.cpp.
namespace percale::scenes {

class FrameFolder;

/// Whose shapes the frames of a run show. The names are parts of file names; no two of a list are equal.
struct FrameCast {
    std::vector<std::string> cloths, obstacles;  // in the order of the scene
    std::vector<bool> obstacle_moves;            // false: one pose in all frames
    /// OBJ files whose vertices these are, as they lie in the file, "" where there is none; empty: of none.
    std::vector<std::string> cloth_files = {}, obstacle_files = {};
    double fps = 30.0;  // frames per second of simulated time
};

/// One frame in world coordinates, m, in the order of the cast.
struct FrameShapes {
    int index = 0;      // frames come one after the other, from 0 or from where a run is resumed
    double time = 0.0;  // s
    std::span<const TriangleMesh> cloths, obstacles;
    std::span<const MeshFields> cloth_fields = {};  // empty: no cloth has any
};

/// The files that show one frame, relative to the run's folder, in the order of the cast. Frames may share files.
struct FrameFiles {
    std::vector<std::string> cloths, obstacles;
    std::vector<std::string> others = {};  // what goes with them
};

/// How large a mesh is in files: numbers of vertices and triangles, of fields of vertices and of triangles.
struct MeshCounts {
    double vertices = 0.0, triangles = 0.0, vertex_fields = 0.0, triangle_fields = 0.0;
};

/// Bytes that a mesh takes.
struct FrameBytes {
    double once = 0.0, each_frame = 0.0;
};

/// Writes the frames of one run. It keeps nothing of a frame, so that a new encoder can continue a run.
class FrameEncoder {
public:
    virtual ~FrameEncoder() = default;
    /// Writes one frame into frames/ and obstacles/ of the folder, as files of its own (FrameFolder::write) or behind what is in
    /// files that grow over the run (FrameFolder::grown).
    virtual FrameFiles write(const FrameShapes& frame, FrameFolder& folder) = 0;
    /// To be called after the last frame of a run: completes files that grow. `times`: of all frames, s.
    virtual void finish(std::span<const double> times, FrameFolder& folder) = 0;
    /// The first frame of this cast that a file of this name, relative to the run's folder, would show; -1: it is none of them.
    virtual int first_frame_of(const std::string& name) const = 0;
    /// Whether a file of `FrameFiles` is not there before `finish`.
    virtual bool is_made_at_end(const std::string&) const { return false; }
};

struct FrameFormat {
    std::string word;                                    // in scene files and of --frames
    std::string sentence;                                // what is written, for people
    std::vector<std::string> endings;                    // of all its files, with the point; no other format has them
    bool holds_fields = false;                           // FrameShapes::cloth_fields
    bool exact = false;                                  // import_mesh reads the same bits back from a file of one mesh and frame
    std::function<FrameBytes(const MeshCounts&)> bytes;  // approximate
    std::function<std::unique_ptr<FrameEncoder>(const FrameCast&)> make;
};

}  // namespace percale::scenes
