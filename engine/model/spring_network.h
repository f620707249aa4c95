#pragma once

#include <cstdint>
#include <vector>

#include "mesh/rest_edges.h"
#include "mesh/vertex_order.h"
#include "percale/fabric.h"
#include "percale/mesh.h"

namespace percale {

/// hinge: two vertices of a hinge that no spring joins, without stiffness, with `bending` alone. seam: sewn together, without a
/// length of its own; where a vertex is sewn to a point between two others, the pair has `bending` alone, and so has `point`,
/// the pair with the second of the two.
enum class SpringKind : std::uint8_t { structural, shear, bend, hinge, seam, point };

/// All springs of a simulation, a structure of arrays.
struct SpringNetwork {
    std::vector<int> first, second;   // vertices
    std::vector<double> rest_length;  // m
    std::vector<double> stiffness;    // ks, N/m
    std::vector<double> damping;      // kd, N s/m
    std::vector<SpringKind> kind;
    std::vector<double> bending;  // b, N/m, of either sign: force -b x on top of the spring's; empty without hinges

    int size() const { return static_cast<int>(first.size()); }
};

/// Appends the springs of one cloth whose vertices start at `first_vertex`.
/// Grid: structural along rows and columns, shear on both diagonals of every cell, bend two apart along rows and columns. Free
/// mesh: structural on every edge, bend between the two vertices opposite an inner edge, as long as without strain.
/// A kind whose constant is 0 has no springs, and so no damping either. Throws SceneError naming `name` for shear on a
/// free mesh, no spring at all, or a spring of no length.
void append_springs(SpringNetwork& network, const ShapedMesh& rest, const Fabric& fabric, int first_vertex,
                    const std::string& name);

/// Appends a pair of vertices without spring.
void append_pair(int first, int second, SpringNetwork& network);

/// For the springs from number `from` on: their number at each of the cloth's vertices, which start at `first_vertex`.
std::vector<int> springs_at_vertices(const SpringNetwork& network, int from, int first_vertex, int vertex_count);

/// Gives the ends of the springs from number `from` on, those of one cloth whose vertices start at `first_vertex`, the numbers of
/// an order, and sorts these springs by kind and ends.
void renumber_springs(SpringNetwork& network, int from, int first_vertex, const VertexOrder& order);

}  // namespace percale
