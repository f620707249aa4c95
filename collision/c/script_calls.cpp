#include "c/handles.h"
#include "c/structs.h"

// Functions of percale.h for what moves in a simulation.

using namespace percale::c_interface;

namespace {

template <class Id>
std::vector<Id> ids_of(const int* numbers, std::size_t count, const char* name) {
    std::vector<Id> ids;
    for (const int number : items_of(numbers, count, name)) ids.push_back({number});
    return ids;
}

}  // namespace

percale_status percale_pin(percale_simulation* simulation, int cloth, int vertex) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.pin({cloth}, vertex); });
}

percale_status percale_unpin(percale_simulation* simulation, int cloth, int vertex) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.unpin({cloth}, vertex); });
}

percale_status percale_move_pin(percale_simulation* simulation, int cloth, int vertex, const double* target) {
    return call_on(__func__, simulation,
                   [&](percale_simulation& of) { of.simulation.move_pin({cloth}, vertex, vector_of(target, "target")); });
}

percale_status percale_move_obstacle(percale_simulation* simulation, int obstacle, const percale_pose* end) {
    return call_on(__func__, simulation,
                   [&](percale_simulation& of) { of.simulation.move_obstacle({obstacle}, pose_of(demanded(end, "end"))); });
}

percale_status percale_deform_obstacle(percale_simulation* simulation, int obstacle, const double* end, size_t vertex_count) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        of.simulation.deform_obstacle({obstacle}, vectors_of(end, vertex_count, "end"));
    });
}

percale_status percale_set_gravity(percale_simulation* simulation, const double* gravity) {
    return call_on(__func__, simulation,
                   [&](percale_simulation& of) { of.simulation.set_gravity(vector_of(gravity, "gravity")); });
}

percale_status percale_set_wind(percale_simulation* simulation, const double* velocity) {
    return call_on(__func__, simulation,
                   [&](percale_simulation& of) { of.simulation.set_wind(vector_of(velocity, "velocity")); });
}

percale_status percale_set_time_step(percale_simulation* simulation, double time_step) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_time_step(time_step); });
}

percale_status percale_set_work_limit(percale_simulation* simulation, int iterations) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_work_limit(iterations); });
}

percale_status percale_set_time_limit(percale_simulation* simulation, double seconds) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.set_time_limit(seconds); });
}

percale_status percale_set_cancel(percale_simulation* simulation, int wish) {
    // Nothing else of the handle is touched: another thread is in a call.
    return call(__func__, [&] { demanded(simulation, "simulation").cancel = wish != 0; });
}

percale_status percale_set_positions(percale_simulation* simulation, int cloth, const double* positions, size_t vertex_count) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        of.simulation.set_positions({cloth}, vectors_of(positions, vertex_count, "positions"));
    });
}

percale_status percale_set_velocities(percale_simulation* simulation, int cloth, const double* velocities, size_t vertex_count) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        of.simulation.set_velocities({cloth}, vectors_of(velocities, vertex_count, "velocities"));
    });
}

percale_status percale_reset(percale_simulation* simulation, int cloth) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.reset({cloth}); });
}

percale_status percale_teleport(percale_simulation* simulation, const int* cloths, const int* obstacles, const size_t counts[2],
                                const percale_pose* motion, int keep_velocities) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        const size_t* numbers = &demanded(counts, "counts");
        const auto moved_cloths = ids_of<percale::ClothId>(cloths, numbers[0], "cloths");
        const auto moved_obstacles = ids_of<percale::ObstacleId>(obstacles, numbers[1], "obstacles");
        of.simulation.teleport(moved_cloths, moved_obstacles, pose_of(demanded(motion, "motion")),
                               keep_velocities != 0 ? percale::TeleportVelocities::keep : percale::TeleportVelocities::clear);
    });
}
