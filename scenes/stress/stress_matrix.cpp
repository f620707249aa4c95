#include <algorithm>
#include <array>
#include <cmath>

#include "stress/stress.h"

namespace percale::scenes {

namespace {

constexpr std::array all_schemes = {Scheme::forward_euler,  Scheme::symplectic_euler,  Scheme::midpoint,  Scheme::rk4,
                                    Scheme::backward_euler, Scheme::implicit_midpoint, Scheme::trapezoid, Scheme::bdf2,
                                    Scheme::tr_bdf2};
constexpr std::array contact_schemes = {Scheme::backward_euler, Scheme::tr_bdf2};

/// What the base sweep, thrown and of damping ratio 0.1, has none of.
constexpr std::array other_dampings = {0.0, 1.0, 10.0};
constexpr std::array hard_starts = {StressStart::hang, StressStart::crumpled, StressStart::point};

struct BasePoint {
    double time_step, stiffness;  // s, N/m
};

/// The base points from easy to hard; the fastest mode times the step is 0.2, 6, 37, 600 and 20000 in turn.
constexpr BasePoint base_points[] = {{1e-3, 10.0}, {1e-2, 1e2}, {1.0 / 60.0, 1.3e3}, {1e-1, 1e4}, {1.0, 1e5}};

void add_base(std::vector<StressCell>& cells) {
    for (const Scheme scheme : all_schemes)
        for (int step = -8; step <= 0; ++step)
            for (int stiffness = 0; stiffness <= 16; ++stiffness)
                cells.push_back({.sweep = "base",
                                 .scheme = scheme,
                                 .time_step = std::pow(10.0, 0.5 * step),
                                 .stiffness = std::pow(10.0, 0.5 * stiffness)});
}

/// Each of the changes to the cell of each base point, with every scheme.
template <class Change>
void add_sweep(const char* name, std::span<const Scheme> schemes, int changes, Change change, std::vector<StressCell>& cells) {
    for (const Scheme scheme : schemes) {
        for (const BasePoint& point : base_points) {
            for (int k = 0; k < changes; ++k) {
                StressCell cell{.sweep = name, .scheme = scheme, .time_step = point.time_step, .stiffness = point.stiffness};
                change(k, cell);
                cells.push_back(cell);
            }
        }
    }
}

/// Slivers of three kinds and one random mesh.
void change_mesh(int kind, StressCell& cell) {
    constexpr std::array aspects = {1e2, 1e4, 1e6};
    cell.mesh = kind < 3 ? StressMesh::sliver : StressMesh::random;
    if (kind < 3) cell.aspect = aspects[static_cast<std::size_t>(kind)];
}

/// Cloth starts at rest and thrown; backward Euler has both responses with little and much damping, TR-BDF2, which takes one
/// response, has four amounts of damping.
void change_contact(int kind, StressCell& cell) {
    const int second = kind % 2, damping = kind / 4;
    cell.start = kind % 4 < 2 ? StressStart::hang : StressStart::thrown;
    cell.contact = StressContact::penalty;
    if (cell.scheme == Scheme::backward_euler) {
        if (second == 1) cell.contact = StressContact::projection;
        cell.damping_ratio = std::array{0.1, 1.0}[damping];
    } else {
        cell.damping_ratio = std::array{0.1, 0.0, 1.0, 10.0}[2 * damping + second];
    }
}

}  // namespace

std::vector<StressCell> stress_matrix() {
    std::vector<StressCell> cells;
    add_base(cells);
    add_sweep(
        "mass ratio", all_schemes, 6, [](int k, StressCell& cell) { cell.mass_ratio = std::pow(10.0, k + 1); }, cells);
    add_sweep(
        "damping", all_schemes, 3, [](int k, StressCell& cell) { cell.damping_ratio = other_dampings[k]; }, cells);
    add_sweep("mesh", all_schemes, 4, change_mesh, cells);
    add_sweep(
        "start", all_schemes, 3, [](int k, StressCell& cell) { cell.start = hard_starts[k]; }, cells);
    add_sweep("contact", contact_schemes, 8, change_contact, cells);
    for (std::size_t k = 0; k < cells.size(); ++k) cells[k].number = static_cast<int>(k);
    return cells;
}

}  // namespace percale::scenes
