#include "spring_network.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "mesh/rest_edges.h"
#include "mesh/topology.h"
#include "percale/error.h"

namespace percale {
namespace {

/// Adds the springs of one cloth.
class SpringWriter {
public:
    SpringWriter(SpringNetwork& network, const TriangleMesh& rest, const Fabric& fabric, int first_vertex,
                 const std::string& name)
        : network_(network), rest_(rest), fabric_(fabric), first_vertex_(first_vertex), name_(name) {}

    void add(int a, int b, SpringKind kind) { add(a, b, (rest_.vertices[a] - rest_.vertices[b]).norm(), kind); }

    void add(int a, int b, double length, SpringKind kind) {
        const double stiffness = constant(kind);
        if (stiffness == 0.0) return;
        if (!(length > 0.0)) {
            throw SceneError(name_, "vertices " + std::to_string(a) + " and " + std::to_string(b) +
                                        " are joined by a spring but lie at the same place");
        }
        network_.first.push_back(first_vertex_ + a);
        network_.second.push_back(first_vertex_ + b);
        network_.rest_length.push_back(length);
        network_.stiffness.push_back(stiffness);
        network_.damping.push_back(fabric_.damping_time ? *fabric_.damping_time * stiffness : fabric_.spring_damping);
        network_.kind.push_back(kind);
    }

private:
    double constant(SpringKind kind) const {
        if (kind == SpringKind::structural) return fabric_.springs.structural;
        return kind == SpringKind::shear ? fabric_.springs.shear : fabric_.springs.bend;
    }

    SpringNetwork& network_;
    const TriangleMesh& rest_;
    const Fabric& fabric_;
    int first_vertex_;
    const std::string& name_;
};

/// Springs from every grid vertex to the one `columns_apart`, `rows_apart` away, where there is one.
void add_family(SpringWriter& writer, const TriangleMesh& grid, int columns_apart, int rows_apart, SpringKind kind) {
    const int first_column = columns_apart < 0 ? -columns_apart : 0;
    const int last_column = grid.grid_columns - (columns_apart > 0 ? columns_apart : 0);
    for (int r = 0; r + rows_apart < grid.grid_rows; ++r) {
        for (int c = first_column; c < last_column; ++c) {
            const int from = r * grid.grid_columns + c;
            writer.add(from, from + rows_apart * grid.grid_columns + columns_apart, kind);
        }
    }
}

void add_grid(SpringWriter& writer, const TriangleMesh& grid) {
    add_family(writer, grid, 1, 0, SpringKind::structural);
    add_family(writer, grid, 0, 1, SpringKind::structural);
    add_family(writer, grid, 1, 1, SpringKind::shear);
    add_family(writer, grid, -1, 1, SpringKind::shear);
    add_family(writer, grid, 2, 0, SpringKind::bend);
    add_family(writer, grid, 0, 2, SpringKind::bend);
}

void add_free(SpringWriter& writer, const TriangleMesh& mesh) {
    const std::vector<MeshEdge> edges = mesh_edges(mesh.triangles);
    for (const MeshEdge& edge : edges) writer.add(edge.vertex[0], edge.vertex[1], SpringKind::structural);
    for (const MeshEdge& edge : edges) {
        if (edge.opposite[1] >= 0) writer.add(edge.opposite[0], edge.opposite[1], SpringKind::bend);
    }
}

void add_shaped(SpringWriter& writer, const TriangleMesh& mesh, std::span<const std::array<Vec3, 3>> corners) {
    const std::vector<MeshEdge> edges = mesh_edges(mesh.triangles);
    const std::vector<RestEdge> rest = rest_edges(mesh.triangles, edges, corners);
    for (std::size_t k = 0; k < edges.size(); ++k) {
        writer.add(edges[k].vertex[0], edges[k].vertex[1], rest[k].length, SpringKind::structural);
    }
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const double apart = (rest[k].corner[3] - rest[k].corner[2]).norm();
        if (edges[k].opposite[1] >= 0) writer.add(edges[k].opposite[0], edges[k].opposite[1], apart, SpringKind::bend);
    }
}

/// list[from + k] = the previous element at number[k].
template <class T>
void rearrange(std::vector<T>& list, int from, const std::vector<int>& number) {
    const std::vector<T> before(list.begin() + from, list.end());
    for (std::size_t k = 0; k < number.size(); ++k) list[from + k] = before[number[k] - from];
}

}  // namespace

void append_springs(SpringNetwork& network, const ShapedMesh& rest, const Fabric& fabric, int first_vertex,
                    const std::string& name) {
    const auto& [mesh, shape] = rest;
    if (!mesh.is_grid() && fabric.springs.shear != 0.0) {
        throw SceneError(
            name, "springs.shear = " + std::to_string(fabric.springs.shear) +
                      " N/m, but a free mesh has no shear springs; its edges already resist shear, leave springs.shear out");
    }
    const int before = network.size();
    SpringWriter writer(network, mesh, fabric, first_vertex, name);
    if (!shape.corners.empty()) {
        add_shaped(writer, mesh, shape.corners);
    } else {
        mesh.is_grid() ? add_grid(writer, mesh) : add_free(writer, mesh);
    }
    if (network.size() == before) throw SceneError(name, "the fabric has no springs; springs.structural must be above 0 N/m");
}

void append_pair(int first, int second, SpringNetwork& network) {
    network.first.push_back(first);
    network.second.push_back(second);
    for (auto* constants : {&network.rest_length, &network.stiffness, &network.damping}) constants->push_back(0.0);
    network.kind.push_back(SpringKind::hinge);
}

std::vector<int> springs_at_vertices(const SpringNetwork& network, int from, int first_vertex, int vertex_count) {
    std::vector<int> springs(vertex_count, 0);
    for (int k = from; k < network.size(); ++k) {
        ++springs[network.first[k] - first_vertex];
        ++springs[network.second[k] - first_vertex];
    }
    return springs;
}

void renumber_springs(SpringNetwork& network, int from, int first_vertex, const VertexOrder& order) {
    for (int k = from; k < network.size(); ++k) {
        const int one = order.place_of(network.first[k] - first_vertex), other = order.place_of(network.second[k] - first_vertex);
        network.first[k] = first_vertex + std::min(one, other);
        network.second[k] = first_vertex + std::max(one, other);
    }
    std::vector<int> number(network.size() - from);
    std::iota(number.begin(), number.end(), from);
    const auto key = [&](int k) { return std::tuple(network.kind[k], network.first[k], network.second[k]); };
    std::sort(number.begin(), number.end(), [&](int a, int b) { return key(a) < key(b); });
    for (auto* ends : {&network.first, &network.second}) rearrange(*ends, from, number);
    for (auto* constants : {&network.rest_length, &network.stiffness, &network.damping}) rearrange(*constants, from, number);
    rearrange(network.kind, from, number);
}

}  // namespace percale
