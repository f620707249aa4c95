#include <pybind11/stl.h>

#include "percale/plan.h"
#include "percale/report.h"
#include "python/module.h"

namespace percale::python {
namespace {

void bind_parts(py::module_& module) {
    py::class_<StepEnergy>(module, "StepEnergy",
                           "J: energies at the end of a step and what became of energy during it. NaN where it is not measured\n"
                           "(Simulation's setting measure: all or ledger).")
        .def_readonly("kinetic", &StepEnergy::kinetic)
        .def_readonly("gravity", &StepEnergy::gravity)
        .def_readonly("elastic", &StepEnergy::elastic)
        .def_readonly("contact", &StepEnergy::contact)
        .def_readonly("work", &StepEnergy::work, "Of pins and obstacles on the cloth.")
        .def_readonly("dissipated_material", &StepEnergy::dissipated_material)
        .def_readonly("dissipated_friction", &StepEnergy::dissipated_friction)
        .def_readonly("dissipated_contact", &StepEnergy::dissipated_contact)
        .def_readonly("dissipated_integrator", &StepEnergy::dissipated_integrator)
        .def_readonly("residual_work", &StepEnergy::residual_work)
        .def_readonly("imbalance", &StepEnergy::imbalance)
        .def_property_readonly("total", &StepEnergy::total, "kinetic + gravity + elastic + contact.")
        .def_property_readonly("dissipated", &StepEnergy::dissipated, "The sum of the four losses.");
    py::class_<DroppedSubsteps>(module, "DroppedSubsteps",
                                "How many substeps of a step were solved again in shorter ones, by their outcome.")
        .def_readonly("not_converged", &DroppedSubsteps::not_converged)
        .def_readonly("blocked", &DroppedSubsteps::blocked)
        .def_readonly("not_finite", &DroppedSubsteps::not_finite)
        .def_readonly("inexact", &DroppedSubsteps::inexact)
        .def_property_readonly("total", &DroppedSubsteps::total);
    py::class_<StageTimes>(module, "StageTimes", "CPU seconds of the calling thread, by stage of a step.")
        .def_readonly("refresh", &StageTimes::refresh)
        .def_readonly("evaluate", &StageTimes::evaluate)
        .def_readonly("force", &StageTimes::force)
        .def_readonly("setup", &StageTimes::setup)
        .def_readonly("solve", &StageTimes::solve)
        .def_readonly("cut", &StageTimes::cut)
        .def_readonly("measure", &StageTimes::measure);
    py::class_<StartMove>(module, "StartMove", "What was done to a cloth that started through, inside or touching something.")
        .def_readonly("cloth", &StartMove::cloth, "Its number.")
        .def_readonly("obstacle", &StartMove::obstacle, "The obstacle's number; -1: cloth.")
        .def_readonly("cloth_name", &StartMove::cloth_name)
        .def_readonly("obstacle_name", &StartMove::obstacle_name)
        .def_readonly("vertices_moved", &StartMove::vertices_moved, "By more than a tenth of the thickness.")
        .def_readonly("largest_move", &StartMove::largest_move, "m.");
}

void bind_counts(py::class_<StepReport>& report) {
    report.def_readonly("time", &StepReport::time, "s, at the end of the step.")
        .def_readonly("dt", &StepReport::dt, "s.")
        .def_readonly("smallest_dt", &StepReport::smallest_dt, "s, of the parts that the step was solved in.")
        .def_readonly("largest_dt", &StepReport::largest_dt, "s, likewise.")
        .def_readonly("parts", &StepReport::parts, "Lengths that it was made in.")
        .def_readonly("rejected", &StepReport::rejected, "Lengths that were tried and found too inexact.")
        .def_readonly("newton_iterations", &StepReport::newton_iterations)
        .def_readonly("linear_iterations", &StepReport::linear_iterations)
        .def_readonly("line_search_cuts", &StepReport::line_search_cuts)
        .def_property_readonly(
            "linear_solver", [](const StepReport& self) { return solver_word(self.linear_solver); },
            "none, cg, multigrid or direct: in use at the end.")
        .def_readonly("halvings", &StepReport::halvings, "How often a substep was solved again as two halves.")
        .def_readonly("dropped", &StepReport::dropped, "Why.")
        .def_readonly("residual", &StepReport::residual, "Relative to the first of the step, or to gravity's impulse.")
        .def_readonly("smallest_fraction", &StepReport::smallest_fraction, "Smallest part of a move that was free of crossing.")
        .def_readonly("sleeping_cloths", &StepReport::sleeping_cloths, "At rest.")
        .def_readonly("slept", &StepReport::slept, "All cloth was at rest: nothing was solved.")
        .def_readonly("stopped", &StepReport::stopped, "kinetic_damping set all velocities to 0 at its end.")
        .def_readonly("contacts", &StepReport::contacts, "Contact constraints at the end.")
        .def_readonly("smallest_distance", &StepReport::smallest_distance, "m; infinity if nothing was near.")
        .def_readonly("contact_stiffness", &StepReport::contact_stiffness, "N/m, largest of the step.")
        .def_readonly(
            "time_error", &StepReport::time_error,
            "m, estimated: what the length of the step costs in accuracy, in the mean of the worst cloth; 0 with explicit "
            "schemes, unless adaptive.")
        .def_readonly("largest_strain", &StepReport::largest_strain, "Of structural springs; NaN unless it is measured.")
        .def_readonly("largest_speed", &StepReport::largest_speed, "m/s; likewise.");
}

void bind_trouble(py::class_<StepReport>& report) {
    report.def_readonly("out_of_time", &StepReport::out_of_time, "set_time_limit ended it before it was solved.")
        .def_readonly("blocked_by_pin", &StepReport::blocked_by_pin, "The blocked vertex is a pinned one in an obstacle's path.")
        .def_readonly("blocked_cloth", &StepReport::blocked_cloth, "Number of the cloth that is blocked; -1: none.")
        .def_readonly("blocked_vertex", &StepReport::blocked_vertex)
        .def_readonly("blocking_obstacle", &StepReport::blocking_obstacle, "-1 where it is cloth, too.")
        .def_readonly("blocked_name", &StepReport::blocked_name)
        .def_readonly("blocking_name", &StepReport::blocking_name)
        .def_readonly("second_obstacle", &StepReport::second_obstacle, "Pushes the cloth towards the blocking one.")
        .def_readonly("second_name", &StepReport::second_name)
        .def_readonly("travel", &StepReport::travel, "m, of an obstacle or a pin that moves too far for a step.")
        .def_readonly("jump", &StepReport::jump, "m, of one that moves so far that the step was made in 8 parts or more.")
        .def_readonly("pinched", &StepReport::pinched, "Places where obstacles give way to cloth.")
        .def_readonly("yielded", &StepReport::yielded, "m, how far such an obstacle is from where it should be.")
        .def_readonly("yielded_in_vain", &StepReport::yielded_in_vain)
        .def_readonly("pinching", &StepReport::pinching, "Numbers of the obstacles between which cloth has least room.")
        .def_readonly("stretched_cloth", &StepReport::stretched_cloth,
                      "Of a step that failed or did not converge: stretched to more than twice its length.")
        .def_readonly("stretched_pins", &StepReport::stretched_pins)
        .def_readonly("stretch", &StepReport::stretch)
        .def_readonly("stretched_name", &StepReport::stretched_name)
        .def_readonly("wrong_derivative", &StepReport::wrong_derivative)
        .def_readonly("contact_hash", &StepReport::contact_hash, "Of the contact constraints at the end.")
        .def_readonly("energy", &StepReport::energy)
        .def_readonly("stages", &StepReport::stages)
        .def_readonly("cpu_s", &StepReport::cpu_s, "s, of all threads.");
}

void bind_plan(py::module_& module) {
    py::class_<ScenePlan>(module, "ScenePlan", "What the steps of a simulation will be made of, known without running one.")
        .def_property_readonly(
            "scheme", [](const ScenePlan& plan) { return plan.scheme_word; }, "As in settings.")
        .def_readonly("scheme_reason", &ScenePlan::scheme_reason, "Why, where scheme is auto.")
        .def_readonly("stable_step", &ScenePlan::stable_step, "s, longest stable step, estimated; infinity: always stable.")
        .def_property_readonly("warnings", &ScenePlan::warning_texts, "What will go wrong or be inexact.")
        .def_readonly("vertices", &ScenePlan::vertices)
        .def_readonly("pinned_vertices", &ScenePlan::pinned_vertices)
        .def_property_readonly(
            "springs",
            [](const ScenePlan& plan) {
                const SpringCounts& n = plan.springs;
                return std::map<std::string, int>{{"structural", n.structural}, {"shear", n.shear}, {"bend", n.bend},
                                                  {"hinge", n.hinge},           {"seam", n.seam},   {"triangle", n.triangle}};
            },
            "How many there are, by kind.")
        .def_readonly("obstacles", &ScenePlan::obstacles)
        .def_readonly("obstacle_triangles", &ScenePlan::obstacle_triangles)
        .def_property_readonly(
            "skipped",
            [](const ScenePlan& plan) {
                std::vector<std::pair<std::string, std::string>> skipped;
                for (const Skip& skip : plan.skipped) skipped.emplace_back(skip.what, skip.why);
                return skipped;
            },
            "(what, why) of work that is left out.")
        .def_readonly("memory_bytes", &ScenePlan::memory_bytes, "Predicted.")
        .def_readonly("evaluations_a_step", &ScenePlan::evaluations_a_step,
                      "Predicted cost, in evaluations of all spring forces.");
}

}  // namespace

void bind_reports(py::module_& module) {
    bind_parts(module);
    py::class_<StepReport> report(module, "StepReport",
                                  "What one step did. A failed step (not ok) leaves positions and velocities as they were.");
    report
        .def_property_readonly(
            "status", [](const StepReport& self) { return status_word(self.status); },
            "ok, halved, not_converged, tolerance_missed (accepted); pin_blocked, obstacle_too_fast, wrong_derivative,\n"
            "not_finite, work_limit, cancelled (failed).")
        .def_property_readonly("ok", &StepReport::ok, "Whether the step was accepted.")
        .def_property_readonly("explanation", &StepReport::explanation, "One sentence on what happened, with figures.")
        .def("__repr__", [](const StepReport& self) { return "<percale.StepReport: " + self.explanation() + ">"; });
    bind_counts(report);
    bind_trouble(report);
    bind_plan(module);
}

}  // namespace percale::python
