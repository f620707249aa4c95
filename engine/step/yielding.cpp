#include "yielding.h"

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

/// What presses a vertex of cloth.
struct Presser {
    std::size_t row;        // in which a point of an obstacle presses
    Vec3 direction;         // from it to the cloth
    double distance, zone;  // m, along cloth in between: how far it is, and where contact would begin
};
using Pressers = std::map<int, std::vector<Presser>>;  // of each vertex

void add(Pressers& pressers, int vertex, const Presser& more) {
    std::vector<Presser>& here = pressers[vertex];
    const auto known = std::ranges::find_if(here, [&](const Presser& one) { return one.row == more.row; });
    if (known == here.end())
        here.push_back(more);
    else if (more.distance < known->distance)
        *known = more;
}

template <class Work>
void for_each_vertex(const ContactRows& rows, std::size_t row, double sign, Work work) {
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
        if (sign * rows.weight[row][k] > least_pressing_weight) work(rows.vertex[row][k]);
    }
}

/// Through a contact between cloths, from one side of it to the other.
void pass_through(const ContactRows& rows, std::size_t row, double side, Pressers& pressers) {
    const Vec3 across = side * rows.direction[row];
    std::vector<Presser> passed;
    for_each_vertex(rows, row, -side, [&](int vertex) {
        for (const Presser& one : pressers[vertex]) {
            if (one.direction.dot(across) > same_side)
                passed.push_back({one.row, one.direction, one.distance + rows.distance[row], one.zone + rows.thickness[row]});
        }
    });
    for (const Presser& one : passed) for_each_vertex(rows, row, side, [&](int vertex) { add(pressers, vertex, one); });
}

Pressers pressers_of(const ContactRows& rows) {
    Pressers pressers;
    bool layers = false;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        layers = layers || rows.obstacle[row] < 0;
        if (rows.obstacle[row] < 0) continue;
        const Presser one{row, rows.direction[row], rows.distance[row], rows.thickness[row]};
        for_each_vertex(rows, row, 1.0, [&](int vertex) { add(pressers, vertex, one); });
    }
    for (int pass = 0; layers && pass < yielding_passes; ++pass) {
        for (std::size_t row = 0; row < rows.size(); ++row) {
            if (rows.obstacle[row] >= 0) continue;
            for (const double side : {1.0, -1.0}) pass_through(rows, row, side, pressers);
        }
    }
    return pressers;
}

/// How far the pressing points of rows have to go back, m; below 0: how much nearer they may come.
struct Retreats {
    std::vector<double> by_row;            // -infinity: nothing presses from the other side
    std::array<int, 2> obstacles{-1, -1};  // between which there is least room
    double least_room = std::numeric_limits<double>::infinity();
};

Retreats retreats_of(const ContactRows& rows, const Script& script) {
    Retreats retreats{.by_row = std::vector<double>(rows.size(), -std::numeric_limits<double>::infinity())};
    const auto yields = [&](const Presser& one) { return script.obstacles[rows.obstacle[one.row]].yielding != nullptr; };
    const auto keep_apart = [&](const Presser& a, const Presser& b) {
        const int sharers = int{yields(a)} + int{yields(b)};
        if (sharers == 0 || a.direction.dot(b.direction) > opposite_sides) return;
        const Vec3 closing = rows.obstacle_displacement[b.row] - rows.obstacle_displacement[a.row];
        const double room = a.distance + b.distance + closing.dot(a.direction);
        const double lack = kept_room * (a.zone + b.zone) - room;
        for (const Presser& one : {a, b}) {
            if (yields(one)) retreats.by_row[one.row] = std::max(retreats.by_row[one.row], lack / sharers);
        }
        if (lack / sharers <= -dent_slack * rows.thickness[a.row] || room >= retreats.least_room) return;
        retreats.least_room = room;
        retreats.obstacles = {rows.obstacle[a.row], rows.obstacle[b.row]};
    };
    for (const auto& [vertex, pressers] : pressers_of(rows)) {
        for (std::size_t i = 0; i < pressers.size(); ++i)
            for (std::size_t j = i + 1; j < pressers.size(); ++j) keep_apart(pressers[i], pressers[j]);
    }
    return retreats;
}

