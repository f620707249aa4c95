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
    double friction = 0.3;          // Coulomb coefficient against cloth, 0 ... 10
    double restitution = 0.0;       // share of its normal speed with which cloth that hits it leaves, 0 ... 1
    std::string name = "obstacle";  // for messages
    bool deforming = false;         // its vertices may move one by one; costs contacts more, and time
    /// What happens where it leaves cloth less room than 1.2 thicknesses, between it and what is on the other side. False: the
    /// step fails. True: its surface gives way there, as flesh does, and goes back as soon as there is room; StepReport::pinched
    /// tells. It is deforming then. Its mesh needs edges not much longer than a few thicknesses.
    bool yields = false;
};

/// Cloth, obstacles and their motion in time. Wrong arguments throw SceneError from the call that was wrong; a step never
/// throws for numerical trouble but returns a status. All calls to a simulation that was moved from throw SceneError. One thread
/// at a time per simulation; simulations are independent.
class Simulation {
public:
    /// Without a detector, obstacles are refused. `workers` do the work instead of StepSettings::threads, several simulations may
    /// share them. Throws SceneError for settings or a number of threads out of range. Where they have left out a part, or done
    /// one twice, the call in which they did throws WorkersError, and so does every step from then on; what they throw passes
    /// through.
    explicit Simulation(const StepSettings& settings, std::unique_ptr<ContactDetector> detector = nullptr,
                        std::shared_ptr<Workers> workers = nullptr);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Cloth starts as the mesh at `pose` (its scale included), which is its rest shape, too, unless `rest` says another: of that
    /// the pose's scale is taken alone. `name` is used in messages.
    ClothId add_cloth(const TriangleMesh& mesh, const Fabric& fabric, const Pose& pose = {}, const std::string& name = "cloth",
                      const RestShape& rest = {});
    ObstacleId add_obstacle(const TriangleMesh& mesh, const Pose& pose = {}, const ObstacleSettings& settings = {});
    /// Takes a cloth out, with its seams, pairs and layer. All other ids stay good; its own, and those of its seams, throw
    /// SceneError in every call and are not given again. What is left keeps its state and its contacts; it wakes up, and schemes
    /// of several steps begin anew. States saved before are refused.
    void remove_cloth(ClothId cloth);
    /// The same of an obstacle. Cloth wakes up only if it touched some: else all later steps are those that would have been
    /// without it. Throws SceneError where the detector cannot do it.
    void remove_obstacle(ObstacleId obstacle);
    /// Another fabric for a cloth whose mesh, rest shape, positions, velocities and pins stay: the coming steps are those of a
    /// simulation with that fabric that was given this state. Everything of a fabric may change, kinds of springs too. Contacts
    /// are forgotten where thickness, friction, self_contact or the order of the springs changes, or a strain limit comes or goes
    /// (the next step checks the start then, as `prepare` does), what its strain limits hold with always. Costs as much as adding
    /// a cloth. Throws SceneError as add_cloth does, and leaves everything as it was. States saved before are refused.
    void set_fabric(ClothId cloth, const Fabric& fabric);

