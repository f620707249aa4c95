#include "cloth_model.h"

#include <algorithm>
#include <cmath>

#include "mesh/lumped_mass.h"
#include "mesh/topology.h"
#include "percale/error.h"
#include "percale/options.h"

namespace percale {
namespace {

/// Reorders the numbers of a cloth's vertices from the user's order to that in memory.
template <class T>
void put_in_order(const ClothRange& cloth, std::vector<T>& list) {
    const std::vector<T> before(list.begin() + cloth.first, list.end());
    for (int i = 0; i < cloth.count; ++i) list[cloth.first + i] = before[cloth.order.vertex[i]];
}

std::vector<Body> make_bodies(const ClothModel& model) {
    std::vector<Body> bodies;
    for (const ClothRange& cloth : model.cloths) bodies.push_back({cloth.first, cloth.count, cloth.mass});
    for (int k = 0; k < model.springs.size(); ++k) {
        if (model.springs.kind[k] != SpringKind::seam) continue;
        const auto low = bodies.begin() + body_of(bodies, model.springs.first[k]);
        const auto high = bodies.begin() + body_of(bodies, model.springs.second[k]);
        for (auto next = low + 1; low != high && next <= high; ++next) {
            low->count += next->count;
            low->mass += next->mass;
        }
        if (low != high) bodies.erase(low + 1, high + 1);
    }
    return bodies;
}

/// Strain limit of each spring; 0: none.
std::vector<double> strain_limits_of(const ClothModel& model) {
    std::vector<double> strain;
    for (const int vertex : model.springs.first) {
        strain.push_back(model.cloths[cloth_of(model, vertex)].fabric.strain_limit.value_or(0.0));
    }
    return strain;
}

}  // namespace

void append_cloth(ClothModel& model, const TriangleMesh& mesh, const Fabric& fabric, const std::string& name,
                  const RestShape& shape) {
    check_mesh(mesh, name, true);
    check_rest_shape(mesh, shape, name);
    check_options(fabric, name);
    if (fabric.strain_limit && !fabric.has_moduli() && fabric.springs.structural == 0.0)
        throw SceneError(name, "strain_limit needs structural springs, springs.structural is 0 N/m");
    if (fabric.pressure || fabric.gas_volume) {
        check_encloses(mesh, name, fabric.pressure ? "pressure needs a closed mesh" : "gas_volume needs a closed mesh");
    }
    const int first = model.vertex_count(), first_spring = model.springs.size();
    if (fabric.has_moduli()) {
        append_membrane(model.springs, model.membrane, {mesh, shape}, fabric, first, name);
    } else {
        append_springs(model.springs, {mesh, shape}, fabric, first, name);
    }
    ClothRange range{.name = name, .first = first, .count = static_cast<int>(mesh.vertices.size())};
    range.grid = mesh.is_grid();
    range.columns = mesh.is_grid() ? mesh.grid_columns : 0;
    range.fabric = fabric;
    range.first_spring = first_spring;
    if (shape.said()) range.shape = std::make_shared<const RestShape>(shape);
    for (const double mass : lumped_masses(mesh, fabric.area_density, shape)) {
        model.mass.push_back(mass);
        model.length.push_back(std::sqrt(mass / fabric.area_density));
        range.mass += mass;
    }
    model.rest.insert(model.rest.end(), mesh.vertices.begin(), mesh.vertices.end());
    model.thickness.resize(model.mass.size(), fabric.thickness);
    model.modulus.resize(model.mass.size(), fabric.modulus());
    for (const auto& [a, b, c] : mesh.triangles) model.triangles.push_back({first + a, first + b, first + c});
    model.cloths.push_back(range);
}

void order_last_cloth(ClothModel& model) {
    ClothRange& cloth = model.cloths.back();
    if (cloth.grid) return;
    const int first_spring = cloth.first_spring;
    cloth.order = memory_order(std::span(model.rest).subspan(cloth.first),
                               springs_at_vertices(model.springs, first_spring, cloth.first, cloth.count));
    renumber_springs(model.springs, first_spring, cloth.first, cloth.order);
    put_in_order(cloth, model.mass);
    put_in_order(cloth, model.length);
    put_in_order(cloth, model.rest);
    const auto renumber = [&](Triangle& t) {
        if (t[0] < cloth.first) return;
        for (int& vertex : t) vertex = cloth.index_of(vertex - cloth.first);
    };
    for (Triangle& t : model.triangles) renumber(t);
    for (MembraneTriangle& t : model.membrane) renumber(t.vertex);
}

void append_hinges_of_last_cloth(ClothModel& model, double bend_stiffness, const RestShape& shape) {
    const ClothRange& cloth = model.cloths.back();
    const HingeMesh mesh{.triangles = triangles_of(model, cloth),
                         .rest = model.rest,
                         .first_spring = cloth.first_spring,
                         .first_vertex = cloth.first,
                         .columns = cloth.columns,
                         .rows = cloth.grid ? cloth.count / cloth.columns : 0,
                         .corners = shape.corners};
    append_hinges(mesh, bend_stiffness, model.hinges, model.springs);
}

void append_whole_cloth(ClothModel& model, const TriangleMesh& mesh, const Fabric& fabric, const std::string& name,
                        const RestShape& shape) {
    append_cloth(model, mesh, fabric, name, shape);
    order_last_cloth(model);
    if (fabric.bend_stiffness.value_or(0.0) > 0.0) append_hinges_of_last_cloth(model, *fabric.bend_stiffness, shape);
}

void set_bending(ClothModel& model) {
    set_pair_bending(model.hinges, model.springs);
    add_sewn_pairs(model.sewn_points, model.springs);
}

void finish_model(ClothModel& model) {
    std::vector<int> cloth_of_vertex;
    for (std::size_t c = 0; c < model.cloths.size(); ++c)
        cloth_of_vertex.insert(cloth_of_vertex.end(), model.cloths[c].count, static_cast<int>(c));
    leave_out_sewn_edges(cloth_of_vertex, model.springs, model.hinges);
    set_bending(model);
    const bool limited = std::ranges::any_of(model.cloths, [](const ClothRange& c) { return c.fabric.strain_limit.has_value(); });
    const SpringLayout layout = model.membrane.empty() && !limited ? SpringLayout::best : SpringLayout::slices;
    model.adjacency = make_adjacency(model.springs, model.vertex_count(), layout);
    if (!model.membrane.empty()) add_membrane(model.adjacency, model.springs, model.membrane);
    if (limited) set_strain_limits(model.springs, strain_limits_of(model), model.adjacency, model.limits);
    model.bodies = make_bodies(model);
}

void copy_holds(const ClothModel& model, Holds& holds) {
    holds.welds.clear();
    holds.limits.clear();
    for (const Weld& weld : model.welds) holds.welds.push_back(weld.hold);
    for (const LimitedEdge& edge : model.limits.edges) holds.limits.push_back(edge.hold);
}

void put_holds(const Holds& holds, ClothModel& model) {
    for (std::size_t k = 0; k < holds.welds.size(); ++k) model.welds[k].hold = holds.welds[k];
    for (std::size_t k = 0; k < holds.limits.size(); ++k) model.limits.set_hold(model.limits.edges[k], holds.limits[k]);
}

void set_model_clamps(std::span<const double> free, ClothModel& model) {
    set_clamps(free, model.hinges);
    set_bending(model);
    copy_bending(model.springs, model.adjacency);
}

int body_of(std::span<const Body> bodies, int vertex) {
    const auto ends_before = [&](const Body& body) { return body.first + body.count <= vertex; };
    return static_cast<int>(std::partition_point(bodies.begin(), bodies.end(), ends_before) - bodies.begin());
}

std::span<const Triangle> triangles_of(const ClothModel& model, const ClothRange& cloth) {
    const auto from = [&](int vertex) {
        return std::ranges::partition_point(model.triangles, [=](const Triangle& t) { return t[0] < vertex; });
    };
    return std::span<const Triangle>(from(cloth.first), from(cloth.first + cloth.count));
}

int cloth_of(const ClothModel& model, int vertex) {
    const auto next = std::ranges::upper_bound(model.cloths, vertex, {}, &ClothRange::first);
    return static_cast<int>(next - model.cloths.begin()) - 1;
}

double largest_aspect(const ClothModel& model, const ClothRange& cloth) {
    if (cloth.grid || !cloth.fabric.has_moduli()) return 0.0;
    double largest = 0.0;
    for (const Triangle& t : model.triangles) {
        if (t[0] < cloth.first || t[0] >= cloth.first + cloth.count) continue;
        const Vec3 a = model.rest[t[1]] - model.rest[t[0]], b = model.rest[t[2]] - model.rest[t[0]];
        const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
        largest = std::max(largest, longest / a.cross(b).norm());
    }
    return largest;
}

}  // namespace percale