/// Outer normals where vertices are, of all triangles around by area; the same for vertices at one place.
std::vector<Vec3> normals_of(const YieldingMesh& mesh, const std::vector<Vec3>& x) {
    std::vector<Vec3> normals(x.size(), Vec3::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 area = (x[b] - x[a]).cross(x[c] - x[a]);
        for (const int v : {a, b, c}) normals[v] += area;
    }
    for (std::size_t i = 0; i < x.size(); ++i) normals[i] = normals[mesh.place[i]];
    for (Vec3& normal : normals) normal = normal.squaredNorm() > 0.0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
    return normals;
}

/// An obstacle that yields at the start of the step, m, world.
struct PressedSurface {
    std::vector<Vec3> places, normals;
    std::vector<Vec3> moved;         // what its vertices give way by
    std::vector<double> may_return;  // m, by how much their dents may go back
};

PressedSurface pressed_surface(const ObstacleState& obstacle, double thickness) {
    PressedSurface surface{
        .places = transform(obstacle.start, *obstacle.start_shape), .normals = {}, .moved = {}, .may_return = {}};
    surface.normals = normals_of(*obstacle.yielding, surface.places);
    surface.moved.resize(surface.places.size(), Vec3::Zero());
    surface.may_return.resize(surface.places.size(), dent_return * thickness);
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

/// About each pressing point against its direction, on the side from which the cloth is pressed, be the mesh wound outward or
/// not. Returns at how many of them a vertex gave way.
int push_back(const ObstacleState& obstacle, int number, const ContactRows& rows, const Retreats& retreats,
              PressedSurface& surface) {
    int pushed = 0;
    std::vector<std::pair<int, double>> around;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const double retreat = retreats.by_row[row];
        if (rows.obstacle[row] != number || std::isinf(retreat)) continue;
        const Vec3& outward = rows.direction[row];
        const double edge = obstacle.start.scale * obstacle.yielding->edge;
        find_around(surface.places, rows.obstacle_point[row], dent_thicknesses * rows.thickness[row] + dent_edges * edge, around);
        double facing = 0.0;
        for (const auto& [i, weight] : around) facing += weight * surface.normals[i].dot(outward);
        const double side = facing < 0.0 ? -2.0 : 2.0;
        bool gave = false;
        for (const auto& [i, weight] : around) {
            const double share = weight * std::clamp(side * surface.normals[i].dot(outward), 0.0, 1.0);
            if (share <= least_dent_share) continue;
            surface.may_return[i] = std::min(surface.may_return[i], std::max(0.0, -retreat - dent_slack * rows.thickness[row]));
            const double lack = beyond_press * share * retreat + surface.moved[i].dot(outward);
            gave = gave || retreat > -dent_slack * rows.thickness[row];
            if (retreat > 0.0 && lack > 0.0) surface.moved[i] -= lack * outward;
        }
        pushed += gave ? 1 : 0;
    }
    return pushed;
}

/// Dents nearer to nothing, by at most what they may, m.
void relax_dent(ObstacleState& obstacle, std::span<const double> may_return) {
    for (std::size_t i = 0; i < obstacle.next_dent.size(); ++i) {
        Vec3& x = obstacle.next_dent[i];
        const double depth = x.norm(), less = may_return[i] / obstacle.start.scale;
        if (less > 0.0) x = depth > less ? Vec3((1.0 - less / depth) * x) : Vec3(Vec3::Zero());
    }
}

/// What has hardly changed has not, but for what is gone.
void keep_resting(ObstacleState& obstacle, double thickness) {
    const double least = resting_dent * thickness / obstacle.start.scale;
    bool any = false;
    for (std::size_t i = 0; i < obstacle.next_dent.size(); ++i) {
        Vec3& x = obstacle.next_dent[i];
        const Vec3 before = obstacle.dent.empty() ? Vec3(Vec3::Zero()) : obstacle.dent[i];
        if (x != Vec3::Zero() && (x - before).squaredNorm() < least * least) x = before;
        any = any || x != Vec3::Zero();
    }
    if (!any) obstacle.next_dent.clear();
}

/// The shape that is aimed at, with its dents.
void go_to_dented(ObstacleState& obstacle) {
    if (obstacle.next_dent.empty()) return obstacle.go_to(obstacle.aim);
    auto shape = std::make_shared<std::vector<Vec3>>(*obstacle.aim);
    for (std::size_t i = 0; i < shape->size(); ++i) (*shape)[i] += obstacle.next_dent[i];
    obstacle.go_to(std::move(shape));
}