    void pin(ClothId cloth, int vertex);
    void unpin(ClothId cloth, int vertex);
    /// Where a pinned vertex is at the end of the next step, m; it then stays there. What is said of far motion at move_obstacle
    /// holds for pins of cloth with contact from 80 thicknesses on, and what is said of refused starts for pins inside that
    /// obstacle.
    void move_pin(ClothId cloth, int vertex, const Vec3& target);
    /// Where an obstacle is at the end of the next step; it then stays there. The scale must not change. Where obstacles move by
    /// more than 20 thicknesses beside cloth that they may meet, or turn by more than 15 degrees, the step is made in equal parts
    /// (StepReport::parts); beyond 64 it fails at once. What jumps is no motion, nor is a character's first place: `teleport`.
    /// Where `prepare` has refused the start for this obstacle, it is there at once.
    void move_obstacle(ObstacleId obstacle, const Pose& end);
    /// Where the vertices of a deforming obstacle are at the end of the next step, m, in the order and the axes of its mesh: its
    /// pose comes on top. They then stay there. In between each runs straight. What is said of far motion holds for its farthest
    /// vertex. Vertices that the mesh has at one place have to stay together.
    void deform_obstacle(ObstacleId obstacle, std::span<const Vec3> end);
    /// Coulomb coefficient of an obstacle against cloth from the next step on, 0 ... 10. Throws SceneError where the detector
    /// cannot change it.
    void set_friction(ObstacleId obstacle, double friction);
    /// ObstacleSettings::restitution from the next step on, 0 ... 1.
    void set_restitution(ObstacleId obstacle, double restitution);
    void set_gravity(const Vec3& gravity);  // m/s^2
    /// Velocity of the air, m/s; before the first call there is no air (StepSettings::wind). Drag: Fabric::drag_normal,
    /// drag_tangential, StepSettings::air_density. In an implicit step triangles meet the air as they lay at its start.
    void set_wind(const Vec3& velocity);
    /// Sews vertices of the first cloth to vertices, or to points between two vertices, of the second, which may be the same:
    /// springs whose rest length goes from the distance of now to 0 and stays 0. What is at one stitch is never in self-contact,
    /// what is near one only as if it were closed.
    SeamId add_seam(ClothId first, ClothId second, std::span<const Stitch> stitches, const SeamSettings& settings = {});
    /// Vertices to vertices, pair by pair.
    SeamId add_seam(ClothId first, ClothId second, std::span<const std::array<int, 2>> vertices,
                    const SeamSettings& settings = {});
    /// What two cloths with self_contact, or such a cloth with itself, are to each other from now on; thickness: m, 1e-6 ... 1.
    /// Cloths that come to meet by that and cross are untangled by the next step, as at a start. Throws SceneError for cloth
    /// without self_contact, and for a thickness without contact.
    void set_pair(ClothId first, ClothId second, const ClothPair& pair);
    /// Where self_contact cloth is worn, -1000 ... 1000, from the inside out, 0 before the first call: of cloths that start
    /// through each other, or do when seams have closed, that of the higher layer is moved outside of the other (`prepare`).
    /// They do not meet while a seam of one of them closes without contact.
    void set_layer(ClothId cloth, int layer);
    void set_time_step(double time_step);  // s, 1e-7 ... 1
    /// StepSettings::work_limit, 0 (none) ... 50000. Steps of a scene at 1/60 s take some 1 to 10 Newton iterations.
    void set_work_limit(int iterations);
    /// Wall time of a step, s, 1e-6 ... 1e6, or 0 (none, as before the first call): for hosts that have to go on. An implicit
    /// step that has used it up is taken as it is after the Newton iteration under way, each piece of it after one at least:
    /// StepReport says out_of_time, and not_converged or, of an adaptive step, tolerance_missed. Nothing crosses, pins and
    /// obstacles are where they go; what is missing is that the cloth gave way to all forces. Where these have not arrived after
    /// some 20 iterations more, as after a jump, the step fails (work_limit, out_of_time), nothing moves: `teleport` what jumped.
    /// The clock starts when `prepare` has done what is to do. Near lists are made whole, so that a step takes at least their
    /// time. Explicit schemes do not look at it: what their steps cost is known before. Results then depend on the machine;
    /// without it no decision reads a clock. Not part of saved states.
    void set_time_limit(double seconds);
    /// While this is true, a step ends within a few iterations of what it is at and fails (StepStatus::cancelled), nothing moves,
    /// and a start that would have to be repaired is refused (StartError, from `prepare` and from the step that comes upon it):
    /// for hosts that have to go, from another thread or a signal handler. Null: none. It must outlive the steps. Not part of
    /// saved states.
    void set_cancel(const std::atomic<bool>* cancel);
    /// All vertices of a cloth; m and m/s, -1e9 ... 1e9. For starts that are not at rest.
    void set_positions(ClothId cloth, std::span<const Vec3> positions);
    void set_velocities(ClothId cloth, std::span<const Vec3> velocities);
    /// Puts a cloth back to where it was added, at rest; forgets its contacts, and what its strain limits and welds hold with.
    /// Pins stay, where it was added, and so do time, seams (closed ones pull it together again), fabric and layers. The next
    /// step checks its start as `prepare` does.
    void reset(ClothId cloth);
    /// Moves cloths and obstacles together by a rigid motion x -> translation + rotation x of the world (scale 1), in no time:
    /// pins, targets that no step has reached yet and all that contact and seams remember go along; velocities turn along, or are
    /// cleared. The next step checks as `prepare` does whether they are clear of what did not move.
    void teleport(std::span<const ClothId> cloths, std::span<const ObstacleId> obstacles, const Pose& motion,
                  TeleportVelocities velocities = TeleportVelocities::keep);

