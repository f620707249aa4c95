#include "bodies/mesh_sequence.h"

#include <cctype>
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

MeshSequence::MeshSequence(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings)
    : pattern_(frame_pattern(obstacle.mesh)), first_frame_((*obstacle.frames)[0]), unit_(obstacle.unit), part_(obstacle.part) {
    const int last = (*obstacle.frames)[1];
    if (first_frame_ >= last || first_frame_ < 0) {
        throw SceneError("frames = [" + std::to_string(first_frame_) + ", " + std::to_string(last) +
                         "] must ascend from 0 or above");
    }
    check_keeps_vertices(obstacle.mesh, "frames");
    pattern_.before = path_beside(scene, pattern_.before);
    set_equal_times(last - first_frame_ + 1, obstacle.fps.value_or(ObstacleSpec::usual_fps));
    for (int frame = first_frame_; frame <= last; ++frame) {
        const std::string file = pattern_.name_of(frame);
        if (!std::filesystem::exists(file)) throw SceneError(file + ": there is no such file, frame " + std::to_string(frame));
    }
    first_ = import_mesh(file_of(0), unit_, warnings, part_);
}

std::vector<Vec3> MeshSequence::load(int sample) const {
    TriangleMesh mesh = import_mesh(file_of(sample), unit_, nullptr, part_);
    check_same_triangles(mesh, file_of(sample), first_, file_of(0));
    return std::move(mesh.vertices);
}

void check_same_triangles(const TriangleMesh& mesh, const std::string& file, const TriangleMesh& first,
                          const std::string& first_file) {
    if (mesh.vertices.size() == first.vertices.size() && mesh.triangles == first.triangles) return;
    throw SceneError(file + ": " + std::to_string(mesh.vertices.size()) + " vertices and " +
                     std::to_string(mesh.triangles.size()) + " triangles, other ones than the " +
                     std::to_string(first.vertices.size()) + " and " + std::to_string(first.triangles.size()) + " of " +
                     first_file);
}

void check_keeps_vertices(const std::string& mesh, const std::string& what) {
    const std::string kind = extension_of(mesh);
    if (kind == ".obj" || kind == ".off" || kind == ".ply") return;
    throw SceneError("\"" + mesh + "\": " + what +
                     " are for OBJ, OFF or PLY files, of others vertices are joined by their places");
}

}  // namespace percale::scenes
