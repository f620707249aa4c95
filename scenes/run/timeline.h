#pragma once

#include "run/attached_pins.h"
#include "run/event_script.h"
#include "run/scene_build.h"

namespace percale::scenes {

/// Drives the scripted part of a scene: events, pin paths, obstacle motion.
class Timeline {
public:
    /// Throws SceneError with the place of an event that cannot be carried out (script_events()).
    explicit Timeline(const BuiltScene& built);

    /// Before the step from `time` to `time + dt`: applies the events due at or before `time` (to within a billionth of dt) and
    /// sets where pins and obstacles are at its end. A pin on an obstacle stays on it until it is moved or let go. A move lasts
    /// from its event's time on, so that where a pin arrives does not depend on the steps; it begins where the vertex is when the
    /// event is applied, and replaces an earlier move of the vertex.
    void apply(BuiltScene& built, double time, double dt);

    /// Whether something is still to happen after `time`: an event, a pin on its way, an obstacle that moves, a seam that closes.
    bool more_to_come(const BuiltScene& built, double time) const;

    struct MovingPin {
        int cloth = 0;
        int vertex = 0;
        Vec3 start = Vec3::Zero();
        Vec3 displacement = Vec3::Zero();
        double from = 0.0, over = 0.0;  // s
    };
    /// How far the script has come.
    struct State {
        long next_event = 0;
        std::vector<MovingPin> moving_pins;
    };
    State state() const { return {static_cast<long>(next_event_), moving_pins_}; }
    /// Continues from a state. Throws SceneError for a state of another scene.
    void go_on_from(const BuiltScene& built, const State& state);

private:
    void forget_pins(const ScriptedEvent& event);
    void act(BuiltScene& built, const ScriptedEvent& event);
    void start_move(const BuiltScene& built, const ScriptedMove& move, double from);
    /// `shapes`: of each obstacle at the end, before its pose; empty of a rigid one.
    void move_pins(BuiltScene& built, std::span<const std::vector<Vec3>> shapes, double end);

    std::vector<ScriptedEvent> events_;
    std::size_t next_event_ = 0;
    std::vector<MovingPin> moving_pins_;
    std::vector<AttachedPin> attached_pins_;  // but for those that events moved or let go
};

}  // namespace percale::scenes
