#include "stress/stress_cell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "percale/detectors.h"

namespace percale::scenes {

namespace {

constexpr int side = 5;        // vertices along an edge of the cloth
constexpr double width = 0.4;  // m
constexpr double cell_width = width / (side - 1);
constexpr double density = 0.2;  // kg/m^2
constexpr std::uint32_t velocity_seed = 5;

/// Numbers in -1 ... 1, the same on every machine.
class Random {
public:
    double number() { return static_cast<double>(bits_()) / 2147483647.5 - 1.0; }
    Vec3 point() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }

private:
    std::mt19937 bits_{velocity_seed};
};

bool inside_circle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    // Two angles that face the diagonal b-d: its triangles are Delaunay's if they sum up to pi at most.
    const auto angle = [](const Vec3& at, const Vec3& one, const Vec3& other) {
        return std::atan2((one - at).cross(other - at).norm(), (one - at).dot(other - at));
    };
    return angle(a, b, d) + angle(c, b, d) > 3.14159265358979;
}

/// Rows and columns of points as a free mesh, each cell split along the diagonal of Delaunay's triangulation.
TriangleMesh triangulated(std::vector<Vec3> points, int columns) {
    TriangleMesh mesh{.vertices = std::move(points), .triangles = {}};
    const int rows = static_cast<int>(mesh.vertices.size()) / columns;
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c + 1 < columns; ++c) {
            const int a = r * columns + c, b = a + columns, d = a + 1, across = b + 1;
            const bool along = inside_circle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[across], mesh.vertices[d]);
            mesh.triangles.push_back(along ? Triangle{a, b, across} : Triangle{a, b, d});
            mesh.triangles.push_back(along ? Triangle{a, across, d} : Triangle{d, b, across});
        }
    }
    return mesh;
}

TriangleMesh random_mesh() {
    Random random;
    std::vector<Vec3> points = make_grid(width, width, side, side).vertices;
    for (Vec3& point : points) {
        const Vec3 off = 0.35 * cell_width * random.point();
        const bool corner = std::abs(point.x()) > 0.45 * width && std::abs(point.z()) > 0.45 * width;
        if (!corner) point += Vec3(off.x(), 0.0, off.z());
    }
    return triangulated(std::move(points), side);
}

/// The middle row lies so near the next one that the triangles between them have the aspect.
TriangleMesh sliver_mesh(double aspect) {
    std::vector<Vec3> points = make_grid(width, width, side, side).vertices;
    const int row = side / 2, next = row + 1;
    for (int c = 0; c < side; ++c) points[next * side + c].z() = points[row * side + c].z() + cell_width / aspect;
    return triangulated(std::move(points), side);
}

TriangleMesh mesh_of(const StressCell& cell) {
    if (cell.mesh == StressMesh::sliver) return sliver_mesh(cell.aspect);
    if (cell.mesh == StressMesh::random) return random_mesh();
    return make_grid(width, width, side, side);
}

/// The fabric without damping. Two cloths of a mass ratio r are lighter and heavier than a single one by its root.
Fabric undamped_fabric(const StressCell& cell, double density_factor) {
    const double shear = cell.mesh == StressMesh::grid ? 0.5 * cell.stiffness : 0.0;
    return {.area_density = density * density_factor,
            .springs = {.structural = cell.stiffness, .shear = shear, .bend = 0.01 * cell.stiffness},
            .spring_damping = 0.0};
}

StepSettings settings_of(const StressCell& cell) {
    const bool projects = cell.contact == StressContact::projection;
    return {.time_step = cell.time_step,
            .scheme = cell.scheme,
            .contact_response = projects ? ContactResponse::projection : ContactResponse::penalty,
            .measure = StepMeasures::ledger};
}

void add_ball(const StressCell& cell, Simulation& simulation) {
    if (cell.contact == StressContact::none) return;
    simulation.add_obstacle(make_sphere(0.1, 2), {.translation = Vec3(0.0, -0.15, 0.0)}, {.friction = 0.4, .name = "ball"});
}

