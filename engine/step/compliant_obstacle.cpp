#include "compliant_obstacle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "motion.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Surfaces give way from this fraction of the room that two activation distances have, at which the cloth between them begins
/// to be pressed. Larger: they give way before the contacts that show the pinch exist. Smaller: cloth is pressed hard.
constexpr double kept_room = 0.6;

/// h of room more than is kept that deflections leave unused, and h by which they return in a step. Slack 0: deflections go back
/// and forth for ever. Larger: they stay larger than necessary. Return larger: where cloth is just out of contact they come too
/// near, are pushed back, and tremble. Smaller: deflections last.
constexpr double deflection_slack = 0.2, deflection_return = 0.25;

/// h. A deflection that would change by less, and cloth that moves by less in a step, is at rest. 0: no deflection rests.
/// Larger: it stays where it should change.
constexpr double resting_deflection = 0.02;

/// h, and mean edges: how far around a pressing point the surface goes along. Smaller: spikes. Larger: deflections wider than
/// the cloth.
constexpr double deflection_thicknesses = 4.0, deflection_edges = 2.0;

/// Factor by which the corners around a pressing point retreat more than it has to, since a point inside a triangle moves less.
/// Smaller: more steps until there is room. Larger: more room than is kept.
constexpr double beyond_press = 1.2;

/// Weight in a contact from which it presses a vertex, and fraction of a retreat below which a vertex has not moved. Larger:
/// pairs that pinch are not seen. Smaller: places that hardly matter count.
constexpr double min_pressing_weight = 0.05, min_deflection_ratio = 0.1;

/// Passes over contacts between cloths; each sees through at least one layer. Fewer: thick bundles are pinched unseen.
constexpr int compliant_passes = 3;

/// A point of an obstacle that presses a vertex of cloth.
struct Presser {
    std::size_t constraint;                // in which a point of an obstacle presses
    Vec3 direction;                        // from that point to the cloth
    double distance, activation_distance;  // m, along cloth in between: its distance, and where contact would begin
};
using Pressers = std::map<int, std::vector<Presser>>;  // of each vertex

void add(Pressers& pressers, int vertex, const Presser& more) {
    std::vector<Presser>& here = pressers[vertex];
    const auto known = std::ranges::find_if(here, [&](const Presser& one) { return one.constraint == more.constraint; });
    if (known == here.end())
        here.push_back(more);
    else if (more.distance < known->distance)
        *known = more;
}

template <class Work>
void for_each_vertex(const ContactConstraints& constraints, std::size_t constraint, double sign, Work work) {
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        if (sign * constraints.weight[constraint][k] > min_pressing_weight) work(constraints.vertex[constraint][k]);
    }
}

/// Passes the pressers through a contact between cloths, from one side of it to the other.
void pass_through(const ContactConstraints& constraints, std::size_t constraint, double side, Pressers& pressers) {
    const Vec3 across = side * constraints.direction[constraint];
    std::vector<Presser> passed;
    for_each_vertex(constraints, constraint, -side, [&](int vertex) {
        for (const Presser& one : pressers[vertex]) {
            if (one.direction.dot(across) > same_side)
                passed.push_back({one.constraint, one.direction, one.distance + constraints.distance[constraint],
                                  one.activation_distance + constraints.thickness[constraint]});
        }
    });
    for (const Presser& one : passed)
        for_each_vertex(constraints, constraint, side, [&](int vertex) { add(pressers, vertex, one); });
}

Pressers pressers_of(const ContactConstraints& constraints) {
    Pressers pressers;
    bool layers = false;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        layers = layers || constraints.obstacle[constraint] < 0;
        if (constraints.obstacle[constraint] < 0) continue;
        const Presser one{constraint, constraints.direction[constraint], constraints.distance[constraint],
                          constraints.thickness[constraint]};
        for_each_vertex(constraints, constraint, 1.0, [&](int vertex) { add(pressers, vertex, one); });
    }
    for (int pass = 0; layers && pass < compliant_passes; ++pass) {
        for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
            if (constraints.obstacle[constraint] >= 0) continue;
            for (const double side : {1.0, -1.0}) pass_through(constraints, constraint, side, pressers);
        }
    }
    return pressers;
}

/// How far the pressing points of constraints have to go back, m; below 0: how much nearer they may come.
struct Retreats {
    std::vector<double> by_constraint;     // -infinity: nothing presses from the other side
    std::array<int, 2> obstacles{-1, -1};  // between which there is the smallest room
    double min_room = std::numeric_limits<double>::infinity();
};

