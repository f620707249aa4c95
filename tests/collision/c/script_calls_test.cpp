#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "tests/support/collision/c_objects.h"

namespace percale::test::script_calls_test {
namespace {

struct BadMove {
    const char* function;
    const char* part;
    std::function<percale_status(percale_simulation*)> make;
};

const double nan_vector[3] = {0.0, std::nan(""), 0.0}, zero_vector[3] = {0.0, 0.0, 0.0}, huge_vector[3] = {0.0, 2e4, 0.0};
const int cloth_zero = 0, cloth_four = 4;
const std::size_t one_cloth_no_obstacle[2] = {1, 0}, one_of_each[2] = {1, 1};

percale_pose pose_with(double scale, double x = 0.0) {
    percale_pose pose = percale_identity_pose();
    pose.scale = scale;
    pose.translation[0] = x;
    return pose;
}

percale_status teleport_with(percale_simulation* simulation, const percale_pose& motion) {
    return percale_teleport(simulation, &cloth_zero, &cloth_zero, one_of_each, &motion, 1);
}

const BadMove bad_moves[] = {
    {"percale_pin", "81", [](auto* s) { return percale_pin(s, 0, 81); }},
    {"percale_pin", "-1", [](auto* s) { return percale_pin(s, 0, -1); }},
    {"percale_pin", "1", [](auto* s) { return percale_pin(s, 1, 0); }},
    {"percale_pin", "-3", [](auto* s) { return percale_pin(s, -3, 0); }},
    {"percale_unpin", "pinned", [](auto* s) { return percale_unpin(s, 0, 5); }},
    {"percale_unpin", "100", [](auto* s) { return percale_unpin(s, 0, 100); }},
    {"percale_move_pin", "pinned", [](auto* s) { return percale_move_pin(s, 0, 5, zero_vector); }},
    {"percale_move_pin", "0", [](auto* s) { return percale_move_pin(s, 0, 0, nan_vector); }},
    {"percale_move_pin", "target", [](auto* s) { return percale_move_pin(s, 0, 0, nullptr); }},
    {"percale_move_obstacle", "end", [](auto* s) { return percale_move_obstacle(s, 0, nullptr); }},
    {"percale_move_obstacle", "scale",
     [](auto* s) {
         const percale_pose larger = pose_with(2.0);
         return percale_move_obstacle(s, 0, &larger);
     }},
    {"percale_move_obstacle", "obstacle",
     [](auto* s) {
         const percale_pose odd = pose_with(1.0, std::numeric_limits<double>::infinity());
         return percale_move_obstacle(s, 0, &odd);
     }},
    {"percale_move_obstacle", "9",
     [](auto* s) {
         const percale_pose same = pose_with(1.0);
         return percale_move_obstacle(s, 9, &same);
     }},
    {"percale_deform_obstacle", "rigid", [](auto* s) { return percale_deform_obstacle(s, 0, zero_vector, 1); }},
    {"percale_deform_obstacle", "end", [](auto* s) { return percale_deform_obstacle(s, 1, nullptr, 4); }},
    {"percale_deform_obstacle", "1 positions", [](auto* s) { return percale_deform_obstacle(s, 1, zero_vector, 1); }},
    {"percale_deform_obstacle", "vertex",
     [](auto* s) {
         const double places[12] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, std::nan("")};
         return percale_deform_obstacle(s, 1, places, 4);
     }},
    {"percale_set_gravity", "-10000 ... 10000", [](auto* s) { return percale_set_gravity(s, huge_vector); }},
    {"percale_set_gravity", "gravity", [](auto* s) { return percale_set_gravity(s, nullptr); }},
    {"percale_set_wind", "wind", [](auto* s) { return percale_set_wind(s, nan_vector); }},
    {"percale_set_wind", "velocity", [](auto* s) { return percale_set_wind(s, nullptr); }},
    {"percale_set_time_step", "time_step", [](auto* s) { return percale_set_time_step(s, 0.0); }},
    {"percale_set_time_step", "time_step", [](auto* s) { return percale_set_time_step(s, std::nan("")); }},
    {"percale_set_work_limit", "work_limit", [](auto* s) { return percale_set_work_limit(s, -1); }},
    {"percale_set_time_limit", "1e-06", [](auto* s) { return percale_set_time_limit(s, -1.0); }},
    {"percale_set_time_limit", "1e-06", [](auto* s) { return percale_set_time_limit(s, std::nan("")); }},
    {"percale_set_positions", "1 positions for 81", [](auto* s) { return percale_set_positions(s, 0, zero_vector, 1); }},
    {"percale_set_positions", "positions", [](auto* s) { return percale_set_positions(s, 0, nullptr, 81); }},
    {"percale_set_positions", "position 1",
     [](auto* s) {
         std::vector<double> places(243, 0.0);
         places[3] = std::nan("");
         return percale_set_positions(s, 0, places.data(), 81);
     }},
    {"percale_set_velocities", "1 velocities for 81", [](auto* s) { return percale_set_velocities(s, 0, zero_vector, 1); }},
    {"percale_set_velocities", "velocities", [](auto* s) { return percale_set_velocities(s, 0, nullptr, 81); }},
    {"percale_reset", "1", [](auto* s) { return percale_reset(s, 1); }},
    {"percale_teleport", "scale", [](auto* s) { return teleport_with(s, pose_with(2.0)); }},
    {"percale_teleport", "teleport", [](auto* s) { return teleport_with(s, pose_with(1.0, std::nan(""))); }},
    {"percale_teleport", "motion",
     [](auto* s) { return percale_teleport(s, &cloth_zero, &cloth_zero, one_of_each, nullptr, 1); }},
    {"percale_teleport", "counts",
     [](auto* s) {
         const percale_pose motion = pose_with(1.0);
         return percale_teleport(s, &cloth_zero, &cloth_zero, nullptr, &motion, 1);
     }},
    {"percale_teleport", "cloths",
     [](auto* s) {
         const percale_pose motion = pose_with(1.0);
         return percale_teleport(s, nullptr, nullptr, one_cloth_no_obstacle, &motion, 1);
     }},
    {"percale_teleport", "4",
     [](auto* s) {
         const percale_pose motion = pose_with(1.0);
         return percale_teleport(s, &cloth_four, nullptr, one_cloth_no_obstacle, &motion, 1);
     }},
};

/// With a pinned vertex, 0, and a deforming plane, obstacle 1.
CSimulation held_sheet() {
    CSimulation simulation = c_sheet_over_ball();
    auto settings = c_struct(percale_init_obstacle_settings);
    settings.deforming = 1;
    settings.pose.translation[1] = -2.0;
    int plane = -1;
    well(percale_add_obstacle(simulation.get(), c_plane(1.0).get(), &settings, &plane));
    REQUIRE(plane == 1);
    well(percale_pin(simulation.get(), 0, 0));
    for (int step = 0; step < 3; ++step) well(percale_step(simulation.get(), nullptr));
    return simulation;
}

}  // namespace

