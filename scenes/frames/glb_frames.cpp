#include "frames/glb_frames.h"

#include "frames/frame_folder.h"
#include "frames/morph_glb.h"

namespace percale::scenes {

namespace {

constexpr const char *glb_file = "frames/scene.glb", *glb_samples_file = "frames/scene.glb.samples";

/// All that is in the file is known only at the end of the run, so that the shapes are kept in a file of their own
/// (MorphSamples).
class GlbFrames final : public FrameEncoder {
public:
    explicit GlbFrames(const FrameCast& cast) : cast_(cast) {}

    FrameFiles write(const FrameShapes& frame, FrameFolder& folder) override {
        std::ostream& out = folder.grown(glb_samples_file);
        if (frame.index == 0) {
            out << morph_header(shapes_of(frame));
        }
        out << morph_frame(shapes_of(frame));
        return {std::vector<std::string>(cast_.cloths.size(), glb_file),
                std::vector<std::string>(cast_.obstacles.size(), glb_file)};
    }

    void finish(std::span<const double> times, FrameFolder& folder) override {
        if (times.empty()) return;
        const std::string samples = folder.scratch(glb_samples_file);
        folder.write(glb_file, [&](const std::string& path) { write_morph_glb(path, samples, names(), times); });
    }

    int first_frame_of(const std::string& name) const override { return name == glb_file || name == glb_samples_file ? 0 : -1; }
    bool is_made_at_end(const std::string& name) const override { return name == glb_file; }

private:
    std::vector<MorphShape> shapes_of(const FrameShapes& frame) const {
        std::vector<MorphShape> shapes;
        for (const TriangleMesh& mesh : frame.cloths) shapes.push_back({&mesh, true});
        for (std::size_t i = 0; i < frame.obstacles.size(); ++i) shapes.push_back({&frame.obstacles[i], cast_.obstacle_moves[i]});
        return shapes;
    }

    std::vector<MorphName> names() const {
        std::vector<MorphName> names;
        for (const std::string& cloth : cast_.cloths) names.push_back({cloth, true});
        for (const std::string& obstacle : cast_.obstacles) names.push_back({obstacle, false});
        return names;
    }

    FrameCast cast_;
};

}  // namespace

FrameFormat glb_frames() {
    return {.word = "glb",
            .sentence = "one glTF file whose animation morphs, single precision (three.js, Blender, viewers)",
            .endings = {".glb", ".samples"},
            .bytes =
                [](const MeshCounts& mesh) {
                    return FrameBytes{12.0 * mesh.triangles, morph_bytes_a_vertex * mesh.vertices};
                },
            .make = [](const FrameCast& cast) { return std::make_unique<GlbFrames>(cast); }};
}

}  // namespace percale::scenes
