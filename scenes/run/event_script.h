#pragma once

#include <span>
#include <variant>
#include <vector>

#include "format/scene.h"

namespace percale::scenes {

/// What one event does, with cloths by number and vertices by index.
struct ScriptedPin {
    int cloth = 0;
    std::vector<int> vertices;
};
struct ScriptedUnpin {
    int cloth = 0;
    std::vector<int> vertices;
};
struct ScriptedMove {
    int cloth = 0;
    std::vector<int> vertices;
    Vec3 to = Vec3::Zero();  // m, displacement
    double over = 0.0;       // s, > 0
};
struct ScriptedGravity {
    Vec3 gravity = Vec3::Zero();  // m/s^2
};
struct ScriptedWind {
    Vec3 wind = Vec3::Zero();  // m/s
};
struct ScriptedEvent {
    double time = 0.0;  // s
    std::variant<ScriptedPin, ScriptedUnpin, ScriptedMove, ScriptedGravity, ScriptedWind> what;
};

/// The events of a scene in their order, against its rest meshes (in world coordinates, in the order of scene.cloths). Throws
/// SceneError with the event's place for an unknown cloth, a bad selection, or a move of a vertex that is not pinned then.
std::vector<ScriptedEvent> script_events(const Scene& scene, std::span<const TriangleMesh> cloth_meshes);

/// The gravity in a step about this time, m/s^2.
Vec3 gravity_at(const Scene& scene, double time);

}  // namespace percale::scenes
