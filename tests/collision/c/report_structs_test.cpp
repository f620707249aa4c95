#include "collision/c/report_structs.h"

#include <cstring>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace percale::test::report_structs_test {
using namespace percale::c_interface;

namespace {

using Fields = std::vector<double*>;
using Counts = std::vector<int*>;

Fields figures_of(StepReport& report) {
    StageTimes& stages = report.stages;
    Fields fields{&report.time, &report.dt, &report.smallest_dt, &report.largest_dt, &report.residual, &report.smallest_fraction};
    fields.insert(fields.end(), {&report.smallest_distance, &report.contact_stiffness, &report.largest_strain, &report.travel,
                                 &report.time_error, &report.jump});
    fields.insert(fields.end(), {&report.largest_speed, &report.yielded, &report.stretch, &report.cpu_s, &stages.refresh});
    fields.insert(fields.end(), {&stages.evaluate, &stages.force, &stages.setup, &stages.solve, &stages.cut, &stages.measure});
    StepEnergy& energy = report.energy;
    fields.insert(fields.end(), {&energy.kinetic, &energy.gravity, &energy.elastic, &energy.contact, &energy.work});
    for (const auto entry : ledger_entries) fields.push_back(&(energy.*entry));
    return fields;
}

/// In the order of figures_of.
Fields figures_of(percale_step_report& reported) {
    Fields fields{&reported.time,       &reported.dt,       &reported.smallest_dt,
                  &reported.largest_dt, &reported.residual, &reported.smallest_fraction};
    fields.insert(fields.end(), {&reported.smallest_distance, &reported.contact_stiffness, &reported.largest_strain,
                                 &reported.travel, &reported.time_error, &reported.jump});
    fields.insert(fields.end(),
                  {&reported.largest_speed, &reported.yielded, &reported.stretch, &reported.cpu_s, &reported.refresh_s});
    fields.insert(fields.end(), {&reported.evaluate_s, &reported.force_s, &reported.setup_s, &reported.solve_s, &reported.cut_s,
                                 &reported.measure_s});
    fields.insert(fields.end(), {&reported.kinetic, &reported.gravity, &reported.elastic, &reported.contact, &reported.work});
    fields.insert(fields.end(), {&reported.dissipated_material, &reported.dissipated_friction, &reported.dissipated_contact});
    fields.insert(fields.end(), {&reported.dissipated_integrator, &reported.residual_work, &reported.imbalance});
    return fields;
}

Counts counts_of(StepReport& report) {
    DroppedSubsteps& dropped = report.dropped;
    Counts counts{&report.parts, &report.rejected, &report.newton_iterations, &report.linear_iterations};
    counts.insert(counts.end(), {&report.line_search_cuts, &report.halvings, &dropped.not_converged, &dropped.blocked});
    counts.insert(counts.end(), {&dropped.not_finite, &dropped.inexact, &report.sleeping_cloths, &report.contacts});
    counts.insert(counts.end(), {&report.blocked_cloth, &report.blocked_vertex, &report.blocking_obstacle, &report.pinched});
    counts.insert(counts.end(), {&report.pinching[0], &report.pinching[1], &report.second_obstacle});
    counts.insert(counts.end(), {&report.stretched_cloth, &report.stretched_pins});
    return counts;
}

/// In the order of counts_of.
Counts counts_of(percale_step_report& reported) {
    Counts counts{&reported.parts, &reported.rejected, &reported.newton_iterations, &reported.linear_iterations};
    counts.insert(counts.end(),
                  {&reported.line_search_cuts, &reported.halvings, &reported.dropped_not_converged, &reported.dropped_blocked});
    counts.insert(counts.end(),
                  {&reported.dropped_not_finite, &reported.dropped_inexact, &reported.sleeping_cloths, &reported.contacts});
    counts.insert(counts.end(),
                  {&reported.blocked_cloth, &reported.blocked_vertex, &reported.blocking_obstacle, &reported.pinched});
    counts.insert(counts.end(), {&reported.pinching[0], &reported.pinching[1], &reported.second_obstacle});
    counts.insert(counts.end(), {&reported.stretched_cloth, &reported.stretched_pins});
    return counts;
}

}  // namespace

