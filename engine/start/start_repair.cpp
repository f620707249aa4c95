#include "start_repair.h"

#include <algorithm>
#include <sstream>

#include "forces/springs.h"
#include "step/step.h"
#include "support/deadline.h"

namespace percale {
namespace {

/// Strain that a start may have after initial penetration was resolved (where it had less before), and at which relaxing ends.
/// Larger: torn starts are accepted.
constexpr double max_start_strain = 0.5, good_start_strain = 0.1;

/// How often cloth leaves obstacles and cloth in turn. Fewer: cloth moved out of one is left in the other. Cost, of hopeless
/// starts.
constexpr int max_repair_turns = 8;

/// Steps of relaxing, and their length in s.
constexpr int max_relaxations = 60;
constexpr double relaxation_step = 1.0 / 60.0;

/// Fraction by which strain has to fall, and consecutive steps without such a fall after which relaxing ends. Fewer: starts are
/// refused that would have relaxed.
constexpr double relaxed_ratio = 0.01;
constexpr int max_idle_relaxations = 10;

/// Fraction of h. Vertices that resolving penetration moved by less are not reported.
constexpr double reported_move_ratio = 0.1;

/// The cause of a vertex's motion, if no obstacle.
constexpr int unmoved = -1, moved_by_cloth = -2;

/// State that steps change besides positions; restored when relaxing is over.
class Paused {
public:
    explicit Paused(World& world)
        : world_(world),
          settings_(world.scene.settings),
          time_(world.state.time),
          time_error_(world.state.time_error),
          velocities_(world.state.cloth.velocities),
          targets_(world.scene.script.pin_targets),
          obstacles_(world.scene.script.obstacles) {
        world.scene.settings.time_step = relaxation_step;
        world.scene.settings.scheme = Scheme::backward_euler;
        world.scene.settings.adaptive = false;
        world.scene.settings.gravity = Vec3::Zero();
        world.scene.settings.newton_tolerance.reset();
        world.scene.settings.newton_iterations = 1;  // linearly implicit: a part of the way, at a bounded cost
        world.scene.script.pin_targets = world.state.cloth.positions;
        for (ObstacleState& obstacle : world.scene.script.obstacles) {
            obstacle.end = obstacle.start;
            obstacle.end_shape = obstacle.start_shape;
        }
        scene_changed(world);
    }
    ~Paused() {
        world_.scene.settings = settings_;
        world_.state.time = time_;
        world_.state.time_error = time_error_;
        world_.state.cloth.velocities = velocities_;
        world_.state.cloth.stick_anchors.clear();
        world_.scene.script.pin_targets = targets_;
        for (std::size_t k = 0; k < obstacles_.size(); ++k) {
            world_.scene.script.obstacles[k].end = obstacles_[k].end;
            world_.scene.script.obstacles[k].end_shape = obstacles_[k].end_shape;
        }
        world_.state.contact_energy = 0.0;
        scene_changed(world_);
    }
    double time() const { return time_; }
    Paused(const Paused&) = delete;
    Paused& operator=(const Paused&) = delete;

private:
    World& world_;
    StepSettings settings_;
    double time_, time_error_;
    Vec3Arrays velocities_, targets_;
    std::vector<ObstacleState> obstacles_;
};

double strain(const World& world) { return largest_strain(world.scene.model.springs, world.state.cloth.positions); }

/// Relaxes until no spring is stretched beyond `enough`, or they relax no more.
void relax(World& world, double enough) {
    const Paused paused(world);
    double now = strain(world), min = now;
    for (int i = 0, idle = 0; i < max_relaxations && idle < max_idle_relaxations && now > enough; ++i) {
        for (int v = 0; v < world.scene.model.vertex_count(); ++v) world.state.cloth.velocities.set(v, Vec3::Zero());
        world.state.time = paused.time() - relaxation_step;  // seams do not close meanwhile
        if (!step(world).ok()) return;
        now = strain(world);
        idle = now < min * (1.0 - relaxed_ratio) ? 0 : idle + 1;
        min = std::min(min, now);
    }
}

/// Friction keeps its stick anchors at vertices that did not move.
void keep_stick_anchors(const ClothState& before, ClothState& now) {
    for (const StickAnchor& stick_anchor : before.stick_anchors) {
        if (now.points[stick_anchor.vertex] == before.points[stick_anchor.vertex]) now.stick_anchors.push_back(stick_anchor);
    }
}

void place(World& world, std::span<const Vec3> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (world.scene.script.free[i] > 0.0) world.state.cloth.positions.set(static_cast<int>(i), points[i]);
    }
    update_points(world.state.cloth);
}

StartMove& move_out_of(int obstacle, std::vector<StartMove>& moves) {
    const auto same = [&](const StartMove& move) { return move.obstacle == obstacle; };
    const auto found = std::find_if(moves.begin(), moves.end(), same);
    return found != moves.end() ? *found : moves.emplace_back(StartMove{.obstacle = obstacle});
}

/// The moved vertices of one cloth, by obstacles. Vertices that only relaxing moved are reported with the first obstacle.
std::vector<StartMove> moves_of(const World& world, const ClothRange& cloth, std::span<const Vec3> before,
                                std::span<const int> cause) {
    std::vector<StartMove> moves;
    const auto own = cause.subspan(cloth.first, cloth.count);
    const auto first = std::find_if(own.begin(), own.end(), [](int obstacle) { return obstacle != unmoved; });
    if (first == own.end()) return moves;
    for (int v = cloth.first; v < cloth.first + cloth.count; ++v) {
        const double displacement = (world.state.cloth.points[v] - before[v]).norm();
        if (displacement <= reported_move_ratio * world.scene.model.thickness[v]) continue;
        StartMove& move = move_out_of(cause[v] != unmoved ? cause[v] : *first, moves);
        ++move.vertices_moved;
        move.largest_move = std::max(move.largest_move, displacement);
    }
    return moves;
}

std::vector<StartMove> report_moves(const World& world, std::span<const Vec3> before, std::span<const int> cause) {
    std::vector<StartMove> all;
    for (std::size_t c = 0; c < world.scene.model.cloths.size(); ++c) {
        for (StartMove& move : moves_of(world, world.scene.model.cloths[c], before, cause)) {
            move.cloth = static_cast<int>(c);
            move.cloth_name = world.scene.model.cloths[c].name;
            move.obstacle = std::max(move.obstacle, -1);
            move.obstacle_name = move.obstacle < 0 ? "cloth" : world.scene.script.obstacles[move.obstacle].name;
            all.push_back(std::move(move));
        }
    }
    return all;
}

std::string strain_text(double strain) {
    std::ostringstream text;
    text << "the only way out found stretches a spring by " << 100.0 * strain << " %, allowed are 50 %";
    return text.str();
}

/// Moves cloth out of obstacles; false where the detector finds no way.
bool leave_obstacles(World& world, std::vector<int>& cause) {
    const auto& points = world.state.cloth.points;
    const std::optional<Untangled> out = world.scene.detector->untangle(points, {world.scene.script.free.data(), points.size()});
    if (!out) return false;
    for (std::size_t v = 0; v < cause.size(); ++v) {
        if (out->obstacle[v] >= 0) cause[v] = out->obstacle[v];
    }
    place(world, out->positions);
    return true;
}

/// Moves cloth out of cloth; false where the detector finds no way.
bool leave_cloth(World& world, std::vector<int>& cause) {
    const auto& points = world.state.cloth.points;
    const auto out = world.scene.detector->untangle_cloth(points, {world.scene.script.free.data(), points.size()});
    if (!out) return false;
    for (std::size_t v = 0; v < cause.size(); ++v) {
        if (cause[v] == unmoved && (*out)[v] != points[v]) cause[v] = moved_by_cloth;
    }
    place(world, *out);
    return true;
}

/// Leaves in turn whatever each way out leads into. Returns why the end is not clear, or an empty text; obstacles that the
/// detector counts as left are not left again.
std::string leave_all(World& world, StartFault fault, std::vector<int>& cause) {
    bool left_obstacles = false;
    for (int turn = 0; turn < max_repair_turns && fault.any(); ++turn) {
        if (left_obstacles && !fault.between_cloths()) return "";
        left_obstacles = !fault.between_cloths();
        const bool left = left_obstacles ? leave_obstacles(world, cause) : leave_cloth(world, cause);
        if (!left) return "no way out was found";
        fault = world.scene.detector->check_start(world.state.cloth.points);
    }
    return fault.any() ? "no clear way out was found" : "";
}

}  // namespace

StartRepair repair_start(World& world, StartFault fault) {
    const ClothState before = world.state.cloth;
    const double strain_before = strain(world);
    std::vector<int> cause(before.points.size(), unmoved);
    StartRepair repair{.moves = {}, .obstruction = leave_all(world, std::move(fault), cause)};
    if (is_cancelled({.time = {}, .cancel = world.cancel}))
        repair.obstruction = "its caller has cancelled the repair (set_cancel)";
    if (repair.obstruction.empty()) {
        relax(world, std::max(good_start_strain, strain_before));
        const double strain_after = strain(world);
        if (strain_after > std::max(max_start_strain, strain_before))
            repair.obstruction = strain_text(strain_after);
        else if (world.scene.detector->check_start(world.state.cloth.points).any())
            repair.obstruction = "no clear way out was found";
    }
    if (repair.obstruction.empty()) {
        repair.moves = report_moves(world, before.points, cause);
        keep_stick_anchors(before, world.state.cloth);
    } else {
        world.state.cloth = before;
    }
    return repair;
}

}  // namespace percale
