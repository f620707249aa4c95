#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "percale/cloth_pairs.h"
#include "percale/contact.h"
#include "percale/contact_load.h"
#include "percale/fabric.h"
#include "percale/mesh.h"
#include "percale/plan.h"
#include "percale/report.h"
#include "percale/rest_shape.h"
#include "percale/settings.h"
#include "percale/stitch.h"
#include "percale/workers.h"

namespace percale {

struct ClothId {
    int index = -1;
};
struct ObstacleId {
    int index = -1;
};
struct SeamId {
    int index = -1;
};

enum class TeleportVelocities { keep, clear };

struct ObstacleSettings {
    double friction = default_friction;  // Coulomb coefficient against cloth, 0 ... 10
    double restitution = 0.0;            // fraction of its normal speed that cloth keeps when it bounces off, 0 ... 1
    std::string name = "obstacle";       // for messages
    bool deforming = false;              // its vertices may move one by one; costs more contacts and more time
    /// A compliant obstacle if true: where it leaves cloth less room than 1.2 thicknesses, between it and what is on the other
    /// side, its surface gives way, as flesh does, and goes back as soon as there is room; StepReport::pinched reports it. It is
    /// then deforming. If false, the step fails there. Its mesh needs edges not much longer than a few thicknesses.
    bool yields = false;
};

/// Cloth, obstacles and their motion in time. Wrong arguments throw SceneError from the call that was wrong; a step never throws
/// for numerical trouble but returns a status. All calls to a moved-from simulation throw SceneError. One thread at a time per
/// simulation; simulations are independent.
class Simulation {
public:
    /// Without a detector, obstacles are refused. `workers` work instead of StepSettings::threads; several simulations may share
    /// them. Throws SceneError for settings or a number of threads out of range. Where workers have left out a part, or done one
    /// twice, that call throws WorkersError, and so does every later step; exceptions of the workers pass through.
    explicit Simulation(const StepSettings& settings, std::unique_ptr<ContactDetector> detector = nullptr,
                        std::shared_ptr<Workers> workers = nullptr);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Cloth starts as the mesh at `pose` (its scale included), which is also its rest shape unless `rest` gives another; only
    /// the pose's scale applies to that. `name` is used in messages.
    ClothId add_cloth(const TriangleMesh& mesh, const Fabric& fabric, const Pose& pose = {}, const std::string& name = "cloth",
                      const RestShape& rest = {});
    ObstacleId add_obstacle(const TriangleMesh& mesh, const Pose& pose = {}, const ObstacleSettings& settings = {});
    /// Removes a cloth, with its seams, pairs and layer. All other ids stay valid; its own, and those of its seams, throw
    /// SceneError in every call and are not used again. All others keep their state and their contacts; they wake up, and schemes
    /// of several steps begin anew. States saved before are refused.
    void remove_cloth(ClothId cloth);
    /// The same for an obstacle. Cloth wakes up only if the obstacle touched some: else all later steps are as if it had not
    /// existed. Throws SceneError where the detector does not support it.
    void remove_obstacle(ObstacleId obstacle);
    /// Another fabric for a cloth that keeps its mesh, rest shape, positions, velocities and pins: the coming steps are those of
    /// a simulation with that fabric in this state. All of a fabric may change, kinds of springs too. Contacts are forgotten
    /// where thickness, friction, self_contact or the order of the springs changes, or a strain limit is added or removed (the
    /// next step then checks the start, as `prepare` does); the forces of strain limits are always forgotten. Costs as much as
    /// adding a cloth. Throws SceneError as add_cloth does, and changes nothing then. States saved before are refused.
    void set_fabric(ClothId cloth, const Fabric& fabric);

