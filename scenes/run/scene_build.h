#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bodies/body_shapes.h"
#include "format/scene.h"
#include "garment/seam_stitches.h"
#include "pattern/pattern_mesh.h"
#include "percale/cleaning.h"
#include "percale/plan.h"
#include "percale/simulation.h"

namespace percale::scenes {

struct BuiltSeam {
    std::string name;
    ClothStitches sewn;
    double closed_at = 0.0;  // s
    SeamId id = {};
};

/// A scene with its meshes read and its simulation made.
struct BuiltScene {
    Scene scene;
    Simulation simulation;
    std::vector<ClothId> cloths;                           // in the order of scene.cloths
    std::vector<TriangleMesh> cloth_meshes;                // as they start, in world coordinates
    std::vector<RestShape> rest_shapes;                    // where they have no strain
    std::vector<ObstacleId> obstacles;                     // in the order of scene.obstacles
    std::vector<TriangleMesh> obstacle_meshes;             // in their own coordinates, unit applied, pose not; as they start
    std::vector<std::shared_ptr<BodyShapes>> shapes = {};  // of each obstacle; null: it is rigid
    std::vector<std::vector<SewnSeam>> pattern_seams;      // of each cloth; of one without a pattern none
    std::vector<BuiltSeam> seams;               // in the order of scene.seams, a pattern's each apart; then those of patterns
    std::vector<Finding> warnings;              // what is not quite as the scene file says
    std::optional<ScenePlan> plan = {};         // before the first step, where it was kept (scene_plan.h)
    std::vector<CleaningReport> cleaning = {};  // of each obstacle, likewise
};

/// Makes a detector; null for `none`.
std::unique_ptr<ContactDetector> make_detector(Detector detector);

/// An obstacle as it stands now, m, world.
TriangleMesh obstacle_now(const BuiltScene& built, std::size_t obstacle);

/// Warnings of cloth that would have torn at the largest strain of a run, and of cloth that is now strained beyond its
/// strain_limit by more than a tenth of it.
std::vector<Finding> strain_warnings(const BuiltScene& built, double largest_strain);

/// Warnings of garments that are tight now: one that is too small for a body fits it all the same, springs stretch as far as they
/// have to. Cloth that is pinned or filled is stretched by that, and a grid is no garment. `scale`: what makes it larger.
std::vector<Finding> tight_warnings(const BuiltScene& built, const std::string& scale);

/// The stitch that is farthest open.
struct WidestGap {
    std::size_t stitches = 0;  // of all seams
    double width = 0.0;        // m
    std::string seam = {}, garment = {};
    Vec3 place = Vec3::Zero();  // m, of its vertex
};
WidestGap widest_gap(const BuiltScene& built);

/// Its width, m; nothing without seams.
std::optional<double> largest_seam_gap(const BuiltScene& built);

/// The message to users about a gap that is too wide.
std::string unsewn_text(const WidestGap& gap);

/// Warnings of seams that should have closed and are open by more than `widest_sewn_gap`.
std::vector<Finding> seam_warnings(const BuiltScene& built);

/// The stitches of all seams.
std::vector<ClothStitches> sewn_stitches(const BuiltScene& built);

/// The mesh of an obstacle with its unit applied, its pose not; not yet checked (check_mesh). Throws SceneError for a file that
/// cannot be read.
TriangleMesh obstacle_mesh(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings = nullptr);

/// Reads meshes, selects pins, makes the detector and the simulation, and checks the start (Simulation::prepare), which may move
/// cloth out of obstacles. Throws SceneError with the place of the cloth, obstacle, event or key in the scene file; where the
/// start is the trouble, StartRefused (start_fault.h). Where step.measure is automatic it becomes `all` if [expect] reads it.
/// `cancel`: Simulation::set_cancel, while the start is repaired.
BuiltScene build_scene(const Scene& given, const std::atomic<bool>* cancel = nullptr);

}  // namespace percale::scenes