void tell_yielding(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        if (!obstacle.yielding) continue;
        go_to_dented(obstacle);
        tell_obstacle(obstacle, static_cast<int>(k), *scene.detector);
        obstacle.settled = !obstacle.moves();
    }
}

/// Nothing moves, and cloth so little that dents stay.
bool all_rests(const StepScene& scene, const ClothState& cloth) {
    bool dented = false;
    for (const ObstacleState& obstacle : scene.script.obstacles) {
        if (obstacle.moves()) return false;
        dented = dented || !obstacle.dent.empty();
    }
    if (!dented) return true;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.settings.time_step * cloth.velocities.at(i).norm() > resting_dent * scene.model.thickness[i]) return false;
    }
    return true;
}

/// Dents stay as they are.
Pinches keep_dents(Script& script) {
    for (ObstacleState& obstacle : script.obstacles) obstacle.next_dent = obstacle.dent;
    return {};
}

void add_dent(ObstacleState& obstacle, std::span<const Vec3> moved) {
    const Pose turn{.rotation = obstacle.end.rotation, .scale = obstacle.end.scale};
    obstacle.next_dent.resize(moved.size(), Vec3::Zero());
    for (std::size_t i = 0; i < moved.size(); ++i) obstacle.next_dent[i] += inverse_transform(turn, moved[i]);
}

}  // namespace

std::shared_ptr<const YieldingMesh> yielding_mesh(const TriangleMesh& mesh) {
    auto made = std::make_shared<YieldingMesh>();
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

bool are_dents_of(const ObstacleState& obstacle, std::span<const Vec3> dent, std::span<const Vec3> aim) {
    if (!obstacle.yielding) return dent.empty() && aim.empty();
    const std::vector<int>& place = obstacle.yielding->place;
    if (aim.size() != place.size() || !std::ranges::all_of(aim, &Vec3::allFinite)) return false;
    if (dent.empty()) return true;
    if (dent.size() != place.size() || !std::ranges::all_of(dent, &Vec3::allFinite)) return false;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (dent[i] != dent[static_cast<std::size_t>(place[i])]) return false;
    }
    return true;
}

bool any_yields(const Script& script) {
    return std::ranges::any_of(script.obstacles, [](const ObstacleState& obstacle) { return obstacle.yielding != nullptr; });
}

Pinches yield_to_cloth(World& world) {
    StepScene& scene = world.scene;
    std::vector<ObstacleState>& obstacles = scene.script.obstacles;
    if (!scene.plan.contacts) return {};
    if (all_rests(scene, world.state.cloth)) return keep_dents(scene.script);
    const auto& points = world.state.cloth.points;
    const double thickness = *std::ranges::min_element(scene.model.thickness);
    for (ObstacleState& obstacle : obstacles) obstacle.next_dent = obstacle.dent;
    tell_yielding(scene);
    ContactRows rows;
    scene.detector->refresh(points, points);
    scene.detector->evaluate(points, 0.0, rows);
    const Retreats retreats = retreats_of(rows, scene.script);
    Pinches pinches;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (!obstacles[k].yielding) continue;
        if (retreats.obstacles[0] < 0 && obstacles[k].dent.empty()) continue;
        PressedSurface surface = pressed_surface(obstacles[k], thickness);
        const int pushed = push_back(obstacles[k], static_cast<int>(k), rows, retreats, surface);
        relax_dent(obstacles[k], surface.may_return);
        if (pushed > 0) add_dent(obstacles[k], surface.moved);
        pinches.count += pushed;
        keep_resting(obstacles[k], thickness);
    }
    tell_yielding(scene);
    if (pinches.count > 0) pinches.obstacles = retreats.obstacles;
    return pinches;
}

double deepest_dent(const Script& script) {
    double squared = 0.0;
    for (const ObstacleState& obstacle : script.obstacles) {
        for (const Vec3& x : obstacle.dent)
            squared = std::max(squared, obstacle.end.scale * obstacle.end.scale * x.squaredNorm());
    }
    return std::sqrt(squared);
}

}  // namespace percale
