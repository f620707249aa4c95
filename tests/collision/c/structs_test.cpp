#include "collision/c/structs.h"

#include <climits>
#include <cstring>
#include <limits>

#include "percale/simulation.h"
#include "tests/support/collision/c_objects.h"

namespace percale::test::structs_test {
namespace {

template <class Struct>
void check_init(percale_status (*init)(Struct*, std::size_t), const std::string& function) {
    Struct made;
    std::memset(&made, 0x5a, sizeof made);
    const Struct before = made;
    fails(init(&made, sizeof made - 8), PERCALE_INVALID_ARGUMENT, function, std::to_string(sizeof made));
    fails(init(&made, 0), PERCALE_INVALID_ARGUMENT, function, "struct_size");
    CHECK(std::memcmp(&made, &before, sizeof made) == 0);
    fails(init(nullptr, sizeof made), PERCALE_INVALID_ARGUMENT, function, "NULL");
    REQUIRE(init(&made, sizeof made) == PERCALE_OK);
    CHECK(made.struct_size == sizeof made);
}

}  // namespace

TEST_CASE("Every struct of the C interface is prepared at its size and at no other") {
    check_init(percale_init_setup, "percale_init_setup");
    check_init(percale_init_workers, "percale_init_workers");
    check_init(percale_init_cloth_settings, "percale_init_cloth_settings");
    check_init(percale_init_obstacle_settings, "percale_init_obstacle_settings");
    check_init(percale_init_seam_settings, "percale_init_seam_settings");
    check_init(percale_init_scripted_changes, "percale_init_scripted_changes");
    check_init(percale_init_energy, "percale_init_energy");
    check_init(percale_init_step_report, "percale_init_step_report");
    check_init(percale_init_start_fault, "percale_init_start_fault");
    check_init(percale_init_certificate, "percale_init_certificate");
    check_init(percale_init_option, "percale_init_option");
}

TEST_CASE("A report of no step names no cloth, vertex or obstacle") {
    const auto report = c_struct(percale_init_step_report);
    for (const int number : {report.blocked_cloth, report.blocked_vertex, report.blocking_obstacle, report.stretched_cloth})
        CHECK(number == -1);
    CHECK(report.linear_solver == std::string("none"));
}

TEST_CASE("Structs of the C interface begin with the defaults of C++") {
    const auto obstacle = c_struct(percale_init_obstacle_settings);
    const ObstacleSettings obstacle_of_cpp;
    CHECK(obstacle.friction == obstacle_of_cpp.friction);
    CHECK(obstacle.restitution == obstacle_of_cpp.restitution);
    CHECK(obstacle.name == obstacle_of_cpp.name);
    CHECK((obstacle.deforming != 0) == obstacle_of_cpp.deforming);
    CHECK((obstacle.yields != 0) == obstacle_of_cpp.yields);
    CHECK(c_interface::pose_of(obstacle.pose) == Pose{});

    const auto seam = c_struct(percale_init_seam_settings);
    const SeamSettings seam_of_cpp;
    CHECK(seam.after == seam_of_cpp.after);
    CHECK(seam.over == seam_of_cpp.over);
    CHECK(seam.stiffness == seam_of_cpp.stiffness);
    CHECK((seam.contact_while_closing != 0) == seam_of_cpp.contact_while_closing);
    CHECK((seam.weld != 0) == seam_of_cpp.weld);
    CHECK(seam.name == seam_of_cpp.name);

    const auto setup = c_struct(percale_init_setup);
    CHECK(setup.gravity[1] == StepSettings{}.gravity.y());
    CHECK(setup.has_wind == 0);
    CHECK(setup.detector == std::string("none"));
    CHECK(c_struct(percale_init_cloth_settings).name == std::string("cloth"));
    CHECK(c_struct(percale_init_cloth_settings).pose.scale == 1.0);
}

TEST_CASE("A pose comes back from C as it was") {
    const Pose pose{.translation = {1.5, -2.0, 3.25}, .rotation = {0.5, -0.5, 0.5, 0.5}, .scale = 2.0};
    CHECK(c_interface::pose_of(c_interface::c_pose(pose)) == pose);
    CHECK(c_interface::pose_of(percale_identity_pose()) == Pose{});
}

TEST_CASE("A buffer of the caller is measured, filled, or refused with the number it needs") {
    const std::vector<double> values{1.0, 2.0, 3.0};
    std::size_t count = 99;
    c_interface::give_items<double>(values, {nullptr, 0, &count});
    CHECK(count == 3);

    double room[3] = {-1.0, -1.0, -1.0};
    count = 99;
    CHECK_THROWS_AS(c_interface::give_items<double>(values, {room, 2, &count}), c_interface::CallError);
    CHECK(count == 3);
    CHECK(room[0] == -1.0);

    c_interface::give_items<double>(values, {room, 3, nullptr});
    CHECK(std::vector<double>(room, room + 3) == values);
    CHECK_THROWS_WITH(c_interface::give_items<double>(values, {nullptr, 0, nullptr}), Catch::Contains("count"));
    CHECK_THROWS_WITH(c_interface::give_items<double>(values, {nullptr, 3, &count}),
                      Catch::Contains("the buffer is NULL") || Catch::Contains("the buffer: is NULL"));
    char text[4];
    c_interface::give_text("abc", {text, 4, &count});
    CHECK(text == std::string("abc"));
    CHECK(count == 4);
    CHECK_THROWS_AS(c_interface::give_text("abcd", {text, 4, &count}), c_interface::CallError);
}

TEST_CASE("Lists that are NULL or longer than an int counts are refused") {
    CHECK(c_interface::items_of<int>(nullptr, 0, "list").empty());
    CHECK_THROWS_WITH(c_interface::items_of<int>(nullptr, 1, "list"), Catch::Contains("list"));
    CHECK_THROWS_WITH(c_interface::vectors_of(nullptr, 1, "places"), Catch::Contains("places"));
    const double one[3] = {1.0, 2.0, 3.0};
    const std::size_t too_many = static_cast<std::size_t>(INT_MAX) + 1;
    CHECK_THROWS_WITH(c_interface::vectors_of(one, too_many, "places"), Catch::Contains(std::to_string(too_many)));
    CHECK(c_interface::vectors_of(one, 1, "places").front() == Vec3(1.0, 2.0, 3.0));
}

}  // namespace percale::test::structs_test
