#pragma once

#include <array>
#include <span>
#include <vector>

#include "percale/mesh.h"
#include "spring_network.h"

namespace percale {

/// Up to four vertices that resist bending. With u = sum w_k x_k a flat one stores 1/2 c |u|^2; the weights sum to 0.
/// Between two triangles: vertex[0] and vertex[1] are the ends of their common edge, the other two opposite to it, and
/// |u| = 2 sin(theta/2) with the angle theta between the triangles (0: flat) as long as these keep their shape.
/// On a line of a grid: vertex[0] is the middle one and vertex[1] is -1, |u| = 2 sin(theta/2) with the angle between the
/// segments. On a cell of a grid: its corners, |u| is the twist.
struct Hinge {
    std::array<int, 4> vertex;     // -1 = unused, of weight 0
    std::array<double, 4> weight;  // w, 1/m
    double stiffness;              // c, N m
    double rest_angle =
        0.0;            // rad, between triangles: stores 1/2 c (theta - rest_angle)^2; its sign follows the order of the vertices
    bool folds = true;  // not a cell's twist
    double clamp = 1.0;                                  // factor of c: 2 beside a clamp (set_clamps)
    std::array<int, 6> pair = {-1, -1, -1, -1, -1, -1};  // springs 01 02 03 12 13 23 of the network; -1 = none
};

/// All hinges of a simulation. A simulation without bending stiffness has none.
struct Hinges {
    std::vector<Hinge> all;
    std::vector<int> curved;  // which of them have a rest angle
};

/// The pairs of a hinge's vertices, in the order of Hinge::pair.
inline constexpr int hinge_pairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/// One cloth, in the numbers of the system.
struct HingeMesh {
    std::span<const Triangle> triangles;
    std::span<const Vec3> rest;  // m, of all vertices
    int first_spring;            // of the cloth, in the network
    int first_vertex;
    int columns, rows;  // of a grid; 0 of a free mesh
    /// m, corners of every triangle without strain; empty: as the vertices lie at rest.
    std::span<const std::array<Vec3, 3>> corners = {};
};

/// Appends the hinges of a cloth of bending stiffness B (N m), and to the network a pair without stiffness for two vertices that
/// no spring joins yet.
/// Grid of equal rectangular cells a x b: second differences along rows and columns, c = B b/a for the former (half of it on the
/// first and last row), and the twist of cells, c = 2 B: 1/2 B (kxx^2 + kyy^2 + 2 kxy^2) an area, an isotropic plate of Poisson
/// ratio 0. (Hinges between its triangles would be softer than the strips they are calibrated by: their folds join alternate
/// vertices only, and the others give way.)
/// Otherwise a hinge at every inner edge, c = B |e|^2/(A0 + A1): exact on equilateral triangles.
void append_hinges(const HingeMesh& mesh, double bend_stiffness, Hinges& hinges, SpringNetwork& network);

/// Bent over the half segment to a clamp, a fold of which one side is pinned and the other is not is twice as stiff: otherwise
/// the clamp would lie half a segment inside (first instead of second order). `free`: 1, or 0 at pinned vertices.
void set_clamps(std::span<const double> free, Hinges& hinges);

/// 1/2 c |u|^2 = 1/2 sum b_ij |x_i - x_j|^2 over pairs, b_ij = -c w_i w_j: sets network.bending, N/m.
void set_pair_bending(const Hinges& hinges, SpringNetwork& network);

}  // namespace percale
