#include "plan_costs.h"

#include <algorithm>

#include "schemes/schemes.h"

namespace percale {
namespace {

// Bytes, as allocated after some steps of grids of 33 to 97 vertices a side.
struct MemoryShare {
    double vertex, spring;
};
constexpr MemoryShare implicit_memory = {1250.0, 375.0};  // with multigrid
constexpr MemoryShare explicit_memory = {430.0, 98.0};
constexpr double membrane_triangle_cost = 700.0;
constexpr double more_stages = 168.0;  // per vertex, of Runge-Kutta
constexpr double near_cloth_triangle = 270.0;
constexpr double obstacle_triangle = 475.0;

// Newton iterations of a step and linear iterations of each, on sheets of 65 x 65 vertices (percale_step_cost).
constexpr int free_newton = 3, contact_newton = 7;
constexpr double linear_iterations = 5.0;
// Cost over that of one evaluation of all springs.
constexpr double linear_cost = 1.5, newton_cost = 1.5, step_cost = 8.0;

}  // namespace

double predicted_memory(const StepPlan& plan, const SceneFacts& facts) {
    const MemoryShare share = plan.implicit ? implicit_memory : explicit_memory;
    double bytes = share.vertex * facts.cloth_vertices + share.spring * facts.springs.total();
    bytes += membrane_triangle_cost * facts.springs.triangle;
    if (plan.scheme == Scheme::rk4) bytes += more_stages * facts.cloth_vertices;
    if (plan.contacts) bytes += near_cloth_triangle * facts.cloth_triangles;
    return bytes + obstacle_triangle * static_cast<double>(facts.obstacle_triangles);
}

double predicted_evaluations(const StepPlan& plan, const StepSettings& settings) {
    if (!plan.solve) return 0.0;
    const SchemeFacts& facts = facts_of(plan.scheme);
    if (!plan.implicit) return plan.parts * facts.force_evaluations;
    const int newton = std::min(plan.contacts ? contact_newton : free_newton, settings.newton_iterations);
    return facts.stages * (newton * (linear_iterations * linear_cost + newton_cost) + step_cost);
}

}  // namespace percale
