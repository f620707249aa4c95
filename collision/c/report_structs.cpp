#include "c/report_structs.h"

#include <sstream>

#include "c/structs.h"
#include "percale/report.h"

namespace percale::c_interface {
namespace {

/// The energies of a step report and of percale_energy have the same names.
template <class Struct>
void write_energy(const StepEnergy& from, Struct& to) {
    to.kinetic = from.kinetic;
    to.gravity = from.gravity;
    to.elastic = from.elastic;
    to.contact = from.contact;
    to.work = from.work;
    to.dissipated_material = from.dissipated_material;
    to.dissipated_friction = from.dissipated_friction;
    to.dissipated_contact = from.dissipated_contact;
    to.dissipated_integrator = from.dissipated_integrator;
    to.residual_work = from.residual_work;
    to.imbalance = from.imbalance;
}

void write_solution(const StepReport& from, percale_step_report& to) {
    to.status = static_cast<int>(from.status);
    to.time = from.time;
    to.dt = from.dt;
    to.smallest_dt = from.smallest_dt;
    to.largest_dt = from.largest_dt;
    to.parts = from.parts;
    to.rejected = from.rejected;
    to.newton_iterations = from.newton_iterations;
    to.linear_iterations = from.linear_iterations;
    to.line_search_cuts = from.line_search_cuts;
    to.linear_solver = solver_word(from.linear_solver);
    to.halvings = from.halvings;
    to.dropped_not_converged = from.dropped.not_converged;
    to.dropped_blocked = from.dropped.blocked;
    to.dropped_not_finite = from.dropped.not_finite;
    to.dropped_inexact = from.dropped.inexact;
    to.residual = from.residual;
    to.time_error = from.time_error;
    to.smallest_fraction = from.smallest_fraction;
    to.sleeping_cloths = from.sleeping_cloths;
    to.slept = from.slept;
    to.out_of_time = from.out_of_time;
    to.stopped = from.stopped;
    to.contacts = from.contacts;
    to.smallest_distance = from.smallest_distance;
    to.contact_stiffness = from.contact_stiffness;
    to.largest_strain = from.largest_strain;
    to.largest_speed = from.largest_speed;
    to.contact_hash = from.contact_hash;
}

void write_trouble(const StepReport& from, percale_step_report& to) {
    to.blocked_by_pin = from.blocked_by_pin;
    to.blocked_cloth = from.blocked_cloth;
    to.blocked_vertex = from.blocked_vertex;
    to.blocking_obstacle = from.blocking_obstacle;
    to.travel = from.travel;
    to.jump = from.jump;
    to.pinched = from.pinched;
    to.yielded = from.yielded;
    to.yielded_in_vain = from.yielded_in_vain;
    std::ranges::copy(from.pinching, to.pinching);
    to.second_obstacle = from.second_obstacle;
    to.stretched_cloth = from.stretched_cloth;
    to.stretched_pins = from.stretched_pins;
    to.stretch = from.stretch;
}

}  // namespace

percale_energy c_energy(const StepEnergy& energy) {
    auto reported = default_struct<percale_energy>();
    write_energy(energy, reported);
    return reported;
}

percale_step_report c_report(const StepReport& report) {
    percale_step_report reported{};
    reported.struct_size = sizeof reported;
    write_solution(report, reported);
    write_trouble(report, reported);
    write_energy(report.energy, reported);
    reported.refresh_s = report.stages.refresh;
    reported.evaluate_s = report.stages.evaluate;
    reported.force_s = report.stages.force;
    reported.setup_s = report.stages.setup;
    reported.solve_s = report.stages.solve;
    reported.cut_s = report.stages.cut;
    reported.measure_s = report.stages.measure;
    reported.cpu_s = report.cpu_s;
    return reported;
}

template <>
percale_step_report default_struct() {
    return c_report({});
}

percale_start_fault c_start_fault(const StartFault& fault) {
    auto reported = default_struct<percale_start_fault>();
    reported.obstacle = fault.obstacle;
    reported.intersecting_pairs = fault.intersecting_pairs;
    reported.cloth_triangle = fault.cloth_triangle;
    reported.obstacle_triangle = fault.obstacle_triangle;
    reported.other_cloth_triangle = fault.other_cloth_triangle;
    reported.vertices_inside = fault.vertices_inside;
    reported.inside_vertex = fault.inside_vertex;
    return reported;
}

percale_start_move c_start_move(const StartMove& move) {
    return {move.cloth, move.obstacle, move.vertices_moved, move.largest_move};
}

std::string plan_lines(const ScenePlan& plan) {
    std::ostringstream text;
    text << "scheme: " << plan.scheme_word << (plan.scheme_reason.empty() ? "" : ", ") << plan.scheme_reason << '\n';
    text << "stable step: " << plan.stable_step << " s\n";
    for (const std::string& warning : plan.warning_texts()) text << "warning: " << warning << '\n';
    text << "vertices: " << plan.vertices << ", " << plan.pinned_vertices << " pinned\n";
    const SpringCounts& springs = plan.springs;
    text << "springs: " << springs.structural << " structural, " << springs.shear << " shear, " << springs.bend << " bending, "
         << springs.seam << " of seams; hinges: " << springs.hinge << "; membrane triangles: " << springs.triangle << '\n';
    text << "obstacles: " << plan.obstacles << ", triangles: " << plan.obstacle_triangles << '\n';
    for (const Skip& skip : plan.skipped) text << "left out: " << skip.what << ": " << skip.why << '\n';
    text << "memory: " << plan.memory_bytes << " bytes\n";
    text << "cost of a step: " << plan.evaluations_a_step << " evaluations of all spring forces\n";
    return text.str();
}

}  // namespace percale::c_interface
