#include "cloth_model.h"

#include "lumped_mass.h"
#include "percale/options.h"

namespace percale {

void append_cloth(ClothModel& model, const TriangleMesh& rest, const Fabric& fabric, const std::string& name) {
    check_mesh(rest, name, true);
    check_options(fabric, name);
    const int first = model.vertex_count();
    append_springs(model.springs, rest, fabric, first, name);
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

void finish_model(ClothModel& model) { model.adjacency = make_adjacency(model.springs, model.vertex_count()); }

void update_points(ClothState& state) { copy_out(state.positions, state.points); }

}  // namespace percale
