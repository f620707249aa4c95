#include "untangle/untangle.h"

#include <algorithm>
#include <iterator>

#include "geometry/signed_depth_convex.h"
#include "untangle/enclosure.h"
#include "untangle/untangle_spread.h"

namespace percale {
namespace {

/// (l - l0)/l0. A route that stretches an edge by more tears: others are preferred. The engine relaxes what is stretched.
constexpr double max_stretch = 0.5;

/// Factor by which a route that was too short grows, and how often the last growth is bisected. They affect cost, and how close
/// the route is to the shortest.
constexpr double reach_growth = 1.5;
constexpr int reach_refinements = 4;

/// Cosine between two directions above which they are one route. Smaller: routes are missed. Larger: searches are repeated.
constexpr double same_direction = 0.999;

/// Times h. Vertices that are farther away are not pushed to the nearest places of the surface.
constexpr double farthest_push = 8.0;

/// Limits at which untangling gives up: patches in all; rounds of one route; successive obstacles that cloth cannot be pushed out
/// of at once; searches for conflicts. Larger: hopeless starts take longer (seconds now). Smaller: solvable ones are refused.
constexpr int max_patches = 256, max_route_rounds = 60, max_push_failures = 64;
constexpr long max_conflict_searches = 4000;

/// A state that is being untangled.
struct Tangle {
    const TangledCloth& cloth;
    std::span<const SolidObstacle> obstacles;
    std::vector<Vec3> positions;
    std::vector<int> behind;    // obstacle, -1
    std::vector<double> limit;  // m, largest move of a vertex
    mutable long searches = 0;  // number of searches for conflicts

    bool cancelled() const { return cloth.cancel != nullptr && *cloth.cancel; }
    bool gives_up() const { return searches >= max_conflict_searches || cancelled(); }
    std::vector<int> conflicts(std::span<const Vec3> places, const std::vector<bool>& moved) const {
        ++searches;
        return find_conflicts(cloth, obstacles, places, moved);
    }
};

struct Patch {
    std::vector<int> vertices;
    std::vector<int> deep;  // those that are inside or behind it
    int obstacle = -1;
    double margin = 0.0;  // m, gap to leave between cloth and obstacle
};

/// A route out of the obstacle: along `direction`, or by the nearest place of the surface.
struct Route {
    bool nearest = false;
    Vec3 direction = Vec3::Zero();
    double reach = 0.0;  // m, the first to try
};

struct Attempt {
    std::vector<Vec3> positions;
    std::vector<bool> moved;
    double largest_move = 0.0, stretch = 0.0;

