#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "export/frames.h"
#include "picture/picture_field.h"
#include "picture/shown.h"

namespace percale::scenes {

/// What is shown of each frame besides its meshes, and what is not.
struct ShownChoice {
    const PictureField* field = nullptr;         // cloth is coloured by it
    std::vector<std::string> hidden = {};        // names of shapes
    std::map<std::string, Colour> colours = {};  // of shapes by name
};

/// Frames to draw: those of a run, or meshes named one by one, which are one frame. Reads a frame when it is asked for.
class FrameSource {
public:
    /// The folder of a run. Throws SceneError where its report lists no frames, or such as cannot be drawn (pc2, mdd, glb, vtp),
    /// or a name of `choice` is none of its shapes.
    static FrameSource of_run(const std::string& folder, const ShownChoice& choice);
    /// Mesh files; closed ones are bodies, unless all are. Names are the files' without folder and ending.
    static FrameSource of_meshes(const std::vector<std::string>& files, const ShownChoice& choice);

    /// The number of frames, at least 1.
    int count() const { return static_cast<int>(frames_.size()); }
    /// The time of a frame 0 ... count - 1, s; times ascend.
    double time(int frame) const { return frames_.at(static_cast<std::size_t>(frame)).time; }
    /// The frame nearest to a time, s, of equals the earlier one.
    int nearest_frame(double time) const;
    /// Throws SceneError for a mesh that cannot be read, a field that its frame lacks (and how to get it).
    ShownFrame load(int frame);
    /// What is left out of the files, such as their own motion.
    const std::vector<Finding>& warnings() const { return warnings_; }
    /// For titles: the folder's or the first file's name.
    const std::string& name() const { return name_; }

private:
    struct Shape {
        std::string file, ply_file, name;  // ply_file: of the same mesh, with fields; may be ""
        bool is_cloth = true;
    };
    struct Frame {
        int index = 0;
        double time = 0.0;
        std::vector<Shape> shapes;
    };

    FrameSource(std::string name, bool is_run, const ShownChoice& choice)
        : name_(std::move(name)), is_run_(is_run), choice_(choice) {}
    void check_names() const;
    const TriangleMesh& body(const std::string& file, std::map<std::string, TriangleMesh>& used);
    std::vector<double> field_of(const Shape& shape, const TriangleMesh& cloth, const ShownFrame& frame) const;
    void colour(ShownFrame& frame) const;

    std::string name_;
    bool is_run_;
    ShownChoice choice_;
    std::vector<Frame> frames_;
    std::vector<Finding> warnings_;
    std::map<std::string, TriangleMesh> bodies_;  // of the frame that was read last: a resting one is read once
};

}  // namespace percale::scenes