TEST_CASE("Every wrong call that moves something is refused in words and leaves the simulation in every bit") {
    const CSimulation simulation = held_sheet(), untouched = held_sheet();
    const std::vector<char> before = c_saved(simulation.get());
    for (const BadMove& bad : bad_moves) {
        fails(bad.make(simulation.get()), PERCALE_INVALID_ARGUMENT, bad.function, bad.part);
        CHECK(percale_last_error(simulation.get()) == std::string(percale_last_error(nullptr)));
        CHECK(c_saved(simulation.get()) == before);
        fails(bad.make(nullptr), PERCALE_INVALID_ARGUMENT, bad.function, "simulation: is NULL");
    }
    for (int step = 0; step < 3; ++step) {
        well(percale_step(simulation.get(), nullptr));
        well(percale_step(untouched.get(), nullptr));
        CHECK(c_hash(simulation.get()) == c_hash(untouched.get()));
    }
}

TEST_CASE("What is moved through C is where it was moved to") {
    const CSimulation simulation = held_sheet();
    const double* before = percale_positions_view(simulation.get(), 0, nullptr);
    REQUIRE(before != nullptr);
    const double target[3] = {before[0] - 0.01, before[1] + 0.02, before[2]};
    const percale_pose end = pose_with(1.0, 0.005);
    well(percale_move_pin(simulation.get(), 0, 0, target));
    well(percale_move_obstacle(simulation.get(), 0, &end));
    well(percale_step(simulation.get(), nullptr));
    const double* after = percale_positions_view(simulation.get(), 0, nullptr);
    for (int axis = 0; axis < 3; ++axis) CHECK(after[axis] == target[axis]);
    percale_pose pose;
    well(percale_obstacle_pose(simulation.get(), 0, &pose));
    CHECK(pose.translation[0] == 0.005);
    CHECK(pose.scale == 1.0);

    std::vector<double> shape(12);
    std::size_t count = 0;
    well(percale_obstacle_shape(simulation.get(), 1, shape.data(), 4, &count));
    REQUIRE(count == 4);
    for (std::size_t i = 0; i < 4; ++i) shape[3 * i + 1] += 0.01;
    well(percale_deform_obstacle(simulation.get(), 1, shape.data(), 4));
    well(percale_step(simulation.get(), nullptr));
    std::vector<double> moved(12);
    well(percale_obstacle_shape(simulation.get(), 1, moved.data(), 4, nullptr));
    CHECK(moved == shape);
}

}  // namespace percale::test::script_calls_test
