#include "page/mesh_track.h"

#include <algorithm>
#include <cmath>

#include "common/bytes.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

void check_same_mesh(const std::string& file, const TriangleMesh& mesh, const TriangleMesh& first) {
    const auto differs = [&](const char* what, std::size_t has, std::size_t had) {
        if (has != had)
            throw SceneError(file + ": has " + std::to_string(has) + " " + what + ", but " + std::to_string(had) +
                             " in frame 0 of the run");
    };
    differs("vertices", mesh.vertices.size(), first.vertices.size());
    differs("triangles", mesh.triangles.size(), first.triangles.size());
    if (mesh.triangles != first.triangles) throw SceneError(file + ": its triangles are not those of frame 0 of the run");
}

std::string packed_bytes(const std::vector<float>& values, const PackRange& range) {
    std::string bytes;
    bytes.reserve(2 * values.size());
    for (const float value : values) append_little(bytes, packed(value, range));
    return bytes;
}

/// x, y and z of each vertex in turn.
std::string packed_positions(const std::array<std::vector<float>, 3>& axes, const std::array<PackRange, 3>& ranges) {
    std::string bytes;
    bytes.reserve(6 * axes[0].size());
    for (std::size_t v = 0; v < axes[0].size(); ++v)
        for (std::size_t k = 0; k < 3; ++k) append_little(bytes, packed(axes[k][v], ranges[k]));
    return bytes;
}

std::string corner_bytes(const std::vector<Triangle>& triangles) {
    std::string bytes;
    bytes.reserve(12 * triangles.size());
    for (const Triangle& triangle : triangles)
        for (const int corner : triangle) append_little(bytes, static_cast<std::uint32_t>(corner));
    return bytes;
}

/// The value that a fraction `share` of the finite values does not exceed; 0 without any.
double value_at_share(std::vector<float> values, double share) {
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    if (values.empty()) return 0.0;
    const auto place = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

MeshTrack::MeshTrack(PlaybackMesh described, TriangleMesh first, std::vector<std::string> own_fields)
    : described_(std::move(described)), first_(std::move(first)), own_fields_(std::move(own_fields)) {
    described_.vertices = first_.vertices.size();
    described_.triangles = first_.triangles.size();
}

void MeshTrack::add(const std::string& file, const TriangleMesh& mesh, const std::vector<MeshField>& fields) {
    check_same_mesh(file, mesh, first_);
    std::vector<std::string> names;
    for (const MeshField& field : fields) names.push_back(field.name);
    if (empty_) {
        names_ = names;
        values_.resize(names.size());
        empty_ = false;
    }
    if (names != names_) throw SceneError(file + ": has other fields of vertices than frame 0 of the run");
    for (const Vec3& x : mesh.vertices)
        for (std::size_t k = 0; k < 3; ++k) axes_[k].push_back(static_cast<float>(x[static_cast<int>(k)]));
    for (std::size_t i = 0; i < fields.size(); ++i)
        for (const double value : fields[i].values) values_[i].push_back(static_cast<float>(value));
}

PlaybackMesh MeshTrack::packed_mesh() const {
    PlaybackMesh mesh = described_;
    for (std::size_t k = 0; k < 3; ++k) mesh.axes[k] = range_of(axes_[k]);
    mesh.corners = base64(corner_bytes(first_.triangles));
    mesh.positions = base64(packed_positions(axes_, mesh.axes));
    for (std::size_t i = 0; i < names_.size(); ++i) {
        const PackRange range = range_of(values_[i]);
        mesh.fields.push_back({.name = names_[i],
                               .of_frames = std::find(own_fields_.begin(), own_fields_.end(), names_[i]) == own_fields_.end(),
                               .range = range,
                               .low = value_at_share(values_[i], 0.02),
                               .high = value_at_share(values_[i], 0.98),
                               .values = base64(packed_bytes(values_[i], range))});
    }
    return mesh;
}

std::vector<double> edge_change(const TriangleMesh& first, const std::vector<Vec3>& now) {
    std::vector<double> sum(now.size(), 0.0);
    std::vector<int> count(now.size(), 0);
    for (const Triangle& triangle : first.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = triangle[k], b = triangle[(k + 1) % 3];
            const double before = (first.vertices[a] - first.vertices[b]).norm();
            if (!(before > 0.0)) continue;
            const double change = ((now[a] - now[b]).norm() - before) / before;
            for (const int v : {a, b}) sum[v] += change, ++count[v];
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = count[v] > 0 ? sum[v] / count[v] : 0.0;
    return sum;
}

}  // namespace percale::scenes
