#include "contact_precision_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "bench_scenes.h"
#include "data/generators/mannequin.h"
#include "data/generators/poncho.h"
#include "percale/detectors.h"
#include "tests/support/bench_unit.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test {
namespace {

using Placement = Eigen::Isometry3d;

Placement moved(double x, double y, double z) { return Placement(Eigen::Translation3d(x, y, z)); }

Placement turned(double angle, const Vec3& axis) { return Placement(Eigen::AngleAxisd(angle, axis.normalized())); }

TriangleMesh placed(TriangleMesh mesh, const Placement& placement) {
    for (Vec3& x : mesh.vertices) x = placement * x;
    return mesh;
}

/// One of the disturbed starts: a few millimetres and degrees off.
Placement disturbed_start(int number) {
    std::mt19937 random(static_cast<unsigned>(number) + 1);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const double x = part(random), y = part(random), z = part(random), angle = part(random), tilt = part(random);
    return moved(0.01 * x, 0.002 * y, 0.01 * z) * turned(0.1 * angle, {0.05 * tilt, 1.0, 0.05});
}

Fabric meeting_itself() {
    Fabric fabric = bench_fabric();
    fabric.self_contact = true;
    return fabric;
}

Simulation make_scene(const TriangleMesh& cloth, const Fabric& fabric, const TriangleMesh& body, const StepSettings& settings) {
    Simulation simulation(settings, make_fcl_detector());
    simulation.add_cloth(cloth, fabric);
    simulation.add_obstacle(body);
    return simulation;
}

Simulation make_drop(int n, const TriangleMesh& body, const StepSettings& settings, int start) {
    const Placement above = disturbed_start(start) * moved(0.0, 0.45, 0.0);
    return make_scene(placed(make_grid(1.0, 1.0, n, n), above), bench_fabric(), body, settings);
}

/// A sheet laid just above a slope of 25 degrees, with a friction of 0.3: it slides.
Simulation make_slide(int n, const StepSettings& settings, int start) {
    const Placement slope = turned(-25.0 * std::numbers::pi / 180.0, Vec3::UnitZ());
    const Vec3 offset = disturbed_start(start).translation();
    const TriangleMesh sheet = placed(make_grid(0.5, 0.5, n, n), slope * moved(offset.x(), 0.0052, offset.z()));
    return make_scene(sheet, bench_fabric(), placed(make_plane(5.0), slope), settings);
}

Simulation make_poncho_scene(int n, const StepSettings& settings, int start) {
    const Fabric felt{.area_density = 0.25, .springs = {.structural = 500.0, .shear = 0.0, .bend = 5.0}, .spring_damping = 1.0};
    static const TriangleMesh body = scenes::make_mannequin(0.015);
    const TriangleMesh poncho = scenes::make_poncho({.edge_length = n > 40 ? 0.018 : 0.036});
    return make_scene(placed(poncho, moved(0.0, 1.53, 0.0) * disturbed_start(start)), felt, body, settings);
}

/// A sheet lowered onto the floor, where it folds on itself.
Simulation make_fold(int n, const StepSettings& settings, int start) {
    const Placement upright = moved(0.0, 0.52, 0.0) * disturbed_start(start) * turned(0.5 * std::numbers::pi, Vec3::UnitX());
    return make_scene(placed(make_grid(0.4, 1.0, (2 * n) / 5, n), upright), meeting_itself(), make_plane(2.0), settings);
}

/// Five sheets that drop onto a ball, one after the other, two thicknesses apart.
Simulation make_five_sheets(int n, const StepSettings& settings, int start) {
    constexpr double radius = 0.15, angles[] = {0.0, 0.23, -0.16, 0.47, 0.1};
    const Fabric fabric = meeting_itself();
    Simulation simulation(settings, make_fcl_detector());
    simulation.add_obstacle(make_sphere(radius, 4));
    double height = radius + 0.05;
    for (const double angle : angles) {
        const Placement place = disturbed_start(start) * moved(0.0, height, 0.0) * turned(angle, Vec3::UnitY());
        simulation.add_cloth(placed(make_grid(0.5, 0.5, (n + 1) / 2, (n + 1) / 2), place), fabric);
        height += 2.0 * fabric.thickness;
    }
    return simulation;
}

/// Aside by up to a length, and turned by up to an angle.
Placement shifted(Random& random, double length, double angle) {
    const double x = random.number(-length, length), z = random.number(-length, length);
    return moved(x, 0.0, z) * turned(random.number(-angle, angle), Vec3::UnitY());
}

/// Ten sheets on a floor, laid down loosely and not exactly over each other.
Simulation make_pile(int n, const StepSettings& settings, int start) {
    const Fabric fabric = meeting_itself();
    const int count = std::max(9, n / 3);
    Random laid(0), disturbed(static_cast<unsigned>(start) + 1);
    Simulation simulation(settings, make_fcl_detector());
    simulation.add_obstacle(make_plane(2.0));
    for (int layer = 1; layer <= 10; ++layer) {
        const Placement aside = shifted(laid, 0.03, 0.3) * shifted(disturbed, 0.005, 0.05);
        simulation.add_cloth(placed(make_grid(0.3, 0.3, count, count), moved(0.0, 1.5 * layer * fabric.thickness, 0.0) * aside),
                             fabric);
    }
    return simulation;
}

constexpr double arm_radius = 0.06, arm_height = 0.4, arm_path = 0.25;  // m

/// A sleeve a fifth narrower than the arm, its hem pinned where the arm is widest, the rest above the hand, which has to widen
/// it. `count`: vertices around and along it. Layer 1 is worn over layer 0, turned by half an edge.
void add_sleeve(Simulation& simulation, int count, int layer, const Placement& disturbed) {
    constexpr double length = 0.3, thickness = 0.002, clearance = 1.5 * thickness;
    const Fabric jersey{.thickness = thickness,
                        .self_contact = true,
                        .damping_time = 0.01,
                        .stretch_stiffness = std::array{100.0, 100.0},
                        .bend_stiffness = 1e-5};
    const double half_edge = std::numbers::pi / count;  // rad
    const double radius = arm_radius / 1.2 + layer * clearance, outside = (layer + 1) * clearance;
    const TriangleMesh rest = make_tube({.low = radius, .top = radius, .height = length, .around = count, .rows = count});
    TriangleMesh worn = rest;
    for (Vec3& x : worn.vertices) {
        const double height = x.y() + 0.5 * length;
        const double half_width = std::sqrt(std::max(arm_radius * arm_radius - height * height, 0.0));
        const double wider = std::max(1.0, (half_width + outside) / std::cos(half_edge) / radius);
        x = {wider * x.x(), height, wider * x.z()};
    }
    worn = placed(worn, disturbed * turned(layer * half_edge, Vec3::UnitY()));
    const ClothId cloth = simulation.add_cloth(worn, jersey, {}, "sleeve", rest_shape_of(worn, rest, "sleeve"));
    for (int i = 0; i < count; ++i) simulation.pin(cloth, i);
}

/// Two taut sleeves, one over the other, that an arm is pushed into from below.
Simulation make_taut_shirt(int n, const StepSettings& settings, int start) {
    Simulation simulation(settings, make_fcl_detector());
    const TriangleMesh arm = make_capsule(arm_radius, arm_height, 48);
    simulation.add_obstacle(arm, {.translation = {0.0, -0.5 * arm_height, 0.0}}, {.friction = 0.1});
    Placement disturbed = disturbed_start(start);
    disturbed.translation() *= 0.05;
    for (const int layer : {0, 1}) add_sleeve(simulation, std::max(16, n / 2), layer, disturbed);
    return simulation;
}

void push_arm(Simulation& simulation, double end) {
    const double part = std::min(end / 0.8, 1.0), height = arm_path * part * part * (3.0 - 2.0 * part) - 0.5 * arm_height;
    simulation.move_obstacle(ObstacleId{0}, {.translation = {0.0, height, 0.0}});
}

}  // namespace

std::vector<ContactScene> contact_scenes() {
    static const TriangleMesh ball = make_sphere(0.25, 4), bunny = bunny_scan();
    const auto drop = [](const TriangleMesh& body) {
        return [&body](int n, const StepSettings& settings, int start) { return make_drop(n, body, settings, start); };
    };
    std::vector<ContactScene> kinds = {{"sphere", drop(ball)},
                                       {"incline", make_slide},
                                       {"poncho", make_poncho_scene},
                                       {"fold", make_fold},
                                       {"five_sheets", make_five_sheets},
                                       {"pile", make_pile},
                                       {"taut_shirt", make_taut_shirt, push_arm}};
    if (!bunny.triangles.empty()) kinds.insert(kinds.begin() + 1, {"scan", drop(bunny)});
    return kinds;
}

}  // namespace percale::test
