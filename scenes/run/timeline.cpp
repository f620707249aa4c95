#include "run/timeline.h"

#include <algorithm>

#include "percale/error.h"
#include "run/obstacle_motion.h"

namespace percale::scenes {
namespace {

/// Fraction of a step by which an event may be late for it: times are sums of steps. 0: events come a step late.
constexpr double event_rounding = 1e-9;

void move_obstacle(BuiltScene& built, std::size_t i, std::span<const Vec3> shape, double end) {
    const Pose pose = obstacle_pose_at(built.scene.obstacles[i], end);
    if (pose != built.simulation.obstacle_pose(built.obstacles[i])) built.simulation.move_obstacle(built.obstacles[i], pose);
    if (!shape.empty()) built.simulation.deform_obstacle(built.obstacles[i], shape);
}

}  // namespace

Timeline::Timeline(const BuiltScene& built)
    : events_(script_events(built.scene, built.cloth_meshes)),
      attached_pins_(attached_pins(built.scene, built.cloth_meshes, built.obstacle_meshes)) {}

void Timeline::apply(BuiltScene& built, double time, double dt) {
    while (next_event_ < events_.size() && events_[next_event_].time <= time + event_rounding * dt)
        act(built, events_[next_event_++]);
    std::vector<std::vector<Vec3>> shapes(built.obstacles.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (built.shapes[i]) shapes[i] = built.shapes[i]->at(time + dt);
    }
    move_pins(built, shapes, time + dt);
    for (std::size_t i = 0; i < shapes.size(); ++i) move_obstacle(built, i, shapes[i], time + dt);
}

bool Timeline::more_to_come(const BuiltScene& built, double time) const {
    const Scene& scene = built.scene;
    const auto moves = [&](const ObstacleSpec& obstacle) {
        const bool spins = obstacle.spin && obstacle.spin->turns_per_s != 0.0;
        return spins || (!obstacle.motion.empty() && obstacle.motion.back().time > time);
    };
    const auto bends = [&](const auto& shapes) { return shapes && shapes->end() > time; };
    return next_event_ < events_.size() || !moving_pins_.empty() || std::ranges::any_of(built.shapes, bends) ||
           std::any_of(scene.obstacles.begin(), scene.obstacles.end(), moves) ||
           std::any_of(scene.seams.begin(), scene.seams.end(),
                       [&](const SeamSpec& seam) { return seam.start_time + seam.duration > time; });
}

void Timeline::go_on_from(const BuiltScene& built, const State& state) {
    const auto known = [&](const MovingPin& pin) {
        if (pin.cloth < 0 || pin.cloth >= static_cast<int>(built.cloth_meshes.size())) return false;
        const auto vertices = static_cast<int>(built.cloth_meshes[static_cast<std::size_t>(pin.cloth)].vertices.size());
        return pin.vertex >= 0 && pin.vertex < vertices;
    };
    const bool fits = state.next_event >= 0 && state.next_event <= static_cast<long>(events_.size()) &&
                      std::all_of(state.moving_pins.begin(), state.moving_pins.end(), known);
    if (!fits) throw SceneError("the state of the script is that of another scene");
    next_event_ = static_cast<std::size_t>(state.next_event);
    attached_pins_ = attached_pins(built.scene, built.cloth_meshes, built.obstacle_meshes);
    for (std::size_t k = 0; k < next_event_; ++k) forget_pins(events_[k]);
    moving_pins_ = state.moving_pins;
}

void Timeline::act(BuiltScene& built, const ScriptedEvent& event) {
    forget_pins(event);
    const auto id = [&](int cloth) { return built.cloths[static_cast<std::size_t>(cloth)]; };
    if (const auto* pin = std::get_if<ScriptedPin>(&event.what)) {
        for (const int vertex : pin->vertices) built.simulation.pin(id(pin->cloth), vertex);
    } else if (const auto* unpin = std::get_if<ScriptedUnpin>(&event.what)) {
        for (const int vertex : unpin->vertices) built.simulation.unpin(id(unpin->cloth), vertex);
    } else if (const auto* move = std::get_if<ScriptedMove>(&event.what)) {
        start_move(built, *move, event.time);
    } else if (const auto* wind = std::get_if<ScriptedWind>(&event.what)) {
        built.simulation.set_wind(wind->wind);
    } else {
        built.simulation.set_gravity(std::get<ScriptedGravity>(event.what).gravity);
    }
}

void Timeline::start_move(const BuiltScene& built, const ScriptedMove& move, double from) {
    const std::span<const Vec3> positions = built.simulation.positions(built.cloths[static_cast<std::size_t>(move.cloth)]);
    for (const int vertex : move.vertices)
        moving_pins_.push_back({move.cloth, vertex, positions[static_cast<std::size_t>(vertex)], move.to, from, move.over});
}

/// Forgets the motion of pins that an event moves or releases: the event takes them where they are.
void Timeline::forget_pins(const ScriptedEvent& event) {
    const auto forget = [&](const auto& of) {
        const auto is_one = [&](const auto& pin) {
            return pin.cloth == of.cloth && std::binary_search(of.vertices.begin(), of.vertices.end(), pin.vertex);
        };
        std::erase_if(moving_pins_, is_one);
        std::erase_if(attached_pins_, is_one);
    };
    if (const auto* unpin = std::get_if<ScriptedUnpin>(&event.what)) forget(*unpin);
    if (const auto* move = std::get_if<ScriptedMove>(&event.what)) forget(*move);
}

void Timeline::move_pins(BuiltScene& built, std::span<const std::vector<Vec3>> shapes, double end) {
    const auto fraction = [&](const MovingPin& pin) { return std::min(1.0, (end - pin.from) / pin.over); };
    for (const MovingPin& pin : moving_pins_) {
        const Vec3 target = pin.start + fraction(pin) * pin.displacement;
        built.simulation.move_pin(built.cloths[static_cast<std::size_t>(pin.cloth)], pin.vertex, target);
    }
    std::erase_if(moving_pins_, [&](const MovingPin& pin) { return fraction(pin) >= 1.0; });
    for (const AttachedPin& pin : attached_pins_) {
        const std::span<const Vec3> shape = shapes[static_cast<std::size_t>(pin.obstacle)];
        built.simulation.move_pin(built.cloths[static_cast<std::size_t>(pin.cloth)], pin.vertex,
                                  place_at(pin, built.scene, shape, end));
    }
}

}  // namespace percale::scenes