TEST_CASE("A step report in C holds every figure of the one in C++, each in its place") {
    StepReport from;
    double figure = 1.5;
    int count = 1001;
    for (double* field : figures_of(from)) *field = figure++;
    for (int* field : counts_of(from)) *field = count++;
    from.contact_hash = 0x123456789abcdef0;
    from.linear_solver = LinearSolver::multigrid;
    from.status = StepStatus::work_limit;

    percale_step_report reported = c_report(from);
    CHECK(reported.struct_size == sizeof reported);
    CHECK(reported.status == PERCALE_STEP_WORK_LIMIT);
    CHECK(reported.linear_solver == std::string("multigrid"));
    CHECK(reported.contact_hash == from.contact_hash);
    const Fields figures = figures_of(reported);
    REQUIRE(figures.size() == figures_of(from).size());
    for (std::size_t i = 0; i < figures.size(); ++i) CHECK(*figures[i] == *figures_of(from)[i]);
    const Counts counts = counts_of(reported);
    REQUIRE(counts.size() == counts_of(from).size());
    for (std::size_t i = 0; i < counts.size(); ++i) CHECK(*counts[i] == *counts_of(from)[i]);
}

TEST_CASE("Each flag of a step report is 1 where it is true, and no other one") {
    for (bool StepReport::*flag : {&StepReport::slept, &StepReport::stopped, &StepReport::blocked_by_pin,
                                   &StepReport::yielded_in_vain, &StepReport::out_of_time}) {
        StepReport from;
        from.*flag = true;
        const percale_step_report reported = c_report(from);
        CHECK(reported.slept + reported.stopped + reported.blocked_by_pin + reported.yielded_in_vain + reported.out_of_time == 1);
        CHECK(reported.slept == (flag == &StepReport::slept ? 1 : 0));
        CHECK(reported.out_of_time == (flag == &StepReport::out_of_time ? 1 : 0));
        CHECK(reported.stopped == (flag == &StepReport::stopped ? 1 : 0));
        CHECK(reported.blocked_by_pin == (flag == &StepReport::blocked_by_pin ? 1 : 0));
    }
}

TEST_CASE("The fault of a start and its resolution are reported by number") {
    StartFault fault;
    fault.obstacle = 3;
    fault.intersecting_pairs = 4;
    fault.cloth_triangle = 5;
    fault.obstacle_triangle = 6;
    fault.other_cloth_triangle = 7;
    fault.vertices_inside = 8;
    fault.inside_vertex = 9;
    const percale_start_fault reported = c_start_fault(fault);
    CHECK(reported.obstacle == 3);
    CHECK(reported.intersecting_pairs == 4);
    CHECK(reported.cloth_triangle == 5);
    CHECK(reported.obstacle_triangle == 6);
    CHECK(reported.other_cloth_triangle == 7);
    CHECK(reported.vertices_inside == 8);
    CHECK(reported.inside_vertex == 9);
    const percale_start_move move = c_start_move({.cloth = 1, .obstacle = 2, .vertices_moved = 3, .largest_move = 0.5});
    CHECK(move.cloth == 1);
    CHECK(move.obstacle == 2);
    CHECK(move.vertices_moved == 3);
    CHECK(move.largest_move == 0.5);
}

TEST_CASE("A plan as lines states its scheme, warnings, counts and what is left out") {
    ScenePlan plan;
    plan.scheme_word = "tr_bdf2";
    plan.warnings.push_back({.kind = "ringing_step", .what = "it may ring", .fix = "use tr_bdf2"});
    plan.vertices = 12;
    plan.pinned_vertices = 2;
    plan.springs = {.structural = 31, .shear = 32, .bend = 33, .hinge = 34, .seam = 35, .triangle = 36};
    plan.skipped = {{"wind", "no air"}};
    const std::string text = plan_lines(plan);
    for (const char* part :
         {"scheme: tr_bdf2\n", "warning: it may ring; use tr_bdf2\n", "vertices: 12, 2 pinned\n", "31 structural", "32 shear",
          "33 bending", "35 of seams", "hinges: 34", "triangles: 36", "left out: wind: no air\n"}) {
        INFO(part);
        CHECK(text.find(part) != std::string::npos);
    }
}

}  // namespace percale::test::report_structs_test
