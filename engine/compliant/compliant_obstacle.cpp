#include "compliant_obstacle.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pinch.h"

namespace percale {
namespace {

/// h by which deflections return in a step. Larger: where cloth is just out of contact they come too near, are pushed back, and
/// tremble. Smaller: deflections last.
constexpr double deflection_return = 0.25;

/// h. A deflection that would change by less, and cloth that moves by less in a step, is at rest. 0: no deflection rests.
/// Larger: it stays where it should change.
constexpr double resting_deflection = 0.02;

/// h, and mean edges: how far around a pressing point the surface goes along. Smaller: spikes. Larger: deflections wider than
/// the cloth.
constexpr double deflection_thicknesses = 4.0, deflection_edges = 2.0;

/// Factor by which the corners around a pressing point retreat more than it has to, since a point inside a triangle moves less.
/// Smaller: more steps until there is room. Larger: more room than is kept.
constexpr double beyond_press = 1.2;

/// Fraction of a retreat below which a vertex has not moved. Smaller: places that hardly matter count.
constexpr double min_deflection_ratio = 0.1;

/// Outer normals at vertices, area-weighted over the triangles around them; the same for vertices at one place.
std::vector<Vec3> normals_of(const CompliantMesh& mesh, const std::vector<Vec3>& x) {
    std::vector<Vec3> normals(x.size(), Vec3::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 area = (x[b] - x[a]).cross(x[c] - x[a]);
        for (const int v : {a, b, c}) normals[v] += area;
    }
    for (std::size_t i = 0; i < x.size(); ++i) normals[i] = normals[mesh.place[i]];
    for (Vec3& normal : normals) normal = normal.squaredNorm() > 0.0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
    return normals;
}

/// A compliant obstacle at the start of the step, m, world.
struct PressedSurface {
    std::vector<Vec3> places, normals;
    std::vector<Vec3> moved;         // displacements by which its vertices give way
    std::vector<double> may_return;  // m, by how much their deflections may return
};

PressedSurface pressed_surface(const ObstacleState& obstacle, double thickness) {
    PressedSurface surface{
        .places = transform(obstacle.start, *obstacle.start_shape), .normals = {}, .moved = {}, .may_return = {}};
    surface.normals = normals_of(*obstacle.compliance.mesh, surface.places);
    surface.moved.resize(surface.places.size(), Vec3::Zero());
    surface.may_return.resize(surface.places.size(), deflection_return * thickness);
    return surface;
}

/// The vertices around a pressing point: number, and (1 - (s/R)^2)^2.
void find_around(const std::vector<Vec3>& places, const Vec3& point, double radius, std::vector<std::pair<int, double>>& around) {
    around.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double near = 1.0 - (places[i] - point).squaredNorm() / (radius * radius);
        if (near > 0.0) around.emplace_back(static_cast<int>(i), near * near);
    }
}

/// Moves the surface around each pressing point against its direction, on the side from which the cloth is pressed, whether the
/// mesh is wound outward or not. Returns at how many of these points a vertex gave way.
int push_back(const ObstacleState& obstacle, int number, const ContactConstraints& constraints, const Retreats& retreats,
              PressedSurface& surface) {
    int pushed = 0;
    std::vector<std::pair<int, double>> around;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const double retreat = retreats.by_constraint[constraint];
        if (constraints.obstacle[constraint] != number || std::isinf(retreat)) continue;
        const Vec3& outward = constraints.direction[constraint];
        const double edge = obstacle.start.scale * obstacle.compliance.mesh->edge;
        find_around(surface.places, constraints.obstacle_point[constraint],
                    deflection_thicknesses * constraints.thickness[constraint] + deflection_edges * edge, around);
        double facing = 0.0;
        for (const auto& [i, weight] : around) facing += weight * surface.normals[i].dot(outward);
        const double side = facing < 0.0 ? -2.0 : 2.0;
        bool gave = false;
        for (const auto& [i, weight] : around) {
            const double share = weight * std::clamp(side * surface.normals[i].dot(outward), 0.0, 1.0);
            if (share <= min_deflection_ratio) continue;
            surface.may_return[i] =
                std::min(surface.may_return[i], std::max(0.0, -retreat - deflection_slack * constraints.thickness[constraint]));
            const double lack = beyond_press * share * retreat + surface.moved[i].dot(outward);
            gave = gave || retreat > -deflection_slack * constraints.thickness[constraint];
            if (retreat > 0.0 && lack > 0.0) surface.moved[i] -= lack * outward;
        }
        pushed += gave ? 1 : 0;
    }
    return pushed;
}

/// Reduces deflections towards zero, by at most `may_return`, m.
void relax_deflection(ObstacleState& obstacle, std::span<const double> may_return) {
    for (std::size_t i = 0; i < obstacle.compliance.next_deflection.size(); ++i) {
        Vec3& x = obstacle.compliance.next_deflection[i];
        const double depth = x.norm(), less = may_return[i] / obstacle.start.scale;
        if (less > 0.0) x = depth > less ? Vec3((1.0 - less / depth) * x) : Vec3(Vec3::Zero());
    }
}

/// Resets deflections that have hardly changed, unless they are gone.
void keep_resting(ObstacleState& obstacle, double thickness) {
    const double min = resting_deflection * thickness / obstacle.start.scale;
    bool any = false;
    for (std::size_t i = 0; i < obstacle.compliance.next_deflection.size(); ++i) {
        Vec3& x = obstacle.compliance.next_deflection[i];
        const Vec3 before = obstacle.compliance.deflection.empty() ? Vec3(Vec3::Zero()) : obstacle.compliance.deflection[i];
        if (x != Vec3::Zero() && (x - before).squaredNorm() < min * min) x = before;
        any = any || x != Vec3::Zero();
    }
    if (!any) obstacle.compliance.next_deflection.clear();
}