    void pin(ClothId cloth, int vertex);
    void unpin(ClothId cloth, int vertex);
    /// The position of a pinned vertex at the end of the next step, m; it then stays there. The rules of move_obstacle for far
    /// motion hold for pins of cloth with contact from 80 thicknesses on, and its rule for refused starts holds for pins inside
    /// that obstacle.
    void move_pin(ClothId cloth, int vertex, const Vec3& target);
    /// The pose of an obstacle at the end of the next step; it then stays there. The scale must not change. Where obstacles move
    /// by more than 20 thicknesses beside cloth that they may meet, or turn by more than 15 degrees, the step is made in equal
    /// parts (StepReport::parts); beyond 64 it fails at once. For jumps, and for a character's first place, use `teleport`. Where
    /// `prepare` has refused the start for this obstacle, the motion takes no time.
    void move_obstacle(ObstacleId obstacle, const Pose& end);
    /// The positions of a deforming obstacle's vertices at the end of the next step, m, in the order and the axes of its mesh,
    /// before its pose. They then stay there. Each moves on a straight line. The rules for far motion hold for the farthest
    /// vertex. Vertices that the mesh has at one place must stay together.
    void deform_obstacle(ObstacleId obstacle, std::span<const Vec3> end);
    /// Coulomb coefficient of an obstacle against cloth from the next step on, 0 ... 10. Throws SceneError where the detector
    /// cannot change it.
    void set_friction(ObstacleId obstacle, double friction);
    /// ObstacleSettings::restitution from the next step on, 0 ... 1.
    void set_restitution(ObstacleId obstacle, double restitution);
    void set_gravity(const Vec3& gravity);  // m/s^2
    /// Velocity of the air, m/s; before the first call there is no air (StepSettings::wind). Drag: Fabric::drag_normal,
    /// drag_tangential, StepSettings::air_density. In an implicit step the air acts on the triangles as they lie at its start.
    void set_wind(const Vec3& velocity);
    /// Sews vertices of the first cloth to vertices, or to points between two vertices, of the second, which may be the same:
    /// springs whose rest length goes from the present distance to 0 and stays 0. Features at one stitch are never in
    /// self-contact, those near one only as if it were closed.
    SeamId add_seam(ClothId first, ClothId second, std::span<const Stitch> stitches, const SeamSettings& settings = {});
    /// Vertices to vertices, pair by pair.
    SeamId add_seam(ClothId first, ClothId second, std::span<const std::array<int, 2>> vertices,
                    const SeamSettings& settings = {});
    /// Sets the contact between two cloths with self_contact, or of such a cloth with itself, from now on; thickness: m, 1e-6 ...
    /// 1. Cloths that come to meet by that and cross are untangled by the next step, as at a start. Throws SceneError for cloth
    /// without self_contact, and for a thickness without contact.
    void set_pair(ClothId first, ClothId second, const ClothPair& pair);
    /// The layer in which self_contact cloth is worn, -1000 ... 1000, from the inside out, 0 before the first call: of cloths
    /// that cross at the start, or when seams have closed, that of the higher layer is moved outside of the other (`prepare`).
    /// They do not meet while a seam of one of them closes without contact.
    void set_layer(ClothId cloth, int layer);
    void set_time_step(double time_step);  // s, 1e-7 ... 1
    /// StepSettings::work_limit, 0 (none) ... 50000. Steps of a scene at 1/60 s take about 1 to 10 Newton iterations.
    void set_work_limit(int iterations);
    /// Wall time of a step, s, 1e-6 ... 1e6, or 0 (none, as before the first call): for hosts that have to go on. An implicit
    /// step that has used it up is accepted as it is after the present Newton iteration, each piece of it after at least two:
    /// StepReport has out_of_time, and not_converged or, of an adaptive step, tolerance_missed. Nothing crosses, pins and
    /// obstacles are at their targets, but forces are not balanced. Where pins and obstacles have not arrived after about 20 more
    /// iterations, as after a jump, the step fails (work_limit, out_of_time) and nothing moves: use `teleport` for jumps. The
    /// clock starts after the work of `prepare`. Candidate lists are always completed, so that a step takes at least their time.
    /// Explicit schemes ignore the limit: their cost is known before. Results then depend on the machine; without a limit no
    /// decision reads a clock. Not part of saved states.
    void set_time_limit(double seconds);
    /// While this is true, a step ends within a few iterations and fails (StepStatus::cancelled), nothing moves, and a start with
    /// initial penetration to be resolved is refused (StartError, from `prepare` and from the step that meets it): for hosts that
    /// have to end, from another thread or a signal handler. Null: none. It must outlive the steps. Not part of saved states.
    void set_cancel(const std::atomic<bool>* cancel);
    /// All vertices of a cloth; m and m/s, -1e9 ... 1e9. For starts that are not at rest.
    void set_positions(ClothId cloth, std::span<const Vec3> positions);
    void set_velocities(ClothId cloth, std::span<const Vec3> velocities);
    /// Puts a cloth back to where it was added, at rest; forgets its contacts and the forces of its strain limits and welds. Its
    /// pins stay, where it was added, and so do time, seams (closed ones pull it together again), fabric and layers. The next
    /// step checks its start as `prepare` does.
    void reset(ClothId cloth);
    /// Moves cloths and obstacles together by a rigid motion x -> translation + rotation x of the world (scale 1), in no time:
    /// pins, targets that no step has reached yet and the warm start of contact and seams move along; velocities turn along, or
    /// are cleared. The next step checks as `prepare` does whether they are clear of everything that did not move.
    void teleport(std::span<const ClothId> cloths, std::span<const ObstacleId> obstacles, const Pose& motion,
                  TeleportVelocities velocities = TeleportVelocities::keep);

