#pragma once

namespace percale {

constexpr int pack_lanes = 8;

/// Eight obstacle features in single precision, m, about a point near them; rows of lanes. Faces: corners a, b, c (9 rows).
/// Edges: ends a, b and the unit normals of the two triangles there, zero where they are not to be used (12 rows). Vertices: the
/// point, the axis of a cone that holds all directions in which it can be closest, and the cosine of its half angle (7 rows).
struct alignas(32) PackLanes {
    float at[12][pack_lanes];
};

/// A cloth feature seen from the same point.
struct PackQuery {
    float at[9];          // 1, 2 or 3 points, m
    float size;           // m, no coordinate of pack or query is larger; all roundings are fractions of it
    float sharpness;      // size over the smallest height of the triangles; of triangles alone
    float shortest_edge;  // m, of the pack; of edges alone
    float length;         // m, of the cloth edge; of edges alone
    float near;           // m
    float thickness;      // m
    unsigned char all;    // which lanes are used
};

/// Lower bounds: nothing in the pack is nearer.
struct PackAnswer {
    float distance_bound;     // m
    float travel_to_contact;  // m, how far a vertex must move before any feature of the pack can be a contact
    unsigned char near;       // lanes whose bound is below PackQuery::near
    unsigned char contact;    // those of them that can be a contact at these positions
};

/// One function for each kind of pair, and functions over long arrays. All instruction sets give the same bits.
struct PackKernels {
    using Function = void (*)(const PackLanes&, const PackQuery&, PackAnswer&);
    Function vertex_face, edge_edge, face_vertex;
    /// Largest |a - b| of `count` numbers.
    double (*largest_difference)(const double* a, const double* b, long count);
    /// Smallest of `count` numbers; infinity if there are none.
    float (*smallest)(const float* values, long count);
    /// Writes the places where values are <= limit to `found`, which has room for `count`, in ascending order; returns their
    /// number.
    long (*find_up_to)(const float* values, long count, float limit, int* found);
};

/// The table of a set, null where the processor lacks it.
const PackKernels* baseline_pack_kernels();
const PackKernels* avx2_pack_kernels();

}  // namespace percale
