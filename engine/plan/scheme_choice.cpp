#include "scheme_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/elastic.h"
#include "linear/linear_solver.h"
#include "percale/stability.h"
#include "plan_costs.h"
#include "schemes/schemes.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Power iterations for the highest frequency. Fewer: the frequency is too low, and the stable step too long.
constexpr int power_iterations = 40;

/// Fraction of the estimated stable step that `automatic` takes. 1: the estimate is an upper bound, and cloth may diverge.
constexpr double stable_step_ratio = 0.8;

/// s. The step that `automatic` assumes for adaptive TR-BDF2 where it compares costs.
constexpr double usual_implicit_step = 1.0 / 240;

/// w dt of trapezoid and implicit midpoint from which a plan warns that they ring.
constexpr double max_ringing_phase = 3.0;

/// Vertices above which a plan warns of one Newton iteration a step.
constexpr int fine_sheet_vertices = 4000;

/// Largest number of parts of a step, far more than are cheaper than an implicit one.
constexpr int max_explicit_parts = 1000;

/// Fraction of a spring's length in the differences of the forces of triangles and hinges. Smaller: rounding. Larger: curvature.
constexpr double shape_difference_ratio = 1e-5;

std::string rough_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

/// y = -Jq x by central differences of all elastic forces, for |x| = 1.
void multiply_shapes(const StepScene& scene, const ClothState& state, const Vec3Arrays& x, Vec3Arrays& y) {
    const double reach = shape_difference_ratio * scene.model.springs.rest_length.front();
    ElasticSpace space;
    ClothState moved = state;
    add_scaled(moved.positions, -reach, x);
    evaluate_elastic(scene.compute, scene.model, moved, space);
    y = space.forces.total;
    add_scaled(moved.positions, 2.0 * reach, x);
    evaluate_elastic(scene.compute, scene.model, moved, space);
    add_scaled(y, -1.0, space.forces.total);
    for (auto* axis : {&y.x, &y.y, &y.z}) {
        for (double& value : *axis) value *= 0.5 / reach;
    }
}

/// y = K x with the springs' blocks c d d^T, c stiffness or damping.
void multiply_springs(const ClothModel& model, const Vec3Arrays& positions, const std::vector<double>& constant,
                      const Vec3Arrays& x, Vec3Arrays& y) {
    const SpringNetwork& springs = model.springs;
    y.resize(model.vertex_count());
    for (int k = 0; k < springs.size(); ++k) {
        const int i = springs.first[k], j = springs.second[k];
        const Vec3 substep = positions.at(i) - positions.at(j);
        const double length = substep.norm();
        if (length == 0.0) continue;
        const Vec3 pull = constant[k] * substep.dot(x.at(i) - x.at(j)) / (length * length) * substep;
        y.add(i, pull);
        y.add(j, -pull);
    }
}

/// Largest eigenvalue of M^-1 K by power iteration, K x = multiply(x, y); prescribed vertices stay.
template <class Multiply>
double largest_eigenvalue(const StepScene& scene, Multiply multiply) {
    const int count = scene.model.vertex_count();
    Vec3Arrays x, y;
    x.resize(count);
    // Start vector: most neighbours have opposite signs, without symmetry, so that it is rich in the stiffest modes.
    for (int i = 0; i < count; ++i) x.set(i, Vec3(std::sin(2.9 * i + 1.0), std::sin(2.3 * i + 2.0), std::sin(2.6 * i + 3.0)));
    double value = 0.0;
    for (int iteration = 0; iteration < power_iterations; ++iteration) {
        const double size = std::sqrt(sum_terms(0, count, [&](int i) { return square_at(x, i); }));
        if (size == 0.0) return 0.0;
        multiply(x, y);
        for (int i = 0; i < count; ++i) y.set(i, scene.script.free[i] / scene.model.mass[i] * y.at(i));
        value = std::sqrt(sum_terms(0, count, [&](int i) { return square_at(y, i); })) / size;
        for (int i = 0; i < count; ++i) x.set(i, value > 0.0 ? Vec3(y.at(i) / (value * size)) : Vec3(Vec3::Zero()));
    }
    return value;
}

/// Largest square of an angular frequency, 1/s^2.
double largest_square(const StepScene& scene, const ClothState& state) {
    const ClothModel& model = scene.model;
    if (!has_shapes(model)) {
        return largest_eigenvalue(scene, [&](const Vec3Arrays& x, Vec3Arrays& y) {
            multiply_springs(model, state.positions, model.springs.stiffness, x, y);
        });
    }
    return largest_eigenvalue(scene, [&](const Vec3Arrays& x, Vec3Arrays& y) { multiply_shapes(scene, state, x, y); });
}

std::string word(Scheme scheme) { return std::string(facts_of(scheme).word); }

/// Cost of one second by an implicit scheme, in evaluations of all springs.
double implicit_cost(const StepScene& scene, const SceneFacts& facts, Scheme scheme, double dt) {
    StepSettings settings = scene.settings;
    settings.scheme = scheme;
    return predicted_evaluations(make_step_plan(settings, facts), settings) / dt;
}

bool has_contact(const StepScene& scene) {
    return !scene.script.obstacles.empty() || std::any_of(scene.model.cloths.begin(), scene.model.cloths.end(),
                                                          [](const ClothRange& cloth) { return cloth.fabric.self_contact; });
}

Scheme implicit_choice(const StepScene& scene) {
    const bool projects = scene.settings.contact_response == ContactResponse::projection && has_contact(scene);
    return scene.settings.adaptive && !projects ? Scheme::tr_bdf2 : Scheme::backward_euler;
}