/// Sets the target shape with its deflections.
void go_to_deflected(ObstacleState& obstacle) {
    if (obstacle.compliance.next_deflection.empty()) return obstacle.go_to(obstacle.compliance.aim);
    auto shape = std::make_shared<std::vector<Vec3>>(*obstacle.compliance.aim);
    for (std::size_t i = 0; i < shape->size(); ++i) (*shape)[i] += obstacle.compliance.next_deflection[i];
    obstacle.go_to(std::move(shape));
}

void report_compliant(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        if (!obstacle.compliance.mesh) continue;
        go_to_deflected(obstacle);
        obstacle.pass_to(*scene.detector, static_cast<int>(k));
        obstacle.settled = !obstacle.moves();
    }
}

/// Whether nothing moves, and cloth moves so little that deflections stay.
bool all_rests(const StepScene& scene, const ClothState& cloth) {
    bool deflected = false;
    for (const ObstacleState& obstacle : scene.script.obstacles) {
        if (obstacle.moves()) return false;
        deflected = deflected || !obstacle.compliance.deflection.empty();
    }
    if (!deflected) return true;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.settings.time_step * cloth.velocities.at(i).norm() > resting_deflection * scene.model.thickness[i])
            return false;
    }
    return true;
}

/// Deflections stay as they are.
Pinches keep_deflections(Script& script) {
    for (ObstacleState& obstacle : script.obstacles) obstacle.compliance.next_deflection = obstacle.compliance.deflection;
    return {};
}

void add_deflection(ObstacleState& obstacle, std::span<const Vec3> moved) {
    const Pose turn{.rotation = obstacle.end.rotation, .scale = obstacle.end.scale};
    obstacle.compliance.next_deflection.resize(moved.size(), Vec3::Zero());
    for (std::size_t i = 0; i < moved.size(); ++i) obstacle.compliance.next_deflection[i] += inverse_transform(turn, moved[i]);
}

}  // namespace

std::shared_ptr<const CompliantMesh> compliant_mesh(const TriangleMesh& mesh) {
    auto made = std::make_shared<CompliantMesh>();
    std::vector<int> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](int i) { return std::array{mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z()}; };
    std::ranges::sort(order, {}, [&](int i) { return std::pair(place(i), i); });
    made->place.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && place(order[k]) == place(order[k - 1]);
        made->place[order[k]] = same ? made->place[order[k - 1]] : order[k];
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        made->triangles.push_back({made->place[a], made->place[b], made->place[c]});
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            made->edge += (mesh.vertices[from] - mesh.vertices[to]).norm() / (3.0 * static_cast<double>(mesh.triangles.size()));
    }
    return made;
}

bool are_deflections_of(const ObstacleState& obstacle, std::span<const Vec3> deflection, std::span<const Vec3> aim) {
    if (!obstacle.compliance.mesh) return deflection.empty() && aim.empty();
    const std::vector<int>& place = obstacle.compliance.mesh->place;
    if (aim.size() != place.size() || !std::ranges::all_of(aim, &Vec3::allFinite)) return false;
    if (deflection.empty()) return true;
    if (deflection.size() != place.size() || !std::ranges::all_of(deflection, &Vec3::allFinite)) return false;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (deflection[i] != deflection[static_cast<std::size_t>(place[i])]) return false;
    }
    return true;
}

bool any_compliant(const Script& script) {
    return std::ranges::any_of(script.obstacles,
                               [](const ObstacleState& obstacle) { return obstacle.compliance.mesh != nullptr; });
}

Pinches comply_with_cloth(StepScene& scene, const ClothState& cloth) {
    std::vector<ObstacleState>& obstacles = scene.script.obstacles;
    if (!scene.plan.contacts) return {};
    if (all_rests(scene, cloth)) return keep_deflections(scene.script);
    const auto& points = cloth.points;
    const double thickness = *std::ranges::min_element(scene.model.thickness);
    for (ObstacleState& obstacle : obstacles) obstacle.compliance.next_deflection = obstacle.compliance.deflection;
    report_compliant(scene);
    ContactConstraints constraints;
    scene.detector->update_candidates(points, points);
    scene.detector->find_contacts(points, 0.0, constraints);
    const Retreats retreats = retreats_of(constraints, scene.script);
    Pinches pinches;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (!obstacles[k].compliance.mesh) continue;
        if (retreats.obstacles[0] < 0 && obstacles[k].compliance.deflection.empty()) continue;
        PressedSurface surface = pressed_surface(obstacles[k], thickness);
        const int pushed = push_back(obstacles[k], static_cast<int>(k), constraints, retreats, surface);
        relax_deflection(obstacles[k], surface.may_return);
        if (pushed > 0) add_deflection(obstacles[k], surface.moved);
        pinches.count += pushed;
        keep_resting(obstacles[k], thickness);
    }
    report_compliant(scene);
    if (pinches.count > 0) pinches.obstacles = retreats.obstacles;
    return pinches;
}

double largest_deflection(const Script& script) {
    double squared = 0.0;
    for (const ObstacleState& obstacle : script.obstacles) {
        for (const Vec3& x : obstacle.compliance.deflection)
            squared = std::max(squared, obstacle.end.scale * obstacle.end.scale * x.squaredNorm());
    }
    return std::sqrt(squared);
}

bool complies_in_vain(const Script& script, const StepReport& report) {
    if (report.status != StepStatus::obstacle_too_fast) return false;
    const auto yields = [&](int number) {
        return number >= 0 && script.obstacles[static_cast<std::size_t>(number)].compliance.mesh;
    };
    return yields(report.blocking_obstacle) || yields(report.second_obstacle);
}

}  // namespace percale