    bool tears() const { return stretch > max_stretch; }
    bool better_than(const Attempt& other) const {
        if (tears() != other.tears()) return other.tears();
        return tears() ? stretch < other.stretch : largest_move < other.largest_move;
    }
};

/// For each vertex the obstacle that it is in conflict with or behind, -1.
std::vector<int> conflicts_of(const Tangle& tangle) {
    std::vector<int> conflict = tangle.conflicts(tangle.positions, {});
    for (std::size_t v = 0; v < conflict.size(); ++v) {
        if (tangle.behind[v] >= 0) conflict[v] = tangle.behind[v];
    }
    return conflict;
}

void add_vertex(const Tangle& tangle, int vertex, int obstacle, Patch& patch) {
    patch.vertices.push_back(vertex);
    patch.margin = std::max(patch.margin, tangle.cloth.thickness[vertex]);
    const bool deep = tangle.behind[vertex] >= 0 || tangle.obstacles[obstacle].inside(tangle.positions[vertex]);
    if (deep) patch.deep.push_back(vertex);
}

/// The connected vertices in conflict that hold the lowest such vertex; empty where there are none.
Patch first_patch(const Tangle& tangle, std::vector<int> conflict) {
    Patch patch;
    const auto first = std::find_if(conflict.begin(), conflict.end(), [](int obstacle) { return obstacle >= 0; });
    if (first == conflict.end()) return patch;
    patch.obstacle = *first;
    std::vector<int> waiting{static_cast<int>(first - conflict.begin())};
    while (!waiting.empty()) {
        const int v = waiting.back();
        waiting.pop_back();
        if (conflict[v] < 0) continue;
        add_vertex(tangle, v, conflict[v], patch);
        conflict[v] = -1;
        waiting.insert(waiting.end(), tangle.cloth.neighbours[v].begin(), tangle.cloth.neighbours[v].end());
    }
    std::sort(patch.vertices.begin(), patch.vertices.end());
    return patch;
}

/// Adds a direction and its opposite, unless they are there already.
void add_both(const Vec3& direction, std::vector<Vec3>& directions) {
    if (!(direction.norm() > 0.0)) return;
    for (const Vec3& side : {Vec3(direction.normalized()), Vec3(-direction.normalized())}) {
        const auto same = [&](const Vec3& other) { return other.dot(side) > same_direction; };
        if (std::none_of(directions.begin(), directions.end(), same)) directions.push_back(side);
    }
}

Vec3 cloth_normal(const Tangle& tangle, const Patch& patch) {
    Vec3 normal = Vec3::Zero();
    const auto in_patch = [&](int v) { return std::binary_search(patch.vertices.begin(), patch.vertices.end(), v); };
    for (const Triangle& t : tangle.cloth.triangles) {
        if (!std::any_of(t.begin(), t.end(), in_patch)) continue;
        const auto& x = tangle.positions;
        normal += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    }
    return normal;
}

Vec3 obstacle_normal(const SolidObstacle& obstacle) {
    Vec3 normal = Vec3::Zero();
    for (const certificate::Corners& t : obstacle.triangles()) normal += (t[1] - t[0]).cross(t[2] - t[0]);
    return normal;
}

std::vector<Vec3> possible_directions(const Tangle& tangle, const Patch& patch) {
    const SolidObstacle& obstacle = tangle.obstacles[patch.obstacle];
    std::vector<Vec3> points, directions;
    for (const int v : patch.vertices) points.push_back(tangle.positions[v]);
    if (const auto overlap = hull_overlap(points, obstacle.vertices())) add_both(overlap->direction, directions);
    add_both(cloth_normal(tangle, patch), directions);
    if (!obstacle.watertight()) add_both(obstacle_normal(obstacle), directions);
    for (int axis = 0; axis < 3; ++axis) add_both(Vec3::Unit(axis), directions);
    return directions;
}

/// How far the deepest vertex of a patch has to go along a direction, m; nothing where most vertices have no exit there.
std::optional<double> reach_along(const Tangle& tangle, const Patch& patch, const Vec3& direction) {
    const SolidObstacle& obstacle = tangle.obstacles[patch.obstacle];
    double reach = 0.0;
    std::size_t lost = 0;
    for (const int v : patch.deep) {
        const std::optional<double> exit = obstacle.exit(tangle.positions[v], direction);
        reach = std::max(reach, exit.value_or(0.0));
        lost += exit ? 0 : 1;
    }
    if (2 * lost > patch.deep.size()) return std::nullopt;
    return reach + patch.margin;
}

/// The route by the nearest places of a watertight obstacle, then those along directions, the shortest first.
std::vector<Route> possible_routes(const Tangle& tangle, const Patch& patch) {
    std::vector<Route> routes;
    for (const Vec3& direction : possible_directions(tangle, patch)) {
        if (const auto reach = reach_along(tangle, patch, direction)) routes.push_back({false, direction, *reach});
    }
    std::stable_sort(routes.begin(), routes.end(), [](const Route& a, const Route& b) { return a.reach < b.reach; });
    if (tangle.obstacles[patch.obstacle].watertight()) routes.insert(routes.begin(), {true, Vec3::Zero(), patch.margin});
    return routes;
}

/// Obstacle, route and moved vertices of an attempt.
struct Plan {
    int obstacle;
    const Route& route;
    const std::vector<bool>& core;
};

Attempt attempt(const Tangle& tangle, const Plan& plan, double reach) {
    const auto& [obstacle, route, core] = plan;
    const std::vector<Vec3>& x = tangle.positions;
    std::vector<Vec3> moves(x.size(), Vec3::Zero());
    for (std::size_t v = 0; v < x.size(); ++v) {
        if (!core[v]) continue;
        moves[v] =
            route.nearest ? Vec3(tangle.obstacles[obstacle].pushed_out(x[v], reach) - x[v]) : Vec3(reach * route.direction);
    }
    spread_moves(tangle.cloth, x, core, tangle.limit, moves);
    Attempt result{.positions = x, .moved = std::vector<bool>(x.size())};
    for (std::size_t v = 0; v < x.size(); ++v) {
        result.positions[v] += moves[v];
        result.moved[v] = result.positions[v] != x[v];
        result.largest_move = std::max(result.largest_move, moves[v].norm());
    }
    result.stretch = largest_stretch(tangle.cloth, x, result.positions);
    return result;
}

/// Result of adding the moved vertices in conflict to the core: whether any vertex is in conflict, and whether any is new.
struct Growth {
    bool conflict = false, grown = false;
};

Growth grow_core(const Tangle& tangle, const Attempt& tried, std::vector<bool>& core) {
    const std::vector<int> conflict = tangle.conflicts(tried.positions, tried.moved);
    Growth growth;
    for (std::size_t v = 0; v < core.size(); ++v) {
        if (conflict[v] < 0 || !(tried.moved[v] || core[v])) continue;
        growth.conflict = true;
        growth.grown = growth.grown || !core[v];
        core[v] = true;
    }
    return growth;
}

struct Reaches {
    double too_short, enough;
};

/// Shortens the move of `good`, which is sufficient, towards one that is too short, by bisection.
Attempt shortened(const Tangle& tangle, const Plan& plan, Reaches reaches, Attempt good) {
    for (int k = 0; k < reach_refinements && reaches.too_short < reaches.enough && !tangle.cancelled(); ++k) {
        const double middle = 0.5 * (reaches.too_short + reaches.enough);
        Attempt shorter = attempt(tangle, plan, middle);
        std::vector<bool> core = plan.core;
        const bool enough = !grow_core(tangle, shorter, core).conflict;
        (enough ? reaches.enough : reaches.too_short) = middle;
        if (enough) good = std::move(shorter);
    }
    return good;
}

/// Follows one route until the patch and the cloth that moves with it are clear; nothing where that takes a move of `most` or
/// more.
std::optional<Attempt> follow(const Tangle& tangle, const Patch& patch, const Route& route, double max) {
    std::vector<bool> core(tangle.positions.size());
    for (const int v : patch.vertices) core[v] = true;
    double reach = route.reach, too_short = route.reach;
    const double farthest = route.nearest ? farthest_push * patch.margin : max;
    for (int round = 0; round < max_route_rounds && reach < farthest && !tangle.gives_up(); ++round) {
        Attempt found = attempt(tangle, {patch.obstacle, route, core}, reach);
        if (found.largest_move >= max) return std::nullopt;
        const Growth growth = grow_core(tangle, found, core);
        if (!growth.conflict) return shortened(tangle, {patch.obstacle, route, core}, {too_short, reach}, std::move(found));
        too_short = reach;
        if (!growth.grown) reach *= reach_growth;
    }
    return std::nullopt;
}

/// Length of the diagonal of everything, m.
double extent(const Tangle& tangle) {
    certificate::Box box;
    for (const Vec3& x : tangle.positions) box.add(x);
    for (const SolidObstacle& obstacle : tangle.obstacles) box.add(obstacle.tree().bounds());
    return (box.high - box.low).norm();
}

/// The triangles of the piece of cloth that a vertex belongs to.
std::vector<Triangle> piece_of(const TangledCloth& cloth, int vertex) {
    std::vector<bool> in_piece(static_cast<std::size_t>(cloth.vertex_count()));
    std::vector<int> waiting{vertex};
    while (!waiting.empty()) {
        const int v = waiting.back();
        waiting.pop_back();
        if (in_piece[v]) continue;
        in_piece[v] = true;
        waiting.insert(waiting.end(), cloth.neighbours[v].begin(), cloth.neighbours[v].end());
    }
    std::vector<Triangle> piece;
    std::copy_if(cloth.triangles.begin(), cloth.triangles.end(), std::back_inserter(piece),
                 [&](const Triangle& t) { return in_piece[t[0]]; });
    return piece;
}

std::optional<Attempt> best_attempt(const Tangle& tangle, const Patch& patch) {
    const double everything = extent(tangle);
    const Enclosure enclosure(piece_of(tangle.cloth, patch.vertices.front()), tangle.positions, tangle.obstacles[patch.obstacle]);
    std::optional<Attempt> best;
    for (const Route& route : possible_routes(tangle, patch)) {
        const double max = best && !best->tears() ? best->largest_move : everything;
        std::optional<Attempt> found = follow(tangle, patch, route, max);
        if (found && (!best || found->better_than(*best)) && !enclosure.lost(found->positions)) best = std::move(found);
    }
    return best;
}

bool holds_fixed(const Tangle& tangle, const Patch& patch) {
    return std::any_of(patch.deep.begin(), patch.deep.end(), [&](int v) { return !(tangle.cloth.free[v] > 0.0); });
}

void accept(Attempt found, int obstacle, Tangle& tangle, std::vector<int>& cause) {
    for (std::size_t v = 0; v < cause.size(); ++v) {
        if (found.moved[v]) cause[v] = obstacle;
    }
    tangle.positions = std::move(found.positions);
}

enum class Shallow { nothing_to_do, pushed_out, no_route };

/// Pushes all patches of a closed obstacle at once to the nearest places of its surface, if that tears nothing: garments overlap
/// bodies a little in hundreds of places. `conflict` belongs to the present state.
Shallow push_out_shallow(int obstacle, const std::vector<int>& conflict, Tangle& tangle, std::vector<int>& cause) {
    if (!tangle.obstacles[obstacle].watertight()) return Shallow::nothing_to_do;
    Patch all{.vertices = {}, .deep = {}, .obstacle = obstacle};
    for (std::size_t v = 0; v < conflict.size(); ++v) {
        if (conflict[v] == obstacle) add_vertex(tangle, static_cast<int>(v), obstacle, all);
    }
    if (all.vertices.empty()) return Shallow::nothing_to_do;
    const Patch first = first_patch(tangle, conflict);
    if (first.obstacle == obstacle && first.vertices.size() == all.vertices.size()) return Shallow::nothing_to_do;
    std::optional<Attempt> found = follow(tangle, all, {.nearest = true, .reach = all.margin}, extent(tangle));
    if (!found || found->tears()) return Shallow::no_route;
    accept(std::move(*found), obstacle, tangle, cause);
    return Shallow::pushed_out;
}

}  // namespace

std::optional<Untangled> untangle(const TangledCloth& cloth, std::span<const SolidObstacle> obstacles,
                                  std::span<const Vec3> positions) {
    Tangle tangle{.cloth = cloth,
                  .obstacles = obstacles,
                  .positions = {positions.begin(), positions.end()},
                  .behind = find_behind(cloth, obstacles, positions),
                  .limit = distance_from_fixed(cloth, positions)};
    std::vector<int> cause(positions.size(), -1);
    std::vector<int> conflict = conflicts_of(tangle);
    int failed = 0;
    for (int k = 0; k < static_cast<int>(obstacles.size()) && failed < max_push_failures; ++k) {
        const Shallow end = push_out_shallow(k, conflict, tangle, cause);
        if (end == Shallow::nothing_to_do) continue;
        failed = end == Shallow::no_route ? failed + 1 : 0;
        if (end == Shallow::pushed_out) conflict = conflicts_of(tangle);
    }
    for (int round = 0; round < max_patches; ++round) {
        const Patch patch = first_patch(tangle, std::move(conflict));
        if (patch.vertices.empty()) return Untangled{.positions = std::move(tangle.positions), .obstacle = std::move(cause)};
        if (holds_fixed(tangle, patch)) return std::nullopt;
        std::optional<Attempt> found = best_attempt(tangle, patch);
        if (!found) return std::nullopt;
        accept(std::move(*found), patch.obstacle, tangle, cause);
        for (const int v : patch.vertices) tangle.behind[v] = -1;
        conflict = conflicts_of(tangle);
    }
    return std::nullopt;
}

}  // namespace percale