Scheme explicit_choice(const StepScene& scene) { return scene.settings.adaptive ? Scheme::rk4 : Scheme::symplectic_euler; }

}  // namespace

double stable_step(const StepScene& scene, const ClothState& state, Scheme scheme) {
    const double limit = facts_of(scheme).stable_up_to;
    if (limit == 0.0 || std::isinf(limit)) return limit;
    const double square = largest_square(scene, state);
    if (square == 0.0) return std::numeric_limits<double>::infinity();
    const double damping = largest_eigenvalue(scene, [&](const Vec3Arrays& x, Vec3Arrays& y) {
        multiply_springs(scene.model, state.positions, scene.model.springs.damping, x, y);
    });
    return longest_stable_step(scheme, {square, damping});
}

SchemeChoice choose_scheme(const StepScene& scene, const ClothState& state, const SceneFacts& facts) {
    const bool adaptive = scene.settings.adaptive;
    const Scheme implicit = implicit_choice(scene), short_steps = explicit_choice(scene);
    if (has_contact(scene)) return {implicit, 1, "explicit schemes take no contact"};
    if (!scene.model.welds.empty()) return {implicit, 1, "explicit schemes take no welded seams"};
    if (!scene.model.limits.empty()) return {implicit, 1, "explicit schemes take no strain limit"};
    const double stable = stable_step_ratio * stable_step(scene, state, short_steps), dt = scene.settings.time_step;
    const double parts = adaptive ? 1.0 : std::max(1.0, std::ceil(dt / stable));
    const double tries = adaptive ? 3.0 : 1.0;  // a whole step and two halves
    const double length = adaptive ? stable : dt / parts;
    const double explicit_cost = tries * facts_of(short_steps).force_evaluations / length;
    const double other_cost = implicit_cost(scene, facts, implicit, adaptive ? std::min(dt, usual_implicit_step) : dt);
    const bool cheaper = explicit_cost < other_cost && parts <= max_explicit_parts;
    std::string reason = "a second of " + word(short_steps) + " in steps of " + rough_number(length) + " s costs " +
                         rough_number(explicit_cost) + " evaluations of all springs, one of " + word(implicit) + " " +
                         rough_number(other_cost);
    return {cheaper ? short_steps : implicit, cheaper ? static_cast<int>(parts) : 1, std::move(reason)};
}

bool can_be_chosen(const StepScene& scene, Scheme scheme, int parts) {
    const Scheme wish = scene.settings.scheme;
    if (wish != Scheme::automatic) return scheme == wish && parts == 1;
    if (scheme == explicit_choice(scene) && !has_contact(scene) && !scene.model.has_holds())
        return parts >= 1 && parts <= (scene.settings.adaptive ? 1 : max_explicit_parts);
    return scheme == implicit_choice(scene) && parts == 1;
}

namespace {

void warn_of_slivers(const StepScene& scene, std::vector<PlanWarning>& warnings) {
    if (factorises(scene.model, scene.settings.linear_solver)) return;
    for (const ClothRange& cloth : scene.model.cloths) {
        const double aspect = largest_aspect(scene.model, cloth);
        if (aspect > sliver_aspect)
            warnings.push_back(
                {"slivers_of_moduli",
                 "cloth '" + cloth.name + "' has moduli and triangles " + std::to_string(std::llround(std::min(aspect, 1e15))) +
                     " times as long as high: what iterative solvers leave can be more than the error of the time step",
                 "remesh it, or set linear_solver = \"direct\""});
    }
}

}  // namespace

std::vector<PlanWarning> step_warnings(const StepScene& scene, const ClothState& state, const StepPlan& plan, double stable) {
    std::vector<PlanWarning> warnings;
    const auto warn = [&](const char* kind, const std::string& what, const char* fix) { warnings.push_back({kind, what, fix}); };
    const double dt = scene.settings.time_step / plan.parts;
    const std::string step = "time_step " + rough_number(dt) + " s", scheme = word(plan.scheme);
    if (!plan.implicit && !scene.settings.adaptive && stable == 0.0)
        warn("growing_scheme", scheme + " makes every oscillation grow", "use rk4 or an implicit scheme");
    else if (!plan.implicit && !scene.settings.adaptive && dt > stable)
        warn("unstable_step",
             step + " is longer than the longest stable one of " + scheme + ", about " + rough_number(stable) +
                 " s: the cloth will fly apart",
             "");
    const bool undamped = plan.scheme == Scheme::trapezoid || plan.scheme == Scheme::implicit_midpoint;
    const double stiff = undamped && !scene.settings.adaptive ? dt * std::sqrt(largest_square(scene, state)) : 0.0;
    if (stiff > max_ringing_phase)
        warn("ringing_step",
             step + " is " + rough_number(stiff) +
                 " times the reciprocal of the highest frequency: what is so stiff rings under " + scheme +
                 " and can gain energy",
             "use backward_euler, or tr_bdf2 with time_step = \"auto\"");
    if (plan.implicit && scene.settings.newton_iterations == 1 && scene.model.vertex_count() > fine_sheet_vertices)
        warn("one_newton_iteration",
             "newton_iterations = 1 with " + std::to_string(scene.model.vertex_count()) +
                 " vertices: one linear solve leaves fine cloth far from the end of its step",
             "allow more");
    if (plan.implicit) warn_of_slivers(scene, warnings);
    return warnings;
}

}  // namespace percale
