#include "cloth_model.h"

#include <algorithm>

#include "lumped_mass.h"
#include "percale/options.h"

namespace percale {
namespace {

/// The numbers of a cloth's vertices, put from the user's order into that in memory.
template <class T>
void put_in_order(const ClothRange& cloth, std::vector<T>& list) {
    const std::vector<T> before(list.begin() + cloth.first, list.end());
    for (int i = 0; i < cloth.count; ++i) list[cloth.first + i] = before[cloth.order.vertex[i]];
}

}  // namespace

void append_cloth(ClothModel& model, const TriangleMesh& rest, const Fabric& fabric, const std::string& name) {
    check_mesh(rest, name, true);
    check_options(fabric, name);
    const int first = model.vertex_count();
    if (fabric.has_moduli()) {
        append_membrane(model.springs, model.membrane, rest, fabric, first, name);
    } else {
        append_springs(model.springs, rest, fabric, first, name);
    }
    ClothRange range{.name = name, .first = first, .count = static_cast<int>(rest.vertices.size())};
    range.grid = rest.is_grid();
    range.fabric = fabric;
    for (const double mass : lumped_masses(rest, fabric.area_density)) {
        model.mass.push_back(mass);
        range.mass += mass;
    }
    model.rest.insert(model.rest.end(), rest.vertices.begin(), rest.vertices.end());
    model.thickness.resize(model.mass.size(), fabric.thickness);
    for (const auto& [a, b, c] : rest.triangles) model.triangles.push_back({first + a, first + b, first + c});
    model.cloths.push_back(range);
}

void order_last_cloth(ClothModel& model) {
    ClothRange& cloth = model.cloths.back();
    if (cloth.grid) return;
    const auto& firsts = model.springs.first;
    const auto own = std::partition_point(firsts.begin(), firsts.end(), [&](int vertex) { return vertex < cloth.first; });
    const int first_spring = static_cast<int>(own - firsts.begin());
    cloth.order = memory_order(std::span(model.rest).subspan(cloth.first),
                               springs_at_vertices(model.springs, first_spring, cloth.first, cloth.count));
    renumber_springs(model.springs, first_spring, cloth.first, cloth.order);
    put_in_order(cloth, model.mass);
    put_in_order(cloth, model.rest);
    const auto renumber = [&](Triangle& t) {
        if (t[0] < cloth.first) return;
        for (int& vertex : t) vertex = cloth.index_of(vertex - cloth.first);
    };
    for (Triangle& t : model.triangles) renumber(t);
    for (MembraneTriangle& t : model.membrane) renumber(t.vertex);
}

void finish_model(ClothModel& model) {
    const SpringLayout layout = model.membrane.empty() ? SpringLayout::best : SpringLayout::slices;
    model.adjacency = make_adjacency(model.springs, model.vertex_count(), layout);
    if (!model.membrane.empty()) add_membrane(model.adjacency, model.springs, model.membrane);
}

void update_points(ClothState& state) { copy_out(state.positions, state.points); }

}  // namespace percale
