#include "garment/cloth_leftovers.h"

#include <algorithm>

#include "common/text.h"
#include "meshes/mesh_facts.h"

namespace percale::scenes {

namespace {

bool is_numbered(const VertexSelection& selection) {
    const auto* indices = std::get_if<VertexIndices>(&selection);
    return indices != nullptr && !indices->vertices.empty();
}

/// Whether an event names vertices of that cloth by number.
struct NumberedEvent {
    const std::string& cloth;
    template <class Event>
    bool operator()(const Event& event) const {
        if constexpr (requires { event.vertices; }) return event.cloth == cloth && is_numbered(event.vertices);
        return false;
    }
};

}  // namespace

std::string Leftovers::text() const {
    std::string text;
    if (!vertices.empty())
        text = std::to_string(vertices.size()) + (vertices.size() == 1 ? " vertex" : " vertices") + " of no triangle";
    if (triangles.empty()) return text;
    return text + (text.empty() ? "" : " and ") + counted(static_cast<long>(triangles.size()), "repeated triangle");
}

Leftovers leftovers_of(const TriangleMesh& mesh) {
    return {.vertices = unused_vertices(mesh), .triangles = repeated_triangles(mesh.triangles)};
}

void drop_leftovers(const Leftovers& leftovers, TriangleMesh& start, RestShape& rest) {
    std::vector<char> dropped(start.triangles.size(), 0);
    for (const int t : leftovers.triangles) dropped[static_cast<std::size_t>(t)] = 1;
    const auto drop = [&](auto& list) {
        std::size_t kept = 0;
        for (std::size_t t = 0; t < list.size(); ++t)
            if (dropped[t] == 0) list[kept++] = list[t];
        list.resize(kept);
    };
    if (!rest.corners.empty()) drop(rest.corners);
    drop(start.triangles);
    std::vector<int> numbers(start.vertices.size(), 0);
    for (const int v : leftovers.vertices) numbers[static_cast<std::size_t>(v)] = -1;
    int next = 0;
    for (std::size_t v = 0; v < numbers.size(); ++v) {
        if (numbers[v] < 0) continue;
        numbers[v] = next++;
        start.vertices[static_cast<std::size_t>(numbers[v])] = start.vertices[v];
    }
    start.vertices.resize(static_cast<std::size_t>(next));
    for (Triangle& triangle : start.triangles)
        for (int& corner : triangle) corner = numbers[static_cast<std::size_t>(corner)];
}

std::string numbered_use(const Scene& scene, const ClothSpec& cloth) {
    if (is_numbered(cloth.pin)) return "pin";
    for (const EventSpec& event : scene.events)
        if (std::visit(NumberedEvent{cloth.name}, event.what)) return "[[event]]";
    for (const SeamSpec& seam : scene.seams)
        if (!seam.cloths || std::ranges::find(*seam.cloths, cloth.name) != seam.cloths->end()) return "[[seam]]";
    return "";
}

}  // namespace percale::scenes
