#include "bodies/body_shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "bodies/mesh_sequence.h"
#include "bodies/point_cache.h"
#include "bodies/skin_clip.h"
#include "common/text.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Fraction of the body's diagonal. In a loop the last shape is the first one where no vertex is farther off. 0: rounding of a
/// file adds a frame that stands still.
constexpr double same_shape = 1e-4;

std::unique_ptr<ShapeSource> open_source(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings) {
    if (int{obstacle.frames.has_value()} + int{!obstacle.cache.empty()} + int{obstacle.clip.has_value()} > 1)
        throw SceneError("frames, cache and clip exclude each other");
    if (obstacle.weld > 0.0) throw SceneError("weld joins vertices of a mesh that stays as it is, not of frames, cache or clip");
    if (obstacle.frames) return std::make_unique<MeshSequence>(scene, obstacle, warnings);
    if (!obstacle.cache.empty()) return std::make_unique<PointCache>(scene, obstacle, warnings);
    return std::make_unique<SkinClip>(scene, obstacle);
}

/// The shape at which the lead-in starts.
std::vector<Vec3> start_of(const Scene& scene, const ObstacleSpec& obstacle, const TriangleMesh& mesh) {
    if (obstacle.start_mesh.empty()) {
        if (obstacle.frames) throw SceneError("lead_in of frames needs start_mesh, the mesh that it starts from");
        return mesh.vertices;
    }
    check_keeps_vertices(obstacle.mesh, "start meshes");
    check_keeps_vertices(obstacle.start_mesh, "start meshes");
    const std::string file = path_beside(scene, obstacle.start_mesh);
    TriangleMesh start = import_mesh(file, obstacle.unit, nullptr, obstacle.part);
    check_same_triangles(start, file, mesh, obstacle.mesh);
    return std::move(start.vertices);
}

}  // namespace

BodyShapes::BodyShapes(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings)
    : source_(open_source(scene, obstacle, warnings)),
      lead_in_(obstacle.lead_in),
      from_(obstacle.play_from),
      offset_(obstacle.play_offset),
      loop_(obstacle.loop) {
    if (offset_ >= source_->length())
        throw SceneError("play_offset = " + number_text(offset_) + " s must be below the " + number_text(source_->length()) +
                         " s that are played");
    if (!obstacle.start_mesh.empty() && lead_in_ == 0.0) throw SceneError("start_mesh needs a lead_in");
    if (lead_in_ > 0.0) start_ = start_of(scene, obstacle, source_->mesh());
    const double apart = loop_ ? largest_displacement(source_->at(0.0), source_->at(source_->length())) : 0.0;
    if (apart > same_shape * diagonal(source_->mesh().vertices)) closing_ = source_->frame_time();
    first_ = source_->mesh();
    first_.vertices = at(0.0);
}

std::vector<Vec3> BodyShapes::played(double time) {
    if (!loop_) return source_->at(time);
    const double length = source_->length(), t = std::fmod(time, length + closing_);
    if (t <= length) return source_->at(t);
    return between(source_->at(length), source_->at(0.0), (t - length) / closing_);
}

std::vector<Vec3> BodyShapes::at(double time) {
    const double since = std::max(0.0, time - from_);
    if (since >= lead_in_) return played(offset_ + since - lead_in_);
    return between(start_, played(offset_), since / lead_in_);
}

double BodyShapes::end() const { return loop_ ? std::numeric_limits<double>::infinity() : once(); }

std::string BodyShapes::text() const {
    std::string text = source_->text();
    if (loop_) text += ", again and again";
    if (offset_ > 0.0) text += std::string(loop_ ? ", the first time" : "") + " without its first " + number_text(offset_) + " s";
    if (from_ > 0.0) text += ", from " + number_text(from_) + " s on";
    if (lead_in_ > 0.0) text += ", first a lead-in of " + number_text(lead_in_) + " s";
    return text;
}

void check_still(const Scene& scene, const ObstacleSpec& obstacle) {
    const auto refuse = [](bool given, const std::string& key) {
        if (given) throw SceneError(key + " needs frames = [first, last], cache or clip");
    };
    refuse(obstacle.fps.has_value(), "fps");
    refuse(!obstacle.start_mesh.empty(), "start_mesh");
    refuse(obstacle.lead_in > 0.0, "lead_in");
    refuse(obstacle.play_from > 0.0, "play_from");
    refuse(obstacle.play_offset > 0.0, "play_offset");
    refuse(obstacle.loop, "loop");
    if (obstacle.mesh.find('%') == std::string::npos || std::filesystem::exists(path_beside(scene, obstacle.mesh))) return;
    throw SceneError("mesh = \"" + obstacle.mesh + "\" names frames by %; frames = [first, last] says which");
}

}  // namespace percale::scenes
