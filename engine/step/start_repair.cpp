#include "start_repair.h"

#include <algorithm>
#include <sstream>

#include "forces/springs.h"
#include "plan/planning.h"
#include "step.h"

namespace percale {
namespace {

constexpr double most_strain = 0.5;
constexpr double good_strain = 0.1;             // relaxing ends there
constexpr int most_relaxations = 60;            // steps
constexpr double relaxation_step = 1.0 / 60.0;  // s
constexpr double seen_part = 0.1;               // of the thickness: smaller moves are not counted

/// What steps change besides positions; put back when relaxing is over.
class Paused {
public:
    explicit Paused(World& world)
        : world_(world),
          settings_(world.settings),
          time_(world.time),
          time_error_(world.time_error),
          velocities_(world.state.velocities),
          targets_(world.script.pin_targets),
          obstacles_(world.script.obstacles) {
        world.settings.time_step = relaxation_step;
        world.settings.scheme = Scheme::backward_euler;
        world.settings.adaptive = false;
        world.settings.gravity = Vec3::Zero();
        world.settings.newton_tolerance.reset();
        world.script.pin_targets = world.state.positions;
        for (ObstacleState& obstacle : world.script.obstacles) obstacle.end = obstacle.start;
        scene_changed(world);
    }
    ~Paused() {
        world_.settings = settings_;
        world_.time = time_;
        world_.time_error = time_error_;
        world_.state.velocities = velocities_;
        world_.state.grips.clear();
        world_.script.pin_targets = targets_;
        for (std::size_t k = 0; k < obstacles_.size(); ++k) world_.script.obstacles[k].end = obstacles_[k].end;
        world_.report = {};
        world_.contact_energy = 0.0;
        scene_changed(world_);
    }
    Paused(const Paused&) = delete;
    Paused& operator=(const Paused&) = delete;

private:
    World& world_;
    StepSettings settings_;
    double time_, time_error_;
    Vectors velocities_, targets_;
    std::vector<ObstacleState> obstacles_;
};

double strain(const World& world) { return largest_strain(world.model.springs, world.state.positions); }

void relax(World& world, double enough) {
    const Paused paused(world);
    for (int i = 0; i < most_relaxations && strain(world) > enough; ++i) {
        for (int v = 0; v < world.model.vertex_count(); ++v) world.state.velocities.set(v, Vec3::Zero());
        if (!step(world).ok()) return;
    }
}

void place(World& world, std::span<const Vec3> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (world.script.free[i] > 0.0) world.state.positions.set(static_cast<int>(i), points[i]);
    }
    update_points(world.state);
}

StartMove& move_out_of(int obstacle, std::vector<StartMove>& moves) {
    const auto same = [&](const StartMove& move) { return move.obstacle == obstacle; };
    const auto found = std::find_if(moves.begin(), moves.end(), same);
    return found != moves.end() ? *found : moves.emplace_back(StartMove{.obstacle = obstacle});
}

/// What moved of one cloth, by obstacles. What only relaxing moved is told with the first of them.
std::vector<StartMove> moves_of(const World& world, const ClothRange& cloth, std::span<const Vec3> before,
                                std::span<const int> cause) {
    std::vector<StartMove> moves;
    const auto own = cause.subspan(cloth.first, cloth.count);
    const auto first = std::find_if(own.begin(), own.end(), [](int obstacle) { return obstacle >= 0; });
    if (first == own.end()) return moves;
    for (int v = cloth.first; v < cloth.first + cloth.count; ++v) {
        const double way = (world.state.points[v] - before[v]).norm();
        if (way <= seen_part * world.model.thickness[v]) continue;
        StartMove& move = move_out_of(cause[v] >= 0 ? cause[v] : *first, moves);
        ++move.vertices_moved;
        move.largest_move = std::max(move.largest_move, way);
    }
    return moves;
}

std::vector<StartMove> tell_moves(const World& world, std::span<const Vec3> before, std::span<const int> cause) {
    std::vector<StartMove> all;
    for (std::size_t c = 0; c < world.model.cloths.size(); ++c) {
        for (StartMove& move : moves_of(world, world.model.cloths[c], before, cause)) {
            move.cloth = static_cast<int>(c);
            move.cloth_name = world.model.cloths[c].name;
            move.obstacle_name = world.script.obstacles[move.obstacle].name;
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

}  // namespace

StartRepair repair_start(World& world) {
    const ClothState before = world.state;
    const double strain_before = strain(world);
    const std::optional<Untangled> out =
        world.detector->untangle(before.points, {world.script.free.data(), before.points.size()});
    if (!out) return {.obstruction = "no way out was found"};
    place(world, out->positions);
    relax(world, std::max(good_strain, strain_before));
    StartRepair repair;
    const double strain_after = strain(world);
    if (strain_after > std::max(most_strain, strain_before))
        repair.obstruction = strain_text(strain_after);
    else if (world.detector->check_start(world.state.points).any())
        repair.obstruction = "no clear way out was found";
    if (repair.obstruction.empty())
        repair.moves = tell_moves(world, before.points, out->obstacle);
    else
        world.state = before;
    return repair;
}

}  // namespace percale