/// The upper cloth, and the lower one where masses differ.
StressCase with_cloths(const StressCell& cell, const Fabric& fabric, StressCase made) {
    const TriangleMesh mesh = mesh_of(cell);
    made.cloths.push_back(made.simulation.add_cloth(mesh, fabric, {}, "cloth"));
    if (cell.mass_ratio == 1.0) return made;
    Fabric heavy = fabric;
    heavy.area_density *= cell.mass_ratio;
    made.cloths.push_back(made.simulation.add_cloth(mesh, heavy, {.translation = Vec3(0.0, 0.0, width)}, "heavy cloth"));
    std::vector<std::array<int, 2>> pairs;
    for (int c = 0; c < side; ++c) pairs.push_back({(side - 1) * side + c, c});
    made.simulation.add_seam(made.cloths[0], made.cloths[1], pairs, {.over = 0.0, .stiffness = cell.stiffness});
    return made;
}

void hold_corners(StressCase& made) {
    for (const int corner : {0, side - 1}) {
        made.simulation.pin(made.cloths[0], corner);
        made.held.push_back({made.cloths[0], corner, made.simulation.positions(made.cloths[0])[corner]});
    }
}

struct Motion {
    Vec3 position, velocity;
};

Motion started(const StressCell& cell, const Vec3& rest, Random& random) {
    const Vec3 off = random.point(), speed = random.point();
    switch (cell.start) {
        case StressStart::thrown:
            return {rest + 0.02 * off, speed};
        case StressStart::crumpled:
            return {0.02 * off, speed};
        case StressStart::point:
            return {Vec3(0.0, 0.1, 0.0), Vec3::Zero()};
        default:
            return {rest, Vec3::Zero()};
    }
}

void set_start(const StressCell& cell, StressCase& made) {
    if (cell.start == StressStart::hang) return;
    Random random;
    for (const ClothId cloth : made.cloths) {
        const std::span<const Vec3> rest = made.simulation.positions(cloth);
        std::vector<Vec3> positions, velocities;
        for (const Vec3& place : rest) {
            const Motion motion = started(cell, place, random);
            positions.push_back(motion.position);
            velocities.push_back(motion.velocity);
        }
        for (const HeldVertex& held : made.held)
            if (held.cloth.index == cloth.index) positions[held.vertex] = held.place;
        made.simulation.set_positions(cloth, positions);
        made.simulation.set_velocities(cloth, velocities);
    }
}

}  // namespace

const char* word_of(StressMesh mesh) { return std::array{"grid", "sliver", "random"}[static_cast<std::size_t>(mesh)]; }

const char* word_of(StressStart start) {
    return std::array{"hang", "thrown", "crumpled", "point"}[static_cast<std::size_t>(start)];
}

const char* word_of(StressContact contact) {
    return std::array{"none", "penalty", "projection"}[static_cast<std::size_t>(contact)];
}

double largest_square(const StressCell& cell) {
    // Undamped symplectic Euler is stable to 2/w.
    Simulation simulation({.scheme = Scheme::symplectic_euler});
    simulation.add_cloth(mesh_of(cell), undamped_fabric(cell, 1.0 / std::sqrt(cell.mass_ratio)));
    const double stable = simulation.plan().stable_step;
    return 4.0 / (stable * stable);
}

StressCase make_case(const StressCell& cell) {
    const bool contact = cell.contact != StressContact::none;
    StressCase made{
        .simulation = Simulation(settings_of(cell), contact ? make_fcl_detector() : nullptr), .cloths = {}, .held = {}};
    Fabric fabric = undamped_fabric(cell, 1.0 / std::sqrt(cell.mass_ratio));
    fabric.damping_time = 2.0 * cell.damping_ratio / std::sqrt(largest_square(cell));
    made = with_cloths(cell, fabric, std::move(made));
    add_ball(cell, made.simulation);
    hold_corners(made);
    set_start(cell, made);
    made.simulation.prepare();
    return made;
}

}  // namespace percale::scenes