    /// Checks the scene as a whole; the first step calls it, and so do the first step after cloth or obstacles were added,
    /// set_positions, set_pair, set_layer or teleport, and that in which seams have closed without contact. Cloth that starts
    /// through, inside or touching an obstacle, or cloth with self_contact that does so with such cloth, is moved out
    /// (StepSettings::start): its free vertices only, no structural spring longer than by half; velocities stay. Throws
    /// StartError, and changes nothing, where that is impossible or excluded by the settings, or where a pinned vertex is inside
    /// an obstacle; SceneError where the scheme supports neither.
    void prepare();
    /// The moves of the last `prepare` that found something to check, and those when seams had closed; empty where all was clear.
    std::span<const StartMove> start_repair() const;
    /// Advances by the time step. A step that fails (StepReport::ok) leaves the state as it was and keeps the targets of pins and
    /// obstacles; a long frame is best made as several steps with targets between, or common motion is teleported and the step
    /// made short. Throws the errors of `prepare`, before anything moves; where seams close in this step without contact and
    /// their cloth cannot be separated, StartError after the state before the step has been restored (where the detector can save
    /// its state; else the step is made).
    StepReport step();
    /// The parts of the coming steps, and those that are left out; runs nothing. `to_come`: later changes.
    ScenePlan plan(const ScriptedChanges& to_come = {}) const;

