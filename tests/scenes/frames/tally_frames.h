#pragma once

#include <cstdio>
#include <ostream>

#include "scenes/frames/frame_folder.h"
#include "scenes/frames/frame_format.h"

namespace percale::scenes::test {

inline constexpr const char* tally_file = "frames/all.tally";

/// A format with one file for the whole run: how many frames there are, in five digits, then a line for each with its number,
/// its time and the height of the first vertex of every mesh.
class TallyFrames final : public FrameEncoder {
public:
    explicit TallyFrames(const FrameCast& cast) : cast_(cast) {}

    FrameFiles write(const FrameShapes& frame, FrameFolder& folder) override {
        std::ostream& out = folder.grown(tally_file);
        if (frame.index == 0) out << "00000\n";
        out << frame.index << " " << frame.time;
        for (const auto meshes : {frame.cloths, frame.obstacles})
            for (const TriangleMesh& mesh : meshes) out << " " << mesh.vertices.front().y();
        out << "\n";
        return {std::vector<std::string>(cast_.cloths.size(), tally_file),
                std::vector<std::string>(cast_.obstacles.size(), tally_file)};
    }

    void finish(std::span<const double> times, FrameFolder& folder) override {
        char count[16];
        std::snprintf(count, sizeof count, "%05zu", times.size());
        folder.grown(tally_file).seekp(0) << count;
    }

    int first_frame_of(const std::string& name) const override { return name == tally_file ? 0 : -1; }

private:
    FrameCast cast_;
};

inline FrameFormat tally_frames() {
    return {.word = "tally",
            .sentence = "one file",
            .endings = {".tally"},
            .bytes =
                [](const MeshCounts&) {
                    return FrameBytes{0.0, 10.0};
                },
            .make = [](const FrameCast& cast) { return std::make_unique<TallyFrames>(cast); }};
}

}  // namespace percale::scenes::test
