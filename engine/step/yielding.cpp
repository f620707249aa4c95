#include "yielding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "motion.h"

namespace percale {
namespace {

/// Weights below press a vertex no more than its neighbours.
constexpr double least_weight = 0.05;
/// Cosine between directions from which on two pressing points are on opposite sides, and on one.
constexpr double opposite = -0.5, along = 0.5;
/// Layers of cloth between two obstacles through which they are seen.
constexpr int most_layers = 4;
/// A point inside a triangle gets less than the corners around a pressing point are moved: by this much more are they.
constexpr double beyond = 1.2;
/// Thicknesses and mean edges: how far around a pressing point the surface goes along.
constexpr double dent_thicknesses = 4.0, dent_edges = 2.0;

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
        if (sign * rows.weight[row][k] > least_weight) work(rows.vertex[row][k]);
    }
}

/// Through a contact between cloths, from one side of it to the other.
void pass_through(const ContactRows& rows, std::size_t row, double side, Pressers& pressers) {
    const Vec3 across = side * rows.direction[row];
    std::vector<Presser> passed;
    for_each_vertex(rows, row, -side, [&](int vertex) {
        for (const Presser& one : pressers[vertex]) {
            if (one.direction.dot(across) > along)
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
    for (int layer = 1; layers && layer < most_layers; ++layer) {
        for (std::size_t row = 0; row < rows.size(); ++row) {
            if (rows.obstacle[row] >= 0) continue;
            for (const double side : {1.0, -1.0}) pass_through(rows, row, side, pressers);
        }
    }
    return pressers;
}

/// How far the pressing points of rows have to go back, m, and where cloth has least room.
struct Retreats {
    std::vector<double> by_row;
    Pinches pinches;
    double least_room = std::numeric_limits<double>::infinity();
};

Retreats retreats_of(const ContactRows& rows, const Script& script) {
    Retreats retreats{.by_row = std::vector<double>(rows.size()), .pinches = {}};
    const auto yields = [&](const Presser& one) { return script.obstacles[rows.obstacle[one.row]].yielding != nullptr; };
    const auto keep_apart = [&](const Presser& a, const Presser& b) {
        const int sharers = int{yields(a)} + int{yields(b)};
        if (sharers == 0 || a.direction.dot(b.direction) > opposite) return;
        const Vec3 closing = rows.obstacle_displacement[b.row] - rows.obstacle_displacement[a.row];
        const double room = a.distance + b.distance + closing.dot(a.direction);
        const double lack = kept_room * (a.zone + b.zone) - room;
        if (lack <= 0.0) return;
        for (const Presser& one : {a, b}) {
            if (yields(one)) retreats.by_row[one.row] = std::max(retreats.by_row[one.row], lack / sharers);
        }
        if (room >= retreats.least_room) return;
        retreats.least_room = room;
        retreats.pinches.obstacles = {rows.obstacle[a.row], rows.obstacle[b.row]};
    };
    for (const auto& [vertex, pressers] : pressers_of(rows)) {
        for (std::size_t i = 0; i < pressers.size(); ++i)
            for (std::size_t j = i + 1; j < pressers.size(); ++j) keep_apart(pressers[i], pressers[j]);
    }
    for (const double retreat : retreats.by_row) retreats.pinches.count += retreat > 0.0 ? 1 : 0;
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

/// What the vertices of an obstacle give way by, m, world: about each pressing point against its direction.
std::vector<Vec3> pushed_back(const ObstacleState& obstacle, int number, const ContactRows& rows, const Retreats& retreats) {
    const std::vector<Vec3> x = transform(obstacle.start, *obstacle.start_shape), normals = normals_of(*obstacle.yielding, x);
    std::vector<Vec3> moved(x.size(), Vec3::Zero());
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows.obstacle[row] != number || retreats.by_row[row] == 0.0) continue;
        const Vec3& outward = rows.direction[row];
        const double radius =
            dent_thicknesses * rows.thickness[row] + dent_edges * obstacle.start.scale * obstacle.yielding->edge;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double s = (x[i] - rows.obstacle_point[row]).squaredNorm() / (radius * radius);
            const double facing = std::clamp(2.0 * normals[i].dot(outward), 0.0, 1.0);
            if (s >= 1.0 || facing == 0.0) continue;
            const double lack = beyond * (1.0 - s) * (1.0 - s) * facing * retreats.by_row[row] + moved[i].dot(outward);
            if (lack > 0.0) moved[i] -= lack * outward;
        }
    }
    return moved;
}

/// Dents a thickness nearer to nothing.
void relax_dent(ObstacleState& obstacle, double thickness) {
    double deepest = 0.0;
    obstacle.next_dent = obstacle.dent;
    for (Vec3& x : obstacle.next_dent) {
        const double depth = x.norm(), most = thickness / obstacle.start.scale;
        x = depth > most ? Vec3((1.0 - most / depth) * x) : Vec3(Vec3::Zero());
        deepest = std::max(deepest, x.squaredNorm());
    }
    if (deepest == 0.0) obstacle.next_dent.clear();
}

/// The shape that is aimed at, with its dents.
void go_to_dented(ObstacleState& obstacle) {
    if (obstacle.next_dent.empty()) return obstacle.go_to(obstacle.aim);
    auto shape = std::make_shared<std::vector<Vec3>>(*obstacle.aim);
    for (std::size_t i = 0; i < shape->size(); ++i) (*shape)[i] += obstacle.next_dent[i];
    obstacle.go_to(std::move(shape));
}

void tell_again(StepScene& scene) {
    for (std::size_t k = 0; k < scene.script.obstacles.size(); ++k) {
        const ObstacleState& obstacle = scene.script.obstacles[k];
        if (obstacle.yielding) tell_obstacle(obstacle, static_cast<int>(k), *scene.detector);
    }
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

bool any_yields(const Script& script) {
    return std::ranges::any_of(script.obstacles, [](const ObstacleState& obstacle) { return obstacle.yielding != nullptr; });
}

Pinches yield_to_cloth(World& world) {
    StepScene& scene = world.scene;
    const auto moves = [](const ObstacleState& obstacle) { return obstacle.moves(); };
    if (!scene.plan.contacts || std::ranges::none_of(scene.script.obstacles, moves)) return {};
    const auto& points = world.state.cloth.points;
    const double thickness = *std::ranges::min_element(scene.model.thickness);
    for (ObstacleState& obstacle : scene.script.obstacles) {
        if (!obstacle.yielding) continue;
        obstacle.aim = obstacle.end_shape;
        relax_dent(obstacle, thickness);
        go_to_dented(obstacle);
    }
    tell_again(scene);
    ContactRows rows;
    scene.detector->refresh(points, points);
    scene.detector->evaluate(points, 0.0, rows);
    const Retreats retreats = retreats_of(rows, scene.script);
    for (std::size_t k = 0; k < scene.script.obstacles.size() && retreats.pinches.count > 0; ++k) {
        ObstacleState& obstacle = scene.script.obstacles[k];
        if (!obstacle.yielding) continue;
        const Rotation& q = obstacle.end.rotation;
        const Pose back{.rotation = {q.w, -q.x, -q.y, -q.z}, .scale = 1.0 / obstacle.end.scale};
        const std::vector<Vec3> moved = transform(back, pushed_back(obstacle, static_cast<int>(k), rows, retreats));
        obstacle.next_dent.resize(moved.size(), Vec3::Zero());
        for (std::size_t i = 0; i < moved.size(); ++i) obstacle.next_dent[i] += moved[i];
        go_to_dented(obstacle);
    }
    if (retreats.pinches.count > 0) tell_again(scene);
    return retreats.pinches;
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