    double time() const;      // s
    int cloth_count() const;  // without those that were removed
    /// Views, valid until the next call that changes the simulation. m and m/s, world.
    std::span<const Vec3> positions(ClothId cloth) const;
    std::span<const Vec3> velocities(ClothId cloth) const;
    /// Lumped masses, kg.
    std::span<const double> masses(ClothId cloth) const;
    /// The vertices that are pinned, ascending.
    std::vector<int> pinned_vertices(ClothId cloth) const;
    /// Unit normals of the vertices, world: the mean of the triangles around each by area, on the side from which they run
    /// counter-clockwise. Zero where a vertex has no triangles, or its triangles have no area or cancel (to 1e-12 of their edges'
    /// squares). Costs a pass over the triangles of the cloth.
    std::vector<Vec3> normals(ClothId cloth) const;
    /// The same into memory of the caller; throws SceneError unless it has one entry per vertex.
    void normals(ClothId cloth, std::span<Vec3> out) const;
    /// From now on, for `interpolate`: each step first copies the positions, 24 B per vertex; before, and after `false`, it costs
    /// nothing. Not part of saved states.
    void keep_previous_positions(bool keep = true);
    /// The positions of the cloth, m, at a fraction, 0 ... 1, of the last step: x0 + fraction (x1 - x0), from its start to its
    /// end. For hosts that draw more often than they step; on these lines between two states cloth may cross what it crosses in
    /// neither. Present positions where there is no interval: before the first step since keep_previous_positions, after a step
    /// that failed, for cloth that was placed meanwhile (set_positions, reset, teleport, restore, move_pin after a refused start)
    /// or whose start was changed. Throws SceneError unless positions are kept, for a fraction out of range, or unless `out` has
    /// one entry per vertex.
    void interpolate(double fraction, ClothId cloth, std::span<Vec3> out) const;
    Pose obstacle_pose(ObstacleId obstacle) const;
    /// The positions of the vertices of an obstacle's mesh before its pose, m; none of a rigid one; with the deflections of a
    /// compliant one.
    std::span<const Vec3> obstacle_shape(ObstacleId obstacle) const;
    /// Energies of the current state, J; `work` is 0.
    StepEnergy energy() const;
    /// Largest strain of structural springs, (l - l0)/l0, in the current state; 0 without any.
    double largest_strain() const;
    double largest_strain(ClothId cloth) const;
    /// The forces of obstacles on the vertices of a cloth at the end of the last solved step, friction included: sorted by vertex
    /// and obstacle, without vertices that nothing presses. For a step in substeps they are those at the end of the last one.
    /// Empty before the first step, after a failed one, set_positions, reset and teleport. Costs nothing unless it is called.
    std::vector<ContactLoad> contact_loads(ClothId cloth) const;
    /// The force of all cloth on an obstacle, N: the sum of those forces with the other sign. Cloth at rest that nothing else
    /// holds presses with its weight.
    Vec3 force_on(ObstacleId obstacle) const;
    /// Torque of the same forces about a point (m, world), N m: the sum of (ContactLoad::cloth_point - about) x force. They act
    /// at their points on the cloth's middle surface, so that body and cloth keep their angular momentum.
    Vec3 torque_on(ObstacleId obstacle, const Vec3& about) const;
    /// From now on, for `impulse_on`: steps sum the impulses of each contact; no other result of theirs changes. Before, and
    /// after `false`, it costs nothing. Not part of saved states.
    void keep_impulses(bool keep = true);
    /// The impulse of all cloth on an obstacle in the last step, N s: the forces of every piece of the step times its length, and
    /// impacts. A host applies it to its rigid body, so that body and cloth keep their momentum. Zero before the first step since
    /// keep_impulses, after one that failed and after `restore`. Throws SceneError unless impulses are kept.
    Vec3 impulse_on(ObstacleId obstacle) const;
    /// The angular momentum of the same about a point (m, world), N m s, with the cloth at its positions at the end of each
    /// piece.
    Vec3 angular_impulse_on(ObstacleId obstacle, const Vec3& about) const;
    /// Whether two cloths, or a cloth with itself, meet now: both have self_contact, set_pair does not keep them apart, and no
    /// seam that joins them closes without contact (SeamSettings::contact_while_closing).
    bool meets(ClothId first, ClothId second) const;
    /// The distances of the sides of each stitch, m, in the order in which they were given.
    std::vector<double> seam_gaps(SeamId seam) const;
    /// The largest speed of a vertex, m/s.
    double largest_speed() const;
    /// Depends on every bit of positions and velocities.
    std::uint64_t state_hash() const;

    /// All that the coming steps depend on, as bytes; changes nothing. A simulation made by the same calls that reads them by
    /// `restore` makes the same steps in every bit, whatever its number of threads and its kind of tree. They hold gravity, wind
    /// and time step, but only what identifies cloth, seams, obstacles and other settings; numbers have the layout of this
    /// machine. Throws SceneError where the detector cannot save its state.
    std::vector<std::byte> save() const;
    /// Throws SceneError, and changes nothing, where the bytes are cut off, damaged, of another version of this format, or of a
    /// simulation with other cloth, pairs, seams, obstacles or settings (`threads`, `start`, `check_derivatives` and `work_limit`
    /// may differ).
    void restore(std::span<const std::byte> saved);

private:
    struct Implementation;
    /// Throws SceneError where nothing is owned: a moved-from simulation can only be assigned to or destroyed.
    struct Owner {
        std::unique_ptr<Implementation> owned;
        Implementation* operator->() const;
    };
    Owner implementation_;
};

}  // namespace percale
