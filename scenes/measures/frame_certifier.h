#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "measures/measures.h"
#include "percale/certify.h"

namespace percale::scenes {

/// The shapes of one frame, in the same order in all frames.
struct CertifiedShapes {
    std::span<const TriangleMesh> cloths, obstacles;  // m, world
    std::span<const ClothStitches> seams;
    std::span<const std::array<int, 2>> meeting;  // pairs of cloths that meet
};

/// Makes the certificates of frames one after the other. Bodies that stand still keep their trees, moving shapes the form of
/// theirs, and what has not moved since the last frame is not tested again. The results are those of certify and certify_cloth.
class FrameCertifier {
public:
    /// `distance_limits`: of certify, for each cloth, m.
    explicit FrameCertifier(std::vector<double> distance_limits) : distance_limits_(std::move(distance_limits)) {}

    /// Throws as certify does, CertificateCancelled where `cancel` asks for it; the next call tests everything.
    FrameCheck check(const CertifiedShapes& shapes, const std::atomic<bool>* cancel = nullptr);

private:
    /// A mesh of the frames, and whether it moved since the last one.
    struct Shape {
        CertificateMesh mesh;
        bool moved = true;
    };
    static void take(std::span<const TriangleMesh> meshes, std::vector<Shape>& shapes);
    void check_meeting(const CertifiedShapes& shapes, const std::atomic<bool>* cancel);

    std::vector<double> distance_limits_;
    std::vector<Shape> cloths_, obstacles_;
    std::vector<Certificate> with_obstacles_;  // of each cloth with each obstacle
    std::optional<CertificateMesh> joined_;    // the cloths that meet, as one mesh
    ClothCertificate between_cloths_;
    std::vector<Stitch> stitches_;  // of between_cloths_
    PairsOfCloths meeting_;         // likewise
    bool known_ = false;            // the certificates are those of the last frame
};

}  // namespace percale::scenes
