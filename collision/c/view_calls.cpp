#include "c/handles.h"
#include "c/report_structs.h"
#include "c/structs.h"

// Functions of percale.h for the present state of a simulation.

using namespace percale::c_interface;

namespace {

/// The first number of a list of the library; NULL after an error.
template <class Look>
const double* view_of(const char* function, const percale_simulation* simulation, size_t* count, Look look) noexcept {
    const double* view = nullptr;
    call_on(function, simulation, [&](const percale_simulation& of) {
        const auto items = look(of.simulation);
        if (count != nullptr) *count = items.size();
        view = reinterpret_cast<const double*>(items.data());  // of double or of Vec3, three doubles in a row
    });
    return view;
}

template <class Value, class Look>
percale_status report(const char* function, const percale_simulation* simulation, Value* place, Look look) noexcept {
    return call_on(function, simulation,
                   [&](const percale_simulation& of) { demanded(place, "the place for the result") = look(of.simulation); });
}

percale_contact_load c_load(const percale::ContactLoad& load) {
    percale_contact_load reported{};
    reported.vertex = load.vertex;
    reported.obstacle = load.obstacle;
    write_vector(load.normal, reported.normal);
    write_vector(load.friction, reported.friction);
    write_vector(load.cloth_point, reported.cloth_point);
    write_vector(load.obstacle_point, reported.obstacle_point);
    return reported;
}

}  // namespace

percale_status percale_time(const percale_simulation* simulation, double* time) {
    return report(__func__, simulation, time, [](const auto& of) { return of.time(); });
}

percale_status percale_cloth_count(const percale_simulation* simulation, int* count) {
    return report(__func__, simulation, count, [](const auto& of) { return of.cloth_count(); });
}

percale_status percale_vertex_count(const percale_simulation* simulation, int cloth, size_t* count) {
    return report(__func__, simulation, count, [&](const auto& of) { return of.masses({cloth}).size(); });
}

percale_status percale_positions(const percale_simulation* simulation, int cloth, double* positions, size_t capacity,
                                 size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_vectors(of.simulation.positions({cloth}), {positions, capacity, count});
    });
}

percale_status percale_velocities(const percale_simulation* simulation, int cloth, double* velocities, size_t capacity,
                                  size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_vectors(of.simulation.velocities({cloth}), {velocities, capacity, count});
    });
}

percale_status percale_masses(const percale_simulation* simulation, int cloth, double* masses, size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_items<double>(of.simulation.masses({cloth}), {masses, capacity, count});
    });
}

percale_status percale_pinned_vertices(const percale_simulation* simulation, int cloth, int* vertices, size_t capacity,
                                       size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_items<int>(of.simulation.pinned_vertices({cloth}), {vertices, capacity, count});
    });
}

percale_status percale_normals(const percale_simulation* simulation, int cloth, double* normals, size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_vectors(of.simulation.normals({cloth}), {normals, capacity, count});
    });
}

percale_status percale_interpolate(const percale_simulation* simulation, double fraction, int cloth, double* positions,
                                   size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        std::vector<percale::Vec3> between(of.simulation.masses({cloth}).size());
        of.simulation.interpolate(fraction, {cloth}, between);
        give_vectors(between, {positions, capacity, count});
    });
}

const double* percale_positions_view(const percale_simulation* simulation, int cloth, size_t* count) {
    return view_of(__func__, simulation, count, [&](const auto& of) { return of.positions({cloth}); });
}

const double* percale_velocities_view(const percale_simulation* simulation, int cloth, size_t* count) {
    return view_of(__func__, simulation, count, [&](const auto& of) { return of.velocities({cloth}); });
}

const double* percale_masses_view(const percale_simulation* simulation, int cloth, size_t* count) {
    return view_of(__func__, simulation, count, [&](const auto& of) { return of.masses({cloth}); });
}

percale_status percale_obstacle_pose(const percale_simulation* simulation, int obstacle, percale_pose* pose) {
    return report(__func__, simulation, pose, [&](const auto& of) { return c_pose(of.obstacle_pose({obstacle})); });
}

percale_status percale_obstacle_shape(const percale_simulation* simulation, int obstacle, double* vertices, size_t capacity,
                                      size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_vectors(of.simulation.obstacle_shape({obstacle}), {vertices, capacity, count});
    });
}

percale_status percale_energy_now(const percale_simulation* simulation, percale_energy* energy) {
    return call_on(__func__, simulation,
                   [&](const percale_simulation& of) { known(energy, "energy") = c_energy(of.simulation.energy()); });
}

percale_status percale_largest_strain(const percale_simulation* simulation, int cloth, double* strain) {
    return report(__func__, simulation, strain,
                  [&](const auto& of) { return cloth == -1 ? of.largest_strain() : of.largest_strain({cloth}); });
}

percale_status percale_largest_speed(const percale_simulation* simulation, double* speed) {
    return report(__func__, simulation, speed, [](const auto& of) { return of.largest_speed(); });
}

percale_status percale_contact_loads(const percale_simulation* simulation, int cloth, percale_contact_load* loads,
                                     size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        std::vector<percale_contact_load> reported;
        for (const percale::ContactLoad& load : of.simulation.contact_loads({cloth})) reported.push_back(c_load(load));
        give_items<percale_contact_load>(reported, {loads, capacity, count});
    });
}

percale_status percale_force_on(const percale_simulation* simulation, int obstacle, double* force) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        write_vector(of.simulation.force_on({obstacle}), &demanded(force, "force"));
    });
}

percale_status percale_torque_on(const percale_simulation* simulation, int obstacle, const double* about, double* torque) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        const percale::Vec3 reported = of.simulation.torque_on({obstacle}, vector_of(about, "about"));
        write_vector(reported, &demanded(torque, "torque"));
    });
}

percale_status percale_impulse_on(const percale_simulation* simulation, int obstacle, double* impulse) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        write_vector(of.simulation.impulse_on({obstacle}), &demanded(impulse, "impulse"));
    });
}

percale_status percale_angular_impulse_on(const percale_simulation* simulation, int obstacle, const double* about,
                                          double* impulse) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        const percale::Vec3 reported = of.simulation.angular_impulse_on({obstacle}, vector_of(about, "about"));
        write_vector(reported, &demanded(impulse, "impulse"));
    });
}

percale_status percale_meets(const percale_simulation* simulation, int first, int second, int* meet) {
    return report(__func__, simulation, meet, [&](const auto& of) { return of.meets({first}, {second}) ? 1 : 0; });
}

percale_status percale_seam_gaps(const percale_simulation* simulation, int seam, double* gaps, size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        give_items<double>(of.simulation.seam_gaps({seam}), {gaps, capacity, count});
    });
}

percale_status percale_state_hash(const percale_simulation* simulation, uint64_t* hash) {
    return report(__func__, simulation, hash, [](const auto& of) { return of.state_hash(); });
}
