#include "collision/c/report_structs.h"

#include <cstring>
#include <set>
#include <string>

#include "support/catch.h"

using namespace percale;
using namespace percale::c_interface;

namespace {

/// A report in which every figure is another one.
StepReport numbered_report() {
    StepReport report;
    double number = 1.5;
    int whole = 1001;
    for (double* field : {&report.time,
                          &report.dt,
                          &report.smallest_dt,
                          &report.largest_dt,
                          &report.residual,
                          &report.smallest_fraction,
                          &report.smallest_distance,
                          &report.contact_stiffness,
                          &report.largest_strain,
                          &report.largest_speed,
                          &report.travel,
                          &report.yielded,
                          &report.stretch,
                          &report.cpu_s,
                          &report.energy.kinetic,
                          &report.energy.gravity,
                          &report.energy.elastic,
                          &report.energy.contact,
                          &report.energy.work,
                          &report.stages.refresh,
                          &report.stages.evaluate,
                          &report.stages.force,
                          &report.stages.setup,
                          &report.stages.solve,
                          &report.stages.cut,
                          &report.stages.measure}) {
        *field = number++;
    }
    for (const auto entry : ledger_entries) report.energy.*entry = number++;
    for (int* field : {&report.parts,
                       &report.rejected,
                       &report.newton_iterations,
                       &report.linear_iterations,
                       &report.line_search_cuts,
                       &report.halvings,
                       &report.dropped.not_converged,
                       &report.dropped.blocked,
                       &report.dropped.not_finite,
                       &report.dropped.inexact,
                       &report.sleeping_cloths,
                       &report.contacts,
                       &report.blocked_cloth,
                       &report.blocked_vertex,
                       &report.blocking_obstacle,
                       &report.pinched,
                       &report.pinching[0],
                       &report.pinching[1],
                       &report.second_obstacle,
                       &report.stretched_cloth,
                       &report.stretched_pins}) {
        *field = whole++;
    }
    report.contact_hash = 0x123456789abcdef0;
    report.linear_solver = LinearSolver::multigrid;
    report.status = StepStatus::work_limit;
    return report;
}

}  // namespace

TEST_CASE("A step report in C holds every figure of the one in C++, each in its place") {
    const StepReport from = numbered_report();
    const percale_step_report told = c_report(from);
    CHECK(told.struct_size == sizeof told);
    CHECK(told.status == PERCALE_STEP_WORK_LIMIT);
    CHECK(told.linear_solver == std::string("multigrid"));
    CHECK(told.contact_hash == from.contact_hash);
    CHECK(std::set<double>{told.time,
                           told.dt,
                           told.smallest_dt,
                           told.largest_dt,
                           told.residual,
                           told.smallest_fraction,
                           told.smallest_distance,
                           told.contact_stiffness,
                           told.largest_strain,
                           told.largest_speed,
                           told.travel,
                           told.yielded,
                           told.stretch,
                           told.cpu_s,
                           told.kinetic,
                           told.gravity,
                           told.elastic,
                           told.contact,
                           told.work,
                           told.refresh_s,
                           told.evaluate_s,
                           told.force_s,
                           told.setup_s,
                           told.solve_s,
                           told.cut_s,
                           told.measure_s,
                           told.dissipated_material,
                           told.dissipated_friction,
                           told.dissipated_contact,
                           told.dissipated_integrator,
                           told.residual_work,
                           told.imbalance}
              .size() == 32);
    CHECK(told.time == from.time);
    CHECK(told.largest_speed == from.largest_speed);
    CHECK(told.measure_s == from.stages.measure);
    CHECK(told.imbalance == from.energy.imbalance);
    CHECK(std::set<int>{told.parts,
                        told.rejected,
                        told.newton_iterations,
                        told.linear_iterations,
                        told.line_search_cuts,
                        told.halvings,
                        told.dropped_not_converged,
                        told.dropped_blocked,
                        told.dropped_not_finite,
                        told.dropped_inexact,
                        told.sleeping_cloths,
                        told.contacts,
                        told.blocked_cloth,
                        told.blocked_vertex,
                        told.blocking_obstacle,
                        told.pinched,
                        told.pinching[0],
                        told.pinching[1],
                        told.second_obstacle,
                        told.stretched_cloth,
                        told.stretched_pins}
              .size() == 21);
    CHECK(told.parts == from.parts);
    CHECK(told.contacts == from.contacts);
    CHECK(told.stretched_pins == from.stretched_pins);
}

TEST_CASE("Each flag of a step report is 1 where it is true, and no other one") {
    for (bool StepReport::*flag :
         {&StepReport::slept, &StepReport::stopped, &StepReport::blocked_by_pin, &StepReport::yielded_in_vain}) {
        StepReport from;
        from.*flag = true;
        const percale_step_report told = c_report(from);
        CHECK(told.slept + told.stopped + told.blocked_by_pin + told.yielded_in_vain == 1);
        CHECK(told.slept == (flag == &StepReport::slept ? 1 : 0));
        CHECK(told.stopped == (flag == &StepReport::stopped ? 1 : 0));
        CHECK(told.blocked_by_pin == (flag == &StepReport::blocked_by_pin ? 1 : 0));
    }
}

TEST_CASE("The fault of a start and what repaired it are told by number") {
    StartFault fault;
    fault.obstacle = 3;
    fault.intersecting_pairs = 4;
    fault.cloth_triangle = 5;
    fault.obstacle_triangle = 6;
    fault.other_cloth_triangle = 7;
    fault.vertices_inside = 8;
    fault.inside_vertex = 9;
    const percale_start_fault told = c_start_fault(fault);
    CHECK(told.obstacle == 3);
    CHECK(told.intersecting_pairs == 4);
    CHECK(told.cloth_triangle == 5);
    CHECK(told.obstacle_triangle == 6);
    CHECK(told.other_cloth_triangle == 7);
    CHECK(told.vertices_inside == 8);
    CHECK(told.inside_vertex == 9);
    const percale_start_move move = c_start_move({.cloth = 1, .obstacle = 2, .vertices_moved = 3, .largest_move = 0.5});
    CHECK(move.cloth == 1);
    CHECK(move.obstacle == 2);
    CHECK(move.vertices_moved == 3);
    CHECK(move.largest_move == 0.5);
}

TEST_CASE("A plan as lines says its scheme, warnings, counts and what is left out") {
    ScenePlan plan;
    plan.scheme_word = "tr_bdf2";
    plan.warnings = {"it may ring"};
    plan.vertices = 12;
    plan.pinned_vertices = 2;
    plan.springs = {.structural = 31, .shear = 32, .bend = 33, .hinge = 34, .seam = 35, .triangle = 36};
    plan.skipped = {{"wind", "no air"}};
    const std::string text = plan_lines(plan);
    for (const char* part :
         {"scheme: tr_bdf2\n", "warning: it may ring\n", "vertices: 12, 2 pinned\n", "31 structural", "32 shear", "33 bending",
          "35 of seams", "hinges: 34", "triangles: 36", "left out: wind: no air\n"}) {
        INFO(part);
        CHECK(text.find(part) != std::string::npos);
    }
}
