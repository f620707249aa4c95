#include "doctor/doctor_vertices.h"

#include <algorithm>

#include "common/scene_file_error.h"
#include "garment/vertex_selection.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// A part of the scene that names vertices of a cloth.
struct Named {
    const VertexSelection* vertices = nullptr;
    std::string cloth;
};

Named named_by(const EventSpec& event) {
    if (const auto* pin = std::get_if<PinEvent>(&event.what)) return {&pin->vertices, pin->cloth};
    if (const auto* unpin = std::get_if<UnpinEvent>(&event.what)) return {&unpin->vertices, unpin->cloth};
    if (const auto* move = std::get_if<MoveEvent>(&event.what)) return {&move->vertices, move->cloth};
    return {};
}

}  // namespace

std::vector<Finding> missing_vertices(const Scene& scene, std::span<const ClothMesh> cloths) {
    std::vector<Finding> found;
    const auto look_at = [&](const Named& named, const SourcePlace& place, const std::string& what) {
        const auto cloth = std::ranges::find_if(cloths, [&](const ClothMesh& c) { return c.spec->name == named.cloth; });
        if (cloth == cloths.end() || !named.vertices) return;
        try {
            select_vertices(*named.vertices, *cloth->mesh, named.cloth);
        } catch (const SceneError& error) {
            found.push_back(finding("missing_vertices", place, what + error.what(),
                                    "name vertices that the cloth has: by number, in a box that holds some, or the boundary of "
                                    "one that has an edge",
                                    Severity::error));
        }
    };
    for (const ClothSpec& cloth : scene.cloths) look_at({&cloth.pin, cloth.name}, cloth.pin_place, "pin: ");
    for (const EventSpec& event : scene.events) look_at(named_by(event), event.place, "event: ");
    return found;
}

}  // namespace percale::scenes
