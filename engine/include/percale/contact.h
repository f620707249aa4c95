#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "percale/cloth_pairs.h"
#include "percale/error.h"
#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale {

class StateWriter;
class StateReader;
class Workers;

/// Places on an obstacle triangle: inside it, on one of its edges, at one of its corners.
inline constexpr int contact_places = 7;

/// Contact constraints, a structure of arrays. In constraint i the cloth point sum_k weight[i][k] x[vertex[i][k]] is at
/// `distance` from `obstacle_point`, along the unit vector `direction` (from the obstacle towards the cloth): direction . (sum_k
/// weight[k] x[vertex[k]] - obstacle_point) = distance.
/// Between two places of cloth the same holds with weights > 0 at one and < 0 at the other and obstacle_point 0: the direction
/// leads from the second to the first.
/// The order of constraints follows from cloth and obstacles alone, whatever the backend.
struct ContactConstraints {
    std::vector<std::array<int, 4>> vertex;     // cloth vertices; -1 = unused: 1 point, 2 edge, 3 triangle, 4 cloth on both sides
    std::vector<std::array<double, 4>> weight;  // sums to 1 against an obstacle, to 0 between cloths
    std::vector<Vec3> direction;                // unit
    std::vector<Vec3> obstacle_point;           // m, world, at the given fraction of the step
    std::vector<Vec3> obstacle_displacement;    // m, of that point during the whole step
    std::vector<double> distance;               // m, from the cloth's middle surface to the obstacle or to the other's, > 0
    std::vector<double> thickness;              // m, at which the force begins
    std::vector<double> friction;               // Coulomb coefficient
    std::vector<double> mollifier;  // factor of the forces: less than 1 where other constraints hold the contact, too; with
                                    // projection such a constraint is a spring. Below 0: the constraint is subtracted
    std::vector<int> obstacle;      // -1: cloth against cloth
    std::vector<int> feature;       // 2 vertices used: obstacle edge; 3: obstacle vertex; 1: contact_places times the obstacle
                               // triangle and the place on it (0 inside, 1 + k edge k, 4 + k corner k); between cloths the number
                               // of vertices on the first side: 1 vertex-face, 2 edge-edge

    std::size_t size() const { return vertex.size(); }
    /// Appends the constraints of another list.
    void append(const ContactConstraints& more) {
        for_each_list([](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); }, *this, more);
    }
    void clear() {
        for_each_list([](auto& list) { list.clear(); }, *this);
    }

private:
    template <class Work, class... Lists>
    static void for_each_list(Work work, Lists&... constraints) {
        work(constraints.vertex...);
        work(constraints.weight...);
        work(constraints.direction...);
        work(constraints.obstacle_point...);
        work(constraints.obstacle_displacement...);
        work(constraints.distance...);
        work(constraints.thickness...);
        work(constraints.friction...);
        work(constraints.mollifier...);
        work(constraints.obstacle...);
        work(constraints.feature...);
    }
};

/// The part of a step over which cloth and obstacles move together: 0 = start, 1 = end.
struct StepFraction {
    double from = 0.0;
    double to = 1.0;
};

/// The fault of a start position: the first obstacle that the cloth crosses, is inside of or touches; else cloth that crosses or
/// touches cloth. Vertices have the engine's numbers where a detector returns it, those of the meshes in a StartError.
struct StartFault {
    int obstacle = -1;           // -1 = no fault with obstacles
    int intersecting_pairs = 0;  // cloth triangles that cross a triangle of it, or pairs of cloth triangles that cross
    int cloth_triangle = -1;     // one of them, counted through all cloths
    int obstacle_triangle = -1;
    int other_cloth_triangle = -1;          // cloth against cloth: the triangle that cloth_triangle crosses or touches
    int vertices_inside = 0;                // cloth vertices inside it, if it is watertight
    int inside_vertex = -1;                 // the deepest of them, counted through all cloths
    std::vector<int> inside_vertices = {};  // all of them, ascending

    bool between_cloths() const { return other_cloth_triangle >= 0; }
    bool any() const { return obstacle >= 0 || between_cloths(); }
};

/// Cloth moved out of the obstacles that it started through, inside of or touching.
struct Untangled {
    std::vector<Vec3> positions;  // m, of all vertices; clear of every obstacle
    std::vector<int> obstacle;    // for each vertex the obstacle it was moved out of; -1 where it was not moved
};

/// Cloth starts where no simulation may start.
class StartError : public SceneError {
public:
    StartError(const std::string& message, const StartFault& fault) : SceneError(message), fault_(fault) {}
    const StartFault& fault() const { return fault_; }

private:
    StartFault fault_;
};

/// The cloth that meets cloth, and the data of its vertices for that.
struct SelfContact {
    std::span<const int> cloth;        // the number of its cloth; -1: it meets no cloth
    std::span<const Vec3> rest;        // m, positions as the cloth was added
    std::span<const double> friction;  // Coulomb coefficient of its fabric; between two fabrics their mean applies
    /// Stitches of seams. Features at one stitch are never in contact, others near one as if it were closed.
    std::span<const Stitch> stitches = {};
    ClothPairs pairs = {};  // m, as thicknesses given to set_cloth
};

/// Finds contacts between all cloth of a simulation and its obstacles, in whole batches with plain types.
/// Within a step an obstacle vertex moves on the straight line from its place at the start to its place at the end.
/// Not thread-safe: one detector belongs to one simulation.
class ContactDetector {
public:
    virtual ~ContactDetector() = default;

