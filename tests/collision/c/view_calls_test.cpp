#include <cmath>
#include <functional>
#include <string>

#include "tests/support/collision/c_objects.h"
#include "tests/support/collision/c_twin.h"

namespace percale::test::view_calls_test {
namespace {

CSimulation stepped_sheet() {
    CSimulation simulation = c_sheet_over_ball("brute_force");
    for (int step = 0; step < 8; ++step) well(percale_step(simulation.get(), nullptr));
    return simulation;
}

double total(const double* numbers, std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += numbers[i];
    return sum;
}

struct BadLook {
    const char* function;
    const char* part;
    std::function<percale_status(const percale_simulation*)> make;
};

double out[3];
int numbers[1];
int whole;
std::size_t items;
percale_contact_load load;

const BadLook bad_looks[] = {
    {"percale_time", "NULL", [](auto* s) { return percale_time(s, nullptr); }},
    {"percale_cloth_count", "NULL", [](auto* s) { return percale_cloth_count(s, nullptr); }},
    {"percale_vertex_count", "1", [](auto* s) { return percale_vertex_count(s, 1, &items); }},
    {"percale_vertex_count", "NULL", [](auto* s) { return percale_vertex_count(s, 0, nullptr); }},
    {"percale_positions", "-2", [](auto* s) { return percale_positions(s, -2, out, 1, &items); }},
    {"percale_positions", "buffer", [](auto* s) { return percale_positions(s, 0, nullptr, 81, &items); }},
    {"percale_velocities", "5", [](auto* s) { return percale_velocities(s, 5, out, 1, &items); }},
    {"percale_velocities", "count", [](auto* s) { return percale_velocities(s, 0, nullptr, 0, nullptr); }},
    {"percale_masses", "3", [](auto* s) { return percale_masses(s, 3, out, 3, &items); }},
    {"percale_obstacle_pose", "NULL", [](auto* s) { return percale_obstacle_pose(s, 0, nullptr); }},
    {"percale_obstacle_shape", "4", [](auto* s) { return percale_obstacle_shape(s, 4, out, 1, &items); }},
    {"percale_energy_now", "NULL", [](auto* s) { return percale_energy_now(s, nullptr); }},
    {"percale_energy_now", "struct_size",
     [](auto* s) {
         percale_energy energy{};
         return percale_energy_now(s, &energy);
     }},
    {"percale_largest_strain", "6", [](auto* s) { return percale_largest_strain(s, 6, out); }},
    {"percale_largest_strain", "-2", [](auto* s) { return percale_largest_strain(s, -2, out); }},
    {"percale_largest_speed", "NULL", [](auto* s) { return percale_largest_speed(s, nullptr); }},
    {"percale_contact_loads", "2", [](auto* s) { return percale_contact_loads(s, 2, &load, 1, &items); }},
    {"percale_force_on", "1", [](auto* s) { return percale_force_on(s, 1, out); }},
    {"percale_force_on", "force", [](auto* s) { return percale_force_on(s, 0, nullptr); }},
    {"percale_pinned_vertices", "4", [](auto* s) { return percale_pinned_vertices(s, 4, numbers, 1, &items); }},
    {"percale_normals", "4", [](auto* s) { return percale_normals(s, 4, out, 1, &items); }},
    {"percale_normals", "buffer", [](auto* s) { return percale_normals(s, 0, nullptr, 81, &items); }},
    {"percale_interpolate", "keep_previous_positions", [](auto* s) { return percale_interpolate(s, 0.5, 0, out, 1, &items); }},
    {"percale_interpolate", "2", [](auto* s) { return percale_interpolate(s, 0.5, 2, out, 1, &items); }},
    {"percale_torque_on", "1", [](auto* s) { return percale_torque_on(s, 1, out, out); }},
    {"percale_torque_on", "about", [](auto* s) { return percale_torque_on(s, 0, nullptr, out); }},
    {"percale_torque_on", "torque", [](auto* s) { return percale_torque_on(s, 0, out, nullptr); }},
    {"percale_torque_on", "about",
     [](auto* s) {
         const double nowhere[3] = {0.0, std::nan(""), 0.0};
         return percale_torque_on(s, 0, nowhere, out);
     }},
    {"percale_impulse_on", "keep_impulses", [](auto* s) { return percale_impulse_on(s, 0, out); }},
    {"percale_impulse_on", "1", [](auto* s) { return percale_impulse_on(s, 1, out); }},
    {"percale_angular_impulse_on", "keep_impulses", [](auto* s) { return percale_angular_impulse_on(s, 0, out, out); }},
    {"percale_angular_impulse_on", "about", [](auto* s) { return percale_angular_impulse_on(s, 0, nullptr, out); }},
    {"percale_meets", "9", [](auto* s) { return percale_meets(s, 0, 9, &whole); }},
    {"percale_meets", "NULL", [](auto* s) { return percale_meets(s, 0, 0, nullptr); }},
    {"percale_seam_gaps", "seam", [](auto* s) { return percale_seam_gaps(s, 0, out, 3, &items); }},
    {"percale_state_hash", "NULL", [](auto* s) { return percale_state_hash(s, nullptr); }},
};

}  // namespace

TEST_CASE("Every wrong question is refused in words and leaves the simulation in every bit") {
    const CSimulation simulation = stepped_sheet();
    const std::vector<char> before = c_saved(simulation.get());
    for (const BadLook& bad : bad_looks) {
        fails(bad.make(simulation.get()), PERCALE_INVALID_ARGUMENT, bad.function, bad.part);
        CHECK(percale_last_error(simulation.get()) == std::string(percale_last_error(nullptr)));
        CHECK(c_saved(simulation.get()) == before);
        fails(bad.make(nullptr), PERCALE_INVALID_ARGUMENT, bad.function, "simulation: is NULL");
    }
    for (const auto view : {percale_positions_view, percale_velocities_view, percale_masses_view}) {
        items = 42;
        CHECK(view(simulation.get(), 1, &items) == nullptr);
        CHECK(view(nullptr, 0, &items) == nullptr);
        CHECK(items == 42);
    }
}

TEST_CASE("Copies and views of a cloth are the numbers of C++") {
    Twin twin("brute_force", {}, {});
    twin.add_cloth(make_grid(0.6, 0.6, 9, 9), {.thickness = 0.02}, {{"thickness", "0.02"}}, {0.0, 0.33, 0.0});
    twin.add_obstacle(make_sphere(0.3, 2));
    for (int step = 0; step < 10; ++step) twin.step();
    std::size_t count = 0;
    well(percale_vertex_count(twin.c(), 0, &count));
    REQUIRE(count == 81);
    std::vector<double> copy(3 * count);
    const auto check_vectors = [&](std::span<const Vec3> expected, const double* view) {
        for (std::size_t i = 0; i < expected.size(); ++i) {
            CHECK(Vec3(copy[3 * i], copy[3 * i + 1], copy[3 * i + 2]) == expected[i]);
            CHECK(Vec3(view[3 * i], view[3 * i + 1], view[3 * i + 2]) == expected[i]);
        }
    };
    well(percale_positions(twin.c(), 0, copy.data(), count, nullptr));
    check_vectors(twin.cpp().positions({0}), percale_positions_view(twin.c(), 0, &count));
    CHECK(count == 81);
    well(percale_velocities(twin.c(), 0, copy.data(), count, nullptr));
    check_vectors(twin.cpp().velocities({0}), percale_velocities_view(twin.c(), 0, nullptr));
    well(percale_masses(twin.c(), 0, copy.data(), count, &count));
    CHECK(std::equal(twin.cpp().masses({0}).begin(), twin.cpp().masses({0}).end(), copy.begin()));
    CHECK(total(percale_masses_view(twin.c(), 0, nullptr), 81) == Approx(0.2 * 0.36));

    copy.assign(copy.size(), -7.0);
    count = 0;
    fails(percale_positions(twin.c(), 0, copy.data(), 80, &count), PERCALE_BUFFER_TOO_SMALL, "percale_positions", "80");
    CHECK(count == 81);
    CHECK(copy == std::vector<double>(copy.size(), -7.0));
}

TEST_CASE("Pinned vertices are listed by number, ascending, and counted without a buffer") {
    Twin twin("none", {}, {});
    twin.add_cloth(make_grid(0.6, 0.6, 4, 4), {}, {}, {0.0, 0.0, 0.0});
    for (const int vertex : {12, 3}) well(percale_pin(twin.c(), 0, vertex));
    std::size_t count = 0;
    well(percale_pinned_vertices(twin.c(), 0, nullptr, 0, &count));
    CHECK(count == 2);
    int reported[2] = {-7, -7};
    well(percale_pinned_vertices(twin.c(), 0, reported, 2, &count));
    CHECK((reported[0] == 3 && reported[1] == 12));
    fails(percale_pinned_vertices(twin.c(), 0, reported, 1, nullptr), PERCALE_BUFFER_TOO_SMALL, "percale_pinned_vertices", "1");
}

TEST_CASE("Normals and places between two steps are the numbers of C++, and neither is given in part") {
    Twin twin("brute_force", {}, {});
    twin.add_cloth(make_grid(0.6, 0.6, 9, 9), {.thickness = 0.02}, {{"thickness", "0.02"}}, {0.0, 0.33, 0.0});
    twin.add_obstacle(make_sphere(0.3, 2));
    twin.cpp().keep_previous_positions();
    well(percale_keep_previous_positions(twin.c(), 1));
    for (int step = 0; step < 10; ++step) twin.step();
    std::vector<Vec3> expected(81), reported(81, Vec3::Constant(-7.0));
    std::size_t count = 0;
    well(percale_normals(twin.c(), 0, reported[0].data(), 81, &count));
    CHECK(count == 81);
    CHECK(reported == twin.cpp().normals({0}));
    CHECK(reported[40].y() > 0.9);
    for (const double fraction : {0.0, 0.3, 1.0}) {
        twin.cpp().interpolate(fraction, {0}, expected);
        well(percale_interpolate(twin.c(), fraction, 0, reported[0].data(), 81, nullptr));
        CHECK(reported == expected);
    }
    CHECK(std::equal(reported.begin(), reported.end(), twin.cpp().positions({0}).begin()));

    reported.assign(81, Vec3::Constant(-7.0));
    fails(percale_normals(twin.c(), 0, reported[0].data(), 80, nullptr), PERCALE_BUFFER_TOO_SMALL, "percale_normals", "80");
    fails(percale_interpolate(twin.c(), 0.5, 0, reported[0].data(), 80, nullptr), PERCALE_BUFFER_TOO_SMALL, "percale_interpolate",
          "80");
    fails(percale_interpolate(twin.c(), 1.5, 0, reported[0].data(), 81, nullptr), PERCALE_INVALID_ARGUMENT, "percale_interpolate",
          "0 ... 1");
    CHECK(reported == std::vector<Vec3>(81, Vec3::Constant(-7.0)));
    well(percale_keep_previous_positions(twin.c(), 0));
    fails(percale_interpolate(twin.c(), 0.5, 0, reported[0].data(), 81, nullptr), PERCALE_INVALID_ARGUMENT, "percale_interpolate",
          "keep_previous_positions");
}

TEST_CASE("Energy, strain, speed, forces, loads and meetings are those of C++") {
    Twin twin("brute_force", {}, {});
    twin.add_cloth(make_grid(0.6, 0.6, 9, 9), {.thickness = 0.02}, {{"thickness", "0.02"}}, {0.0, 0.33, 0.0});
    twin.add_obstacle(make_sphere(0.3, 2));
    twin.cpp().keep_impulses();
    well(percale_keep_impulses(twin.c(), 1));
    for (int step = 0; step < 20; ++step) twin.step();
    auto energy = c_struct(percale_init_energy);
    well(percale_energy_now(twin.c(), &energy));
    const StepEnergy expected = twin.cpp().energy();
    CHECK(energy.kinetic == expected.kinetic);
    CHECK(energy.elastic == expected.elastic);
    CHECK(energy.gravity == expected.gravity);
    CHECK(energy.contact == expected.contact);
    double value = 0.0, of_cloth = 0.0, force[3];
    well(percale_largest_strain(twin.c(), -1, &value));
    well(percale_largest_strain(twin.c(), 0, &of_cloth));
    CHECK(value == twin.cpp().largest_strain());
    CHECK(of_cloth == value);
    well(percale_largest_speed(twin.c(), &value));
    CHECK(value == twin.cpp().largest_speed());
    well(percale_force_on(twin.c(), 0, force));
    CHECK(Vec3(force[0], force[1], force[2]) == twin.cpp().force_on({0}));
    const Vec3 about(0.1, 0.2, 0.3);
    well(percale_torque_on(twin.c(), 0, about.data(), force));
    CHECK(Vec3(force[0], force[1], force[2]) == twin.cpp().torque_on({0}, about));
    well(percale_impulse_on(twin.c(), 0, force));
    CHECK(Vec3(force[0], force[1], force[2]) == twin.cpp().impulse_on({0}));
    CHECK(Vec3::Map(force).norm() > 0.0);
    well(percale_angular_impulse_on(twin.c(), 0, about.data(), force));
    CHECK(Vec3(force[0], force[1], force[2]) == twin.cpp().angular_impulse_on({0}, about));
    well(percale_keep_impulses(twin.c(), 0));
    fails(percale_impulse_on(twin.c(), 0, force), PERCALE_INVALID_ARGUMENT, "percale_impulse_on", "keep_impulses");
    const auto loads = twin.cpp().contact_loads({0});
    REQUIRE(!loads.empty());
    std::vector<percale_contact_load> same(loads.size());
    std::size_t count = 0;
    well(percale_contact_loads(twin.c(), 0, same.data(), same.size(), &count));
    REQUIRE(count == loads.size());
    for (std::size_t i = 0; i < count; ++i) {
        CHECK(same[i].vertex == loads[i].vertex);
        CHECK(same[i].obstacle == loads[i].obstacle);
        CHECK(Vec3(same[i].normal[0], same[i].normal[1], same[i].normal[2]) == loads[i].normal);
        CHECK(Vec3(same[i].friction[0], same[i].friction[1], same[i].friction[2]) == loads[i].friction);
        CHECK(Vec3::Map(same[i].cloth_point) == loads[i].cloth_point);
        CHECK(Vec3::Map(same[i].obstacle_point) == loads[i].obstacle_point);
        CHECK((loads[i].cloth_point - loads[i].obstacle_point).norm() > 0.0);
    }
    int meet = 7;
    well(percale_meets(twin.c(), 0, 0, &meet));
    CHECK(meet == 0);
    percale_pose pose{};
    well(percale_obstacle_pose(twin.c(), 0, &pose));
    CHECK(pose.rotation[0] == 1.0);
    well(percale_obstacle_shape(twin.c(), 0, nullptr, 0, &count));
    CHECK(count == 0);
}

TEST_CASE("Cloth at rest on a plane presses on it with its weight") {
    const CSimulation simulation = c_simulation("brute_force");
    c_add_cloth(simulation.get(), c_grid(0.5, 9).get(), c_fabric({{"area_density", "0.3"}}).get(), 0.006);
    int plane = -1;
    well(percale_add_obstacle(simulation.get(), c_plane(1.0).get(), nullptr, &plane));
    auto report = c_struct(percale_init_step_report);
    for (int step = 0; step < 600 && report.slept == 0; ++step) well(percale_step(simulation.get(), &report));
    REQUIRE(report.slept == 1);
    double force[3];
    well(percale_force_on(simulation.get(), plane, force));
    const double weight = 0.3 * 0.25 * 9.81;  // N
    CHECK(force[1] == Approx(-weight).epsilon(1e-4));
    CHECK(std::abs(force[0]) < 1e-4 * weight);
    CHECK(std::abs(force[2]) < 1e-4 * weight);
}

TEST_CASE("Gaps of a seam are given in m, one a stitch, and cloths that meet are reported as such") {
    const CSimulation simulation = c_simulation("brute_force");
    const CFabric fabric = c_fabric({{"self_contact", "true"}});
    for (const double height : {0.0, 0.3}) c_add_cloth(simulation.get(), c_grid(0.5, 4).get(), fabric.get(), height);
    const percale_stitch stitches[2] = {{0, 0, 0, 0.0}, {3, 2, 3, 0.5}};
    const int cloths[2] = {0, 1};
    int seam = -1;
    well(percale_add_seam(simulation.get(), cloths, stitches, 2, nullptr, &seam));
    double gaps[2];
    std::size_t count = 0;
    well(percale_seam_gaps(simulation.get(), seam, gaps, 2, &count));
    CHECK(count == 2);
    CHECK(gaps[0] == Approx(0.3));
    CHECK(gaps[1] == Approx(std::hypot(0.3, 0.5 / 6.0)));
    int meet = 0;
    well(percale_meets(simulation.get(), 0, 1, &meet));
    CHECK(meet == 1);
    well(percale_set_pair(simulation.get(), 0, 1, 0, nullptr));
    well(percale_meets(simulation.get(), 0, 1, &meet));
    CHECK(meet == 0);
}

}  // namespace percale::test::view_calls_test
