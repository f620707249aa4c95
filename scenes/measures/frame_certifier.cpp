#include "measures/frame_certifier.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace percale::scenes {

void FrameCertifier::take(std::span<const TriangleMesh> meshes, std::vector<Shape>& shapes) {
    if (shapes.size() != meshes.size()) {
        shapes.clear();
        for (const TriangleMesh& mesh : meshes) shapes.push_back({CertificateMesh(mesh)});
        return;
    }
    for (std::size_t i = 0; i < meshes.size(); ++i) shapes[i].moved = shapes[i].mesh.move(meshes[i]);
}

FrameCheck FrameCertifier::check(const CertifiedShapes& shapes, const std::atomic<bool>* cancel) {
    // Without obstacles nothing of a cloth is needed.
    const std::span<const TriangleMesh> cloths = shapes.obstacles.empty() ? std::span<const TriangleMesh>() : shapes.cloths;
    const std::size_t pairs = cloths.size() * shapes.obstacles.size();
    const bool known = std::exchange(known_, false) && with_obstacles_.size() == pairs && cloths_.size() == cloths.size();
    if (!known) cloths_.clear();
    if (!known) obstacles_.clear();
    take(cloths, cloths_);
    take(shapes.obstacles, obstacles_);
    with_obstacles_.resize(pairs);
    FrameCheck check;
    std::size_t pair = 0;
    for (std::size_t cloth = 0; cloth < cloths_.size(); ++cloth) {
        for (const Shape& obstacle : obstacles_) {
            if (cloths_[cloth].moved || obstacle.moved)
                with_obstacles_[pair] = certify(cloths_[cloth].mesh, obstacle.mesh, distance_limits_[cloth], cancel);
            add_certificate(check, with_obstacles_[pair++]);
        }
    }
    if (!shapes.meeting.empty()) {
        if (!known) joined_.reset();
        check_meeting(shapes, cancel);
        add_cloth_certificate(check, between_cloths_);
    }
    known_ = true;
    return check;
}

void FrameCertifier::check_meeting(const CertifiedShapes& shapes, const std::atomic<bool>* cancel) {
    MeetingMesh joined = joined_meeting_cloth(shapes.cloths, shapes.seams, shapes.meeting);
    bool same = joined_ && !joined_->move(joined.mesh);
    if (!joined_) joined_.emplace(joined.mesh);
    same = same && joined.stitches == stitches_ && std::ranges::equal(shapes.meeting, meeting_);
    if (same) return;
    between_cloths_ = certify_cloth(*joined_, joined.stitches, {joined.owner, &joined.pairs}, cancel);
    stitches_ = std::move(joined.stitches);
    meeting_.assign(shapes.meeting.begin(), shapes.meeting.end());
}

}  // namespace percale::scenes