    /// All cloth triangles of the simulation, in the order of the meshes that were added, and the contact thickness of each
    /// vertex, m, > 0. Here and in all positions and constraints vertices have the engine's numbers, not those of the meshes.
    virtual void set_cloth(std::span<const Triangle> triangles, std::span<const double> vertex_thickness) = 0;

    /// Called after set_cloth, which resets it: cloth that also meets cloth. Two of its features are in contact below the mean of
    /// their thicknesses (half a thickness each), or below that of `pairs`, but at no more than half of their distance at rest
    /// where they belong to one cloth or are near a seam.
    virtual void set_self_contact(const SelfContact& cloth);

    /// Returns the obstacle's number. Throws SceneError if nothing is left of the mesh after cleaning.
    virtual int add_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction) = 0;

    /// Removes an obstacle: from now on nothing meets it, and the numbers of those added later decrease by one. The state kept
    /// for the others stays. A detector may not support it.
    virtual void remove_obstacle(int obstacle);

    /// Sets the friction of an obstacle in all later constraints. A detector may not support it.
    virtual void set_friction(int obstacle, double friction);

    /// The poses of the obstacle at the two ends of the coming step and of all later ones until the next call. The scale must not
    /// change.
    virtual void move_obstacle(int obstacle, const Pose& start, const Pose& end) = 0;

    /// The same for an obstacle that changes its shape: its vertices may move independently. A detector may not support it.
    virtual int add_deforming_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction);

    /// Called before move_obstacle, which places it: the positions of the vertices of a deforming obstacle's mesh before its
    /// pose, m, at the two ends of the coming step and of all later ones until the next call. Throws SceneError where vertices at
    /// one place of the mesh separate.
    virtual void deform_obstacle(int obstacle, std::span<const Vec3> start, std::span<const Vec3> end);

    /// Checks whether this start may be simulated: no crossing, no touching, no vertex inside a watertight obstacle; no cloth
    /// crosses or touches cloth that it meets.
    virtual StartFault check_start(std::span<const Vec3> positions) = 0;

    /// Positions clear of every obstacle, as near to the given ones as was found; nothing where none were found. Vertices with
    /// free = 0 stay. A connected piece of cloth leaves by one side; its surroundings follow, so that the cloth is not torn, but
    /// it may be stretched. Obstacles are where they are at the start of the step. A detector may not support this.
    virtual std::optional<Untangled> untangle(std::span<const Vec3> positions, std::span<const double> free) {
        static_cast<void>(positions), static_cast<void>(free);
        return std::nullopt;
    }

    /// Positions in which no cloth that meets cloth crosses or touches such cloth, as near to the given ones as was found,
    /// regardless of obstacles; vertices sewn to each other have one place. Nothing where none were found. Vertices with free = 0
    /// stay.
    virtual std::optional<std::vector<Vec3>> untangle_cloth(std::span<const Vec3> positions, std::span<const double> free) {
        static_cast<void>(positions), static_cast<void>(free);
        return std::nullopt;
    }

    /// Called once a step: makes the candidate lists valid for moves between these positions. Later moves beyond them are
    /// allowed: the lists then grow.
    virtual void update_candidates(std::span<const Vec3> start, std::span<const Vec3> predicted) = 0;

    /// Every contact closer than the activation distance, with obstacles at `fraction` of the step. A pair of an obstacle with an
    /// edge or a face of cloth that has been a contact since the last update of the candidates persists while it is that near:
    /// within one solve forces change continuously.
    virtual void find_contacts(std::span<const Vec3> positions, double fraction, ContactConstraints& constraints) = 0;

    /// The largest f in [0, 1] such that moving all vertices along from + f (to - from), while the obstacles move over f of the
    /// part of the step, keeps every distance above a small positive floor.
    virtual double collision_free_step_size(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction part) = 0;

    /// Smallest distance of the last search for contacts, m; infinity if nothing was near. Between cloths that of its constraints
    /// counts.
    virtual double smallest_distance() const = 0;

    /// Threads for the work of later calls, null: none; they stay as long as the detector. The results do not depend on them.
    virtual void set_workers(Workers* workers) { static_cast<void>(workers); }

    /// While this is true, untangle and untangle_cloth soon end without a result. Null: none. A detector may ignore it.
    virtual void set_cancel(const std::atomic<bool>* cancel) { static_cast<void>(cancel); }

    /// All state of later calls besides cloth and obstacles: poses, lists, contacts kept. A detector with the same cloth and
    /// obstacles that reads it (saved_state.h) gives the same bits from its next update on. Throws SceneError if it cannot.
    virtual void save(StateWriter& state) const;
    /// Reads to the end. Throws SceneError, and changes nothing, if the state is not one of this cloth and these obstacles.
    virtual void restore(StateReader& state);
};

inline int ContactDetector::add_deforming_obstacle(const TriangleMesh&, const Pose&, double) {
    throw SceneError("this contact detector knows rigid obstacles only");
}
inline void ContactDetector::deform_obstacle(int, std::span<const Vec3>, std::span<const Vec3>) {
    throw SceneError("this contact detector knows rigid obstacles only");
}
inline void ContactDetector::remove_obstacle(int) { throw SceneError("this contact detector cannot remove an obstacle"); }
inline void ContactDetector::set_friction(int, double) {
    throw SceneError("this contact detector cannot change the friction of an obstacle");
}
inline void ContactDetector::set_self_contact(const SelfContact&) {
    throw SceneError("this contact detector knows obstacles only; self_contact must be false");
}
inline void ContactDetector::save(StateWriter&) const { throw SceneError("this contact detector cannot save its state"); }
inline void ContactDetector::restore(StateReader&) { throw SceneError("this contact detector cannot restore a state"); }

}  // namespace percale