    /// Checks the scene as a whole; the first step calls it, the first after cloth or obstacles were added, set_positions,
    /// set_pair, set_layer or teleport, and that in which seams have closed without contact. Cloth that
    /// starts through, inside or touching an obstacle, or cloth with self_contact that does so with such cloth, is moved out
    /// (StepSettings::start): its free vertices only, no structural spring longer than by half; velocities stay. Throws
    /// StartError, and leaves everything as it was, where that is not possible or not wanted, or where a pinned vertex is inside
    /// an obstacle; SceneError where the scheme takes neither.
    void prepare();
    /// What the last `prepare` that found something to check moved, and what was when seams had closed; empty where all was
    /// clear.
    std::span<const StartMove> start_repair() const;
    /// Advances by the time step. A step that fails (StepReport::ok) leaves the state as it was and keeps the targets of pins and
    /// obstacles; a long frame is best made as several steps with targets between, or what all moves together is teleported and
    /// the step made short. Throws what `prepare` does, before anything moves; where seams close in this step without
    /// contact and their cloth does not come apart, StartError after all has been put back as it was before the step
    /// (where the detector can save its state; else the step is made).
    StepReport step();
    /// What the coming steps are made of and what is left out; runs nothing. `to_come`: what will change later on.
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
    /// Unit normals of the vertices, world: of the triangles around each the mean by area, on the side from which they run
    /// counter-clockwise. Zero at a vertex without triangles, or whose triangles have no area or cancel (to 1e-12 of their edges'
    /// squares): there is none. Costs a pass over the triangles of the cloth.
    std::vector<Vec3> normals(ClothId cloth) const;
    /// The same into memory of the caller's; throws SceneError unless it has one entry a vertex.
    void normals(ClothId cloth, std::span<Vec3> out) const;
    /// From now on, for `interpolate`: each step first notes where the cloth is, a copy of 24 B a vertex; until then, and after
    /// `false`, it costs nothing. Not part of saved states.
    void keep_previous_positions(bool keep = true);
    /// Where the cloth is, m, at a fraction, 0 ... 1, of the last step: x0 + fraction (x1 - x0), from before it to now. For hosts
    /// that draw more often than they step; lines between two states, along which cloth may cross what it did not cross in
    /// either. Present positions where nothing lies between: before the first step since keep_previous_positions, after a step
    /// that failed, for cloth that was placed meanwhile (set_positions, reset, teleport, restore, move_pin after a refused start)
    /// or whose start was repaired. Throws SceneError unless positions are kept, for a fraction out of range, or unless `out` has
    /// one entry a vertex.
    void interpolate(double fraction, ClothId cloth, std::span<Vec3> out) const;
    Pose obstacle_pose(ObstacleId obstacle) const;
    /// Where the vertices of an obstacle's mesh are before its pose, m, those of a rigid one none; of one that yields as they
    /// have given way.
    std::span<const Vec3> obstacle_shape(ObstacleId obstacle) const;
    /// Energies of the current state, J; `work` is 0.
    StepEnergy energy() const;
    /// Of structural springs, (l - l0)/l0, in the current state; 0 without any.
    double largest_strain() const;
    double largest_strain(ClothId cloth) const;
    /// What obstacles do to the vertices of a cloth at the end of the last step that was solved, friction included: sorted by
    /// vertex and obstacle, vertices that nothing presses left out. Of a step made in spans it is what the last span ended with.
    /// Empty before the first step, after a failed one, set_positions, reset and teleport. Costs nothing unless it is asked for.
    std::vector<ContactLoad> contact_loads(ClothId cloth) const;
    /// What all cloth does to an obstacle, N: the sum of those forces with the other sign. Cloth at rest that nothing else holds
    /// presses with its weight.
    Vec3 force_on(ObstacleId obstacle) const;
    /// Torque of the same forces about a point (m, world), N m: the sum of (ContactLoad::cloth_point - about) x force. They act
    /// where they act on the cloth, on its middle surface, so that body and cloth keep their angular momentum.
    Vec3 torque_on(ObstacleId obstacle, const Vec3& about) const;
    /// From now on, for `impulse_on`: steps add up what each contact gives, and no other result of theirs changes by that. Until
    /// then, and after `false`, it costs nothing. Not part of saved states.
    void keep_impulses(bool keep = true);
    /// What all cloth gave an obstacle in the last step, N s: the forces of every piece that the step was made in times its
    /// length, and what impacts gave. A rigid body of the host's is given that, so that body and cloth keep their momentum. Zero
    /// before the first step since keep_impulses, after one that failed and after `restore`. Throws SceneError unless impulses
    /// are kept.
    Vec3 impulse_on(ObstacleId obstacle) const;
    /// The angular momentum of the same about a point (m, world), N m s, taken where the cloth was at the end of each piece.
    Vec3 angular_impulse_on(ObstacleId obstacle, const Vec3& about) const;
    /// Whether two cloths, or a cloth with itself, meet now: both have self_contact, set_pair does not keep them apart, and no
    /// seam that joins them closes without contact (SeamSettings::contact_while_closing).
    bool meets(ClothId first, ClothId second) const;
    /// How far apart the sides of each stitch are, m, in the order in which they were given.
    std::vector<double> seam_gaps(SeamId seam) const;
    /// Of a vertex, m/s.
    double largest_speed() const;
    /// Depends on every bit of positions and velocities.
    std::uint64_t state_hash() const;

    /// Everything that the coming steps depend on, as bytes; changes nothing. A simulation made by the same calls that takes them
    /// by `restore` makes the same steps in every bit, whatever its number of threads and its kind of tree. They hold gravity,
    /// wind and time step, but of cloth, seams, obstacles and other settings only what tells them from others; numbers are laid
    /// out as on this machine. Throws SceneError where the detector cannot save its state.
    std::vector<std::byte> save() const;
    /// Throws SceneError, and leaves the simulation as it was, where the bytes are cut off, damaged, of another version of this
    /// format, or of a simulation with other cloth, pairs, seams, obstacles or settings (`threads`, `start`,
    /// `check_derivatives` and `work_limit` may differ).
    void restore(std::span<const std::byte> saved);

private:
    struct Implementation;
    /// Throws SceneError where nothing is owned: a simulation that was moved from can only be assigned to or destroyed.
    struct Owner {
        std::unique_ptr<Implementation> owned;
        Implementation* operator->() const;
    };
    Owner implementation_;
};

}  // namespace percale
