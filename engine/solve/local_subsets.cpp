#include "local_subsets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "line_search.h"
#include "support/deadline.h"
#include "support/stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Largest number of vertices that subsets begin with: a fraction of all, but not less than a number. More: subsets cost what
/// all cloth does.
constexpr double max_subset_vertices = 0.02;
constexpr int few_subset_vertices = 20;

/// Fractions of the residual's square: what these vertices are chosen to hold, and what they must hold for subsets to pay.
constexpr double subset_square = 0.95, min_subset_square = 0.8;

/// When the solve of a subset ends: at this fraction of its residual, or after so many iterations.
constexpr double subset_residual_ratio = 0.1;
constexpr int max_subset_iterations = 8;

/// Residual ratio that ends a subset's linear solve. Smaller: accuracy that the next state makes useless.
constexpr double subset_linear_ratio = 0.1;

/// Sets |r_i|^2/m_i of each vertex of bodies that are not settled, 0 of others; returns the sum.
double set_squares(const ClothModel& model, const BodyStates& bodies, const Vec3Arrays& residual, std::vector<double>& squares) {
    squares.assign(model.vertex_count(), 0.0);
    double sum = 0.0;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (bodies.settled(b)) continue;
        const Body& body = model.bodies[b];
        for (int i = body.first; i < body.first + body.count; ++i) {
            squares[i] = square_at(residual, i) / model.mass[i];
            sum += squares[i];
        }
    }
    return sum;
}

/// Sets `vertices` to the few that hold most of the residual; false where few do not.
bool choose_vertices(double sum, SubsetSpace& space) {
    const int count = static_cast<int>(space.squares.size());
    const int max = std::min(count, std::max(few_subset_vertices, static_cast<int>(max_subset_vertices * count)));
    space.order.resize(count);
    std::iota(space.order.begin(), space.order.end(), 0);
    const auto more = [&](int a, int b) {
        return space.squares[a] > space.squares[b] || (space.squares[a] == space.squares[b] && a < b);
    };
    std::partial_sort(space.order.begin(), space.order.begin() + max, space.order.end(), more);
    space.vertices.clear();
    double held = 0.0;
    for (int k = 0; k < max && held < subset_square * sum; ++k) {
        space.vertices.push_back(space.order[k]);
        held += space.squares[space.order[k]];
    }
    return sum > 0.0 && held >= min_subset_square * sum;
}

/// Adds the spring neighbours of the vertices, leaves out prescribed ones, and sorts.
void add_neighbours(const StepScene& scene, SubsetSpace& space) {
    const Adjacency& pattern = scene.model.adjacency;
    space.joined.assign(scene.model.vertex_count(), 0);
    for (const int v : space.vertices) space.joined[v] = 1;
    const std::size_t chosen = space.vertices.size();
    for (std::size_t k = 0; k < chosen; ++k) {
        const int slice = space.vertices[k] / slice_lanes, lane = space.vertices[k] % slice_lanes;
        for (int e = pattern.start[slice] + lane; e < pattern.start[slice + 1]; e += slice_lanes) {
            const int other = pattern.other[e];
            if (!space.joined[other]) space.vertices.push_back(other);
            space.joined[other] = 1;
        }
    }
    std::erase_if(space.vertices, [&](int v) { return !scene.is_free(v); });
    std::sort(space.vertices.begin(), space.vertices.end());
}

double residual_of(const std::vector<int>& vertices, const ClothModel& model, const Vec3Arrays& residual) {
    double sum = 0.0;
    for (const int v : vertices) sum += square_at(residual, v) / model.mass[v];
    return std::sqrt(sum);
}

/// Solves A dv = -r on the subset; dv is 0 elsewhere.
void set_subset_direction(const StageEquations& equations, const StagePoint& point, const SubsetTask& task, SubsetSpace& space) {
    NewtonSystem& system = task.system;
    {
        StageTimer timer(equations.times().setup);
        fill_matrix(point.forces.spring_terms, point.contact.blocks, point.forces.blocks, system.solver.matrix);
        space.system.fill(system.solver.matrix, space.vertices);
    }
    StageTimer timer(equations.times().solve);
    Vec3Arrays& direction = task.direction.velocity;
    set_zero(equations.stage().scene.compute, direction, equations.stage().scene.model.vertex_count());
    for (const int v : space.vertices) system.right_side.set(v, -point.residual.at(v));
    space.system.solve(system.right_side, subset_linear_ratio, direction);
}

}  // namespace

bool solve_subsets(StageEquations& equations, const SubsetTask& task, SubsetSpace& space, StagePoint& current,
                   StagePoint& trial) {
    const ClothModel& model = equations.stage().scene.model;
    if (!equations.arrived(current) || current.constraints.size() == 0 || !current.forces.blocks.loads.empty()) return false;
    const double sum = set_squares(model, task.bodies, current.residual, space.squares);
    if (!choose_vertices(sum, space)) return false;
    add_neighbours(equations.stage().scene, space);
    const auto residual = [&] { return residual_of(space.vertices, model, current.residual); };
    const double enough = subset_residual_ratio * residual();
    for (int n = 0; n < max_subset_iterations && residual() > enough && !is_past(task.time.deadline); ++n) {
        set_subset_direction(equations, current, task, space);
        const LineResult line = search_line(equations, {task.error, task.direction.velocity, task.bodies}, current, trial);
        if (line.stuck || line.backtracks == max_line_trials) break;
    }
    return true;
}

}  // namespace percale
