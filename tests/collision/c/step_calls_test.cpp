#include <cmath>
#include <string>
#include <thread>

#include "tests/support/collision/c_objects.h"

namespace percale::test::step_calls_test {
namespace {

std::string plan_of(const percale_simulation* simulation, const percale_scripted_changes* changes = nullptr) {
    std::size_t size = 0;
    well(percale_plan_text(simulation, changes, nullptr, 0, &size));
    std::string text(size, '?');
    well(percale_plan_text(simulation, changes, text.data(), size, nullptr));
    CHECK(text.back() == '\0');
    text.pop_back();
    return text;
}

/// A sheet that starts through the middle of a ball.
CSimulation crossing_sheet(const Options& options) {
    CSimulation simulation = c_simulation("brute_force", options);
    c_add_cloth(simulation.get(), c_grid(0.6, 9).get(), c_fabric({{"thickness", "0.01"}}).get(), 0.28);
    int ball = -1;
    well(percale_add_obstacle(simulation.get(), c_sphere(0.3, 2).get(), nullptr, &ball));
    return simulation;
}

}  // namespace

TEST_CASE("A step reports what it did and where time is") {
    const CSimulation simulation = c_sheet_over_ball("brute_force", {{"time_step", "0.01"}, {"measure", "ledger"}});
    CHECK(percale_explanation(simulation.get()) == std::string());
    auto report = c_struct(percale_init_step_report);
    for (int step = 1; step <= 5; ++step) {
        well(percale_step(simulation.get(), &report));
        double time = 0.0;
        well(percale_time(simulation.get(), &time));
        CHECK(time == report.time);
        CHECK(report.time == Approx(0.01 * step));
    }
    CHECK(report.dt == 0.01);
    CHECK(report.newton_iterations > 0);
    CHECK(report.largest_speed > 0.1);
    CHECK(std::isfinite(report.imbalance));
    CHECK(report.blocking_obstacle == -1);
    CHECK(percale_explanation(simulation.get()) != std::string());
    well(percale_step(simulation.get(), nullptr));
}

TEST_CASE("A step that fails reports it, fills its report and leaves the state") {
    const CSimulation simulation = c_sheet_over_ball("brute_force");
    for (int step = 0; step < 4; ++step) well(percale_step(simulation.get(), nullptr));
    const std::uint64_t before = c_hash(simulation.get());
    percale_pose far_off = percale_identity_pose();
    far_off.translation[1] = 100.0;
    well(percale_move_obstacle(simulation.get(), 0, &far_off));
    auto report = c_struct(percale_init_step_report);
    fails(percale_step(simulation.get(), &report), PERCALE_STEP_FAILED, "percale_step", "obstacle");
    CHECK(report.status == PERCALE_STEP_OBSTACLE_TOO_FAST);
    CHECK(report.blocking_obstacle == 0);
    CHECK(std::string(percale_last_error(simulation.get())) ==
          "percale_step: " + std::string(percale_explanation(simulation.get())));
    CHECK(c_hash(simulation.get()) == before);
    const percale_pose here = percale_identity_pose();
    well(percale_move_obstacle(simulation.get(), 0, &here));
    well(percale_step(simulation.get(), nullptr));
}

TEST_CASE("A work limit that is too low fails the step as such") {
    const CSimulation simulation = c_sheet_over_ball("brute_force");
    well(percale_set_work_limit(simulation.get(), 1));
    auto report = c_struct(percale_init_step_report);
    percale_status status = PERCALE_OK;
    for (int step = 0; step < 60 && status == PERCALE_OK; ++step) status = percale_step(simulation.get(), &report);
    CHECK(status == PERCALE_STEP_FAILED);
    CHECK(report.status == PERCALE_STEP_WORK_LIMIT);
}

TEST_CASE("A report of a wrong size is refused before the step") {
    const CSimulation simulation = c_sheet_over_ball();
    auto report = c_struct(percale_init_step_report);
    report.struct_size = 16;
    const std::uint64_t before = c_hash(simulation.get());
    fails(percale_step(simulation.get(), &report), PERCALE_INVALID_ARGUMENT, "percale_step", "struct_size");
    CHECK(c_hash(simulation.get()) == before);
    CHECK(report.time == 0.0);
    fails(percale_step(nullptr, nullptr), PERCALE_INVALID_ARGUMENT, "percale_step", "simulation");
    CHECK(percale_explanation(nullptr) == nullptr);
}

TEST_CASE("A start that is refused reports its fault and changes nothing") {
    const CSimulation simulation = crossing_sheet({{"start", "refuse"}});
    auto fault = c_struct(percale_init_start_fault);
    well(percale_last_start_fault(simulation.get(), &fault));
    CHECK(fault.obstacle == -1);
    const std::uint64_t before = c_hash(simulation.get());
    fails(percale_prepare(simulation.get()), PERCALE_START_REFUSED, "percale_prepare", "cloth");
    fails(percale_step(simulation.get(), nullptr), PERCALE_START_REFUSED, "percale_step", "cloth");
    CHECK(c_hash(simulation.get()) == before);
    well(percale_last_start_fault(simulation.get(), &fault));
    CHECK(fault.obstacle == 0);
    CHECK(fault.intersecting_pairs > 0);
    CHECK(fault.vertices_inside > 0);
    CHECK(fault.inside_vertex == 40);  // the sheet's middle
    fault.struct_size = 0;
    fails(percale_last_start_fault(simulation.get(), &fault), PERCALE_INVALID_ARGUMENT, "percale_last_start_fault",
          "struct_size");
}

TEST_CASE("A start whose penetration is resolved reports what was moved") {
    const CSimulation simulation = crossing_sheet({});
    std::size_t count = 99;
    well(percale_start_repair(simulation.get(), nullptr, 0, &count));
    CHECK(count == 0);
    well(percale_prepare(simulation.get()));
    percale_start_move move{};
    well(percale_start_repair(simulation.get(), &move, 1, &count));
    REQUIRE(count == 1);
    CHECK(move.cloth == 0);
    CHECK(move.obstacle == 0);
    CHECK(move.vertices_moved > 0);
    CHECK(move.largest_move > 0.01);
    fails(percale_start_repair(simulation.get(), nullptr, 0, nullptr), PERCALE_INVALID_ARGUMENT, "percale_start_repair", "count");
    well(percale_step(simulation.get(), nullptr));
}

TEST_CASE("The plan states scheme and counts, and announced changes change it") {
    const CSimulation simulation = c_sheet_over_ball();
    const std::string plan = plan_of(simulation.get());
    CHECK(plan.find("scheme: backward_euler") != std::string::npos);
    CHECK(plan.find("vertices: 81, 0 pinned") != std::string::npos);
    CHECK(plan.find("obstacles: 1, triangles: 320") != std::string::npos);
    CHECK(plan.find("left out: ") != std::string::npos);
    auto changes = c_struct(percale_init_scripted_changes);
    CHECK(plan_of(simulation.get(), &changes) == plan);
    changes.obstacles = changes.pins = changes.gravity = changes.wind = 1;
    CHECK(plan_of(simulation.get(), &changes) != plan);
    char text[10];
    std::size_t size = 0;
    fails(percale_plan_text(simulation.get(), nullptr, text, sizeof text, &size), PERCALE_BUFFER_TOO_SMALL, "percale_plan_text",
          "10");
    CHECK(size == plan.size() + 1);
    changes.struct_size = 2;
    fails(percale_plan_text(simulation.get(), &changes, text, sizeof text, &size), PERCALE_INVALID_ARGUMENT, "percale_plan_text",
          "struct_size");
}

TEST_CASE("What is saved is restored to the same bits, and what is damaged is refused") {
    const CSimulation simulation = c_sheet_over_ball();
    for (int step = 0; step < 10; ++step) well(percale_step(simulation.get(), nullptr));
    const std::vector<char> saved = c_saved(simulation.get());
    const std::uint64_t then = c_hash(simulation.get());
    std::vector<std::uint64_t> first, again;
    for (std::vector<std::uint64_t>* hashes : {&first, &again}) {
        for (int step = 0; step < 10; ++step) {
            well(percale_step(simulation.get(), nullptr));
            hashes->push_back(c_hash(simulation.get()));
        }
        if (hashes == &first) well(percale_restore(simulation.get(), saved.data(), saved.size()));
        if (hashes == &first) CHECK(c_hash(simulation.get()) == then);
    }
    CHECK(first == again);

    const std::vector<char> now = c_saved(simulation.get());
    const auto refused = [&](const void* bytes, std::size_t size) {
        fails(percale_restore(simulation.get(), bytes, size), PERCALE_INVALID_ARGUMENT, "percale_restore", "");
        CHECK(c_saved(simulation.get()) == now);
    };
    std::vector<char> damaged = saved;
    damaged[damaged.size() / 2] ^= 1;
    refused(damaged.data(), damaged.size());
    refused(saved.data(), saved.size() - 1);
    refused(saved.data(), 0);
    refused(nullptr, saved.size());
    const std::vector<char> of_other = c_saved(crossing_sheet({}).get());
    refused(of_other.data(), of_other.size());

    std::vector<char> small(now.size() - 1, 'x');
    std::size_t size = 0;
    fails(percale_save(simulation.get(), small.data(), small.size(), &size), PERCALE_BUFFER_TOO_SMALL, "percale_save",
          std::to_string(small.size()));
    CHECK(size == now.size());
    CHECK(small == std::vector<char>(small.size(), 'x'));
}

TEST_CASE("A step that is cancelled fails and moves nothing, also from another thread") {
    const CSimulation simulation = c_sheet_over_ball("brute_force", {{"time_step", "0.01"}});
    well(percale_step(simulation.get(), nullptr));
    const std::uint64_t before = c_hash(simulation.get());
    auto report = c_struct(percale_init_step_report);
    well(percale_set_cancel(simulation.get(), 1));
    fails(percale_step(simulation.get(), &report), PERCALE_STEP_FAILED, "percale_step", "set_cancel");
    CHECK(report.status == PERCALE_STEP_CANCELLED);
    CHECK(c_hash(simulation.get()) == before);
    well(percale_set_cancel(simulation.get(), 0));
    well(percale_step(simulation.get(), nullptr));
    CHECK(c_hash(simulation.get()) != before);
    CHECK(percale_set_cancel(nullptr, 1) == PERCALE_INVALID_ARGUMENT);

    std::thread other([&] { percale_set_cancel(simulation.get(), 1); });
    while (percale_step(simulation.get(), &report) == PERCALE_OK) {
    }
    other.join();
    CHECK(report.status == PERCALE_STEP_CANCELLED);
}

}  // namespace percale::test::step_calls_test
