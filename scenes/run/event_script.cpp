#include "run/event_script.h"

#include <set>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "garment/vertex_selection.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Follows which vertices are pinned while the events pass by.
class Script {
public:
    Script(const Scene& scene, std::span<const TriangleMesh> meshes) : scene_(scene), meshes_(meshes) {
        for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
            const ClothSpec& cloth = scene.cloths[i];
            const std::vector<int> pins = select_vertices(cloth.pin, meshes[i], cloth.name);
            pinned_.emplace_back(pins.begin(), pins.end());
        }
    }

    ScriptedEvent scripted(const EventSpec& event) {
        return at_place(event.place, "event: ", [&] {
            return ScriptedEvent{event.time, std::visit([this](const auto& what) { return read(what); }, event.what)};
        });
    }

private:
    using What = decltype(ScriptedEvent::what);

    std::size_t cloth_number(const std::string& name) const {
        for (std::size_t i = 0; i < scene_.cloths.size(); ++i)
            if (scene_.cloths[i].name == name) return i;
        throw SceneError("no cloth '" + name + "'");
    }

    What read(const PinEvent& event) {
        const std::size_t cloth = cloth_number(event.cloth);
        const std::vector<int> vertices = select_vertices(event.vertices, meshes_[cloth], event.cloth);
        pinned_[cloth].insert(vertices.begin(), vertices.end());
        return ScriptedPin{static_cast<int>(cloth), vertices};
    }

    What read(const UnpinEvent& event) {
        const std::size_t cloth = cloth_number(event.cloth);
        const std::vector<int> vertices = select_vertices(event.vertices, meshes_[cloth], event.cloth);
        for (const int vertex : vertices) pinned_[cloth].erase(vertex);
        return ScriptedUnpin{static_cast<int>(cloth), vertices};
    }

    What read(const MoveEvent& event) {
        const std::size_t cloth = cloth_number(event.cloth);
        const std::vector<int> vertices = select_vertices(event.vertices, meshes_[cloth], event.cloth);
        for (const int vertex : vertices)
            if (!pinned_[cloth].contains(vertex))
                throw SceneError("only pinned vertices can be moved; vertex " + std::to_string(vertex) + " of cloth '" +
                                 event.cloth + "' is not pinned then");
        return ScriptedMove{static_cast<int>(cloth), vertices, event.to, event.over};
    }

    What read(const GravityEvent& event) { return ScriptedGravity{event.gravity}; }
    What read(const WindEvent& event) { return ScriptedWind{event.wind}; }

    const Scene& scene_;
    std::span<const TriangleMesh> meshes_;
    std::vector<std::set<int>> pinned_;
};

}  // namespace

std::vector<ScriptedEvent> script_events(const Scene& scene, std::span<const TriangleMesh> cloth_meshes) {
    Script script(scene, cloth_meshes);
    std::vector<ScriptedEvent> events;
    for (const EventSpec& event : scene.events) events.push_back(script.scripted(event));
    return events;
}

Vec3 gravity_at(const Scene& scene, double time) {
    Vec3 gravity = scene.step.gravity;
    for (const EventSpec& event : scene.events) {
        const auto* changed = std::get_if<GravityEvent>(&event.what);
        if (changed != nullptr && event.time <= time) gravity = changed->gravity;
    }
    return gravity;
}

}  // namespace percale::scenes
