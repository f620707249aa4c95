#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "percale/contact_load.h"
#include "rest_detection.h"
#include "substep/substep.h"
#include "support/checked_workers.h"
#include "support/thread_pool.h"

namespace percale {

/// What callers see, one entry a vertex in the user's order. Positions and masses are kept only if some cloth has another order.
struct UserViews {
    std::vector<Vec3> positions;   // m
    std::vector<Vec3> velocities;  // m/s, of the cloths whose velocities a caller has requested
    std::vector<double> masses;    // kg
};

/// The source of the contact forces of the present state.
enum class LoadSource { nowhere, last_solve, saved_state };

/// Why a start may not be simulated.
struct RefusedStart {
    int obstacle = -1;          // cloth crosses it, lies inside it or touches it; -1: nothing, or cloth alone
    std::vector<int> vertices;  // inside it
};

/// The callers' numbers of the existing bodies of one kind: ascending, and never given twice.
struct GivenNumbers {
    std::vector<int> all;
    int next = 0;

    int give() {
        all.push_back(next);
        return next++;
    }
    /// Index of the body of a number among the existing ones; -1: there is none.
    int index_of(int number) const {
        const auto found = std::ranges::lower_bound(all, number);
        return found != all.end() && *found == number ? static_cast<int>(found - all.begin()) : -1;
    }
    void take_out(int index) { all.erase(all.begin() + index); }
    bool operator==(const GivenNumbers&) const = default;
};

/// Everything one simulation holds. Only its owners know it as a whole: the simulation, the step at its top, and saving.
struct World {
    std::shared_ptr<Workers> workers;            // null: the caller's thread alone
    std::shared_ptr<const CheckedWorkers> host;  // those workers, where a host gave them
    const std::atomic<bool>* cancel = nullptr;   // Simulation::set_cancel
    bool own_workers = true;                     // made by StepSettings::threads, not given
    StepScene scene;
    StepState state;
    RestState rest;
    Workspace work;
    UserViews views;
    bool plan_outdated = true;  // the scene has changed since the plan was made
    bool changed = true;        // cloth or obstacles were added since the last preparation
    RefusedStart refused;       // why the last preparation refused the start
    LoadSource load_source = LoadSource::nowhere;
    double time_limit = 0.0;               // s, Simulation::set_time_limit
    bool keeps_impulses = false;           // StepState::impulses
    std::vector<ContactLoad> saved_loads;  // of a state that was restored
    Holds holds_before;                    // before the step that is under way
    /// For each cloth, whether it waits for seams to close: cloths with the same number are joined by such seams and do not meet
    /// each other, nor themselves, nor cloth of other layers, before; -1: it waits for none. Empty where none waits.
    std::vector<int> waiting;
    GivenNumbers cloth_numbers, obstacle_numbers, seam_numbers;
};

/// Whether some cloth has self_contact.
bool meets_cloth(const StepScene& scene);

/// World::waiting as it is at a time, s.
std::vector<int> waiting_cloth(const StepScene& scene, double time);

/// Whether two cloths, or a cloth with itself, meet now: both have self_contact, no pair setting excludes it, and World::waiting
/// does not keep them apart.
bool meet_now(const World& world, int first, int second);

/// Whether any two cloths meet now.
bool cloth_meets_now(const World& world);

/// Passes all cloth to the detector anew, and which of it meets cloth now.
void pass_cloth_to_detector(World& world);

/// Throws SceneError where the scene has contact, projected contact or welded seams that its scheme does not take.
void check_scheme(const StepScene& scene);

/// Forces of obstacles on vertices at the end of the last step that was solved, sorted by vertex and obstacle; empty where they
/// are not known. `only`: of one obstacle; -1: of all.
std::vector<ContactLoad> contact_loads(const World& world, int only = -1);

/// Uses as many threads as the settings request, or as pay for the amount of cloth; given workers take precedence.
void set_workers(World& world);

/// To be called when the scene has changed: the next step makes the plan anew, and cloth at rest wakes up.
void scene_changed(World& world);

}  // namespace percale