Retreats retreats_of(const ContactConstraints& constraints, const Script& script) {
    Retreats retreats{.by_constraint = std::vector<double>(constraints.size(), -std::numeric_limits<double>::infinity())};
    const auto yields = [&](const Presser& one) {
        return script.obstacles[constraints.obstacle[one.constraint]].compliant != nullptr;
    };
    const auto keep_apart = [&](const Presser& a, const Presser& b) {
        const int sharers = int{yields(a)} + int{yields(b)};
        if (sharers == 0 || a.direction.dot(b.direction) > opposite_sides) return;
        const Vec3 closing = constraints.obstacle_displacement[b.constraint] - constraints.obstacle_displacement[a.constraint];
        const double room = a.distance + b.distance + closing.dot(a.direction);
        const double lack = kept_room * (a.activation_distance + b.activation_distance) - room;
        for (const Presser& one : {a, b}) {
            if (yields(one))
                retreats.by_constraint[one.constraint] = std::max(retreats.by_constraint[one.constraint], lack / sharers);
        }
        if (lack / sharers <= -deflection_slack * constraints.thickness[a.constraint] || room >= retreats.min_room) return;
        retreats.min_room = room;
        retreats.obstacles = {constraints.obstacle[a.constraint], constraints.obstacle[b.constraint]};
    };
    for (const auto& [vertex, pressers] : pressers_of(constraints)) {
        for (std::size_t i = 0; i < pressers.size(); ++i)
            for (std::size_t j = i + 1; j < pressers.size(); ++j) keep_apart(pressers[i], pressers[j]);
    }
    return retreats;
}

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
    surface.normals = normals_of(*obstacle.compliant, surface.places);
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
        const double edge = obstacle.start.scale * obstacle.compliant->edge;
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
    for (std::size_t i = 0; i < obstacle.next_deflection.size(); ++i) {
        Vec3& x = obstacle.next_deflection[i];
        const double depth = x.norm(), less = may_return[i] / obstacle.start.scale;
        if (less > 0.0) x = depth > less ? Vec3((1.0 - less / depth) * x) : Vec3(Vec3::Zero());
    }
}

/// Resets deflections that have hardly changed, unless they are gone.
void keep_resting(ObstacleState& obstacle, double thickness) {
    const double min = resting_deflection * thickness / obstacle.start.scale;
    bool any = false;
    for (std::size_t i = 0; i < obstacle.next_deflection.size(); ++i) {
        Vec3& x = obstacle.next_deflection[i];
        const Vec3 before = obstacle.deflection.empty() ? Vec3(Vec3::Zero()) : obstacle.deflection[i];
        if (x != Vec3::Zero() && (x - before).squaredNorm() < min * min) x = before;
        any = any || x != Vec3::Zero();
    }
    if (!any) obstacle.next_deflection.clear();
}

/// Sets the target shape with its deflections.
void go_to_deflected(ObstacleState& obstacle) {
    if (obstacle.next_deflection.empty()) return obstacle.go_to(obstacle.aim);
    auto shape = std::make_shared<std::vector<Vec3>>(*obstacle.aim);
    for (std::size_t i = 0; i < shape->size(); ++i) (*shape)[i] += obstacle.next_deflection[i];
    obstacle.go_to(std::move(shape));
}

void report_compliant(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        if (!obstacle.compliant) continue;
        go_to_deflected(obstacle);
        report_obstacle(obstacle, static_cast<int>(k), *scene.detector);
        obstacle.settled = !obstacle.moves();
    }
}

/// Whether nothing moves, and cloth moves so little that deflections stay.
bool all_rests(const StepScene& scene, const ClothState& cloth) {
    bool dented = false;
    for (const ObstacleState& obstacle : scene.script.obstacles) {
        if (obstacle.moves()) return false;
        dented = dented || !obstacle.deflection.empty();
    }
    if (!dented) return true;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.settings.time_step * cloth.velocities.at(i).norm() > resting_deflection * scene.model.thickness[i])
            return false;
    }
    return true;
}

/// Deflections stay as they are.
Pinches keep_deflections(Script& script) {
    for (ObstacleState& obstacle : script.obstacles) obstacle.next_deflection = obstacle.deflection;
    return {};
}

void add_deflection(ObstacleState& obstacle, std::span<const Vec3> moved) {
    const Pose turn{.rotation = obstacle.end.rotation, .scale = obstacle.end.scale};
    obstacle.next_deflection.resize(moved.size(), Vec3::Zero());
    for (std::size_t i = 0; i < moved.size(); ++i) obstacle.next_deflection[i] += inverse_transform(turn, moved[i]);
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
    if (!obstacle.compliant) return deflection.empty() && aim.empty();
    const std::vector<int>& place = obstacle.compliant->place;
    if (aim.size() != place.size() || !std::ranges::all_of(aim, &Vec3::allFinite)) return false;
    if (deflection.empty()) return true;
    if (deflection.size() != place.size() || !std::ranges::all_of(deflection, &Vec3::allFinite)) return false;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (deflection[i] != deflection[static_cast<std::size_t>(place[i])]) return false;
    }
    return true;
}

bool any_compliant(const Script& script) {
    return std::ranges::any_of(script.obstacles, [](const ObstacleState& obstacle) { return obstacle.compliant != nullptr; });
}

Pinches comply_with_cloth(World& world) {
    StepScene& scene = world.scene;
    std::vector<ObstacleState>& obstacles = scene.script.obstacles;
    if (!scene.plan.contacts) return {};
    if (all_rests(scene, world.state.cloth)) return keep_deflections(scene.script);
    const auto& points = world.state.cloth.points;
    const double thickness = *std::ranges::min_element(scene.model.thickness);
    for (ObstacleState& obstacle : obstacles) obstacle.next_deflection = obstacle.deflection;
    report_compliant(scene);
    ContactConstraints constraints;
    scene.detector->update_candidates(points, points);
    scene.detector->find_contacts(points, 0.0, constraints);
    const Retreats retreats = retreats_of(constraints, scene.script);
    Pinches pinches;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (!obstacles[k].compliant) continue;
        if (retreats.obstacles[0] < 0 && obstacles[k].deflection.empty()) continue;
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
        for (const Vec3& x : obstacle.deflection)
            squared = std::max(squared, obstacle.end.scale * obstacle.end.scale * x.squaredNorm());
    }
    return std::sqrt(squared);
}

}  // namespace percale
