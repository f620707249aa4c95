#include "bodies/mesh_sequence.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {

std::string FramePattern::name_of(int frame) const {
    std::string number = std::to_string(frame);
    if (static_cast<int>(number.size()) < digits) number.insert(0, static_cast<std::size_t>(digits) - number.size(), '0');
    return before + number + after;
}

FramePattern frame_pattern(const std::string& name) {
    const std::size_t start = name.find('%');
    std::size_t end = start + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    const std::string digits = start == std::string::npos ? "" : name.substr(start + 1, end - start - 1);
    const bool good = start != std::string::npos && end < name.size() && name[end] == 'd' &&
                      name.find('%', end) == std::string::npos && (digits.empty() || (digits[0] == '0' && digits.size() == 2));
    if (!good) throw SceneError("\"" + name + "\" must have one %d, or %04d, where frames have their number");
    return {name.substr(0, start), name.substr(end + 1), digits.empty() ? 0 : digits[1] - '0'};
}

MeshSequence::MeshSequence(const Scene& scene, const ObstacleSpec& obstacle, std::vector<std::string>* warnings)
    : pattern_(frame_pattern(obstacle.mesh)),
      frames_(*obstacle.frames),
      fps_(obstacle.fps.value_or(ObstacleSpec::usual_fps)),
      unit_(obstacle.unit),
      part_(obstacle.part) {
    if (frames_[0] >= frames_[1] || frames_[0] < 0) {
        throw SceneError("frames = [" + std::to_string(frames_[0]) + ", " + std::to_string(frames_[1]) +
                         "] must ascend from 0 or above");
    }
    const std::string kind = extension_of(obstacle.mesh);
    if (kind != ".obj" && kind != ".off" && kind != ".ply") {
        throw SceneError("\"" + obstacle.mesh +
                         "\": frames are OBJ, OFF or PLY files, of others vertices are joined by their places");
    }
    pattern_.before = path_beside(scene, pattern_.before);
    for (int frame = frames_[0]; frame <= frames_[1]; ++frame) {
        const std::string file = file_of(frame);
        if (!std::filesystem::exists(file)) throw SceneError(file + ": there is no such file, frame " + std::to_string(frame));
    }
    first_ = import_mesh(file_of(frames_[0]), unit_, warnings, part_);
    loaded_[0] = {frames_[0], first_.vertices};
}

std::string MeshSequence::file_of(int frame) const { return pattern_.name_of(frame); }

const std::vector<Vec3>& MeshSequence::frame(int number, int other) {
    for (const Loaded& known : loaded_) {
        if (known.frame == number) return known.vertices;
    }
    const std::string file = file_of(number);
    TriangleMesh mesh = import_mesh(file, unit_, nullptr, part_);
    if (mesh.vertices.size() != first_.vertices.size() || mesh.triangles != first_.triangles) {
        throw SceneError(file + ": " + std::to_string(mesh.vertices.size()) + " vertices and " +
                         std::to_string(mesh.triangles.size()) + " triangles, other ones than the " +
                         std::to_string(first_.vertices.size()) + " and " + std::to_string(first_.triangles.size()) + " of " +
                         file_of(frames_[0]));
    }
    Loaded& place = loaded_[0].frame == other ? loaded_[1] : loaded_[0];
    place = {number, std::move(mesh.vertices)};
    return place.vertices;
}

std::vector<Vec3> MeshSequence::at(double time) {
    const double last = frames_[1] - frames_[0], place = std::clamp(time * fps_, 0.0, last);
    const int before = std::min(static_cast<int>(place), frames_[1] - frames_[0]);
    const double share = place - before;
    const int from = frames_[0] + before, to = std::min(from + 1, frames_[1]);
    std::vector<Vec3> vertices = frame(from, to);
    if (share == 0.0) return vertices;
    const std::vector<Vec3>& next = frame(to, from);
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] += share * (next[i] - vertices[i]);
    return vertices;
}

void check_still(const Scene& scene, const ObstacleSpec& obstacle) {
    if (obstacle.fps) throw SceneError("fps needs frames = [first, last]");
    if (obstacle.mesh.find('%') == std::string::npos || std::filesystem::exists(path_beside(scene, obstacle.mesh))) return;
    throw SceneError("mesh = \"" + obstacle.mesh + "\" names frames by %; frames = [first, last] says which");
}

}  // namespace percale::scenes
