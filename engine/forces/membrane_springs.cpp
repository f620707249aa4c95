#include "membrane_springs.h"

namespace percale {

double evaluate_membrane(const Compute& compute, const Adjacency& adjacency, const SpringMotion& motion, bool with_matrix,
                         Vectors& forces, SpringTerms& terms) {
    const MembraneEntries& membrane = adjacency.membrane;
    const MembranePass pass{.pattern = adjacency.pattern(),
                            .edges = membrane.edges(),
                            .positions = motion.positions.axes(),
                            .points = terms.points.data(),
                            .dt = motion.dt,
                            .forces = forces.axes(),
                            .values = with_matrix ? terms.values.data() : nullptr};
    const double energy =
        sum_chunks(compute, adjacency.slices(), [&](Slices range) { return compute.kernels->membrane(pass, range); });
    if (!with_matrix) return energy;
    terms.corners.resize(corner_values * membrane.corner_count());
    const CornerFillPass fill{.corners = membrane.corners(),
                              .positions = motion.positions.axes(),
                              .points = terms.points.data(),
                              .dt = motion.dt,
                              .values = terms.corners.data()};
    for_chunks(compute, adjacency.slices(), [&](Slices range) { compute.kernels->fill_corners(fill, range); });
    return energy;
}

double membrane_energy(const std::vector<MembraneTriangle>& triangles, const Vectors& positions) {
    return 0.5 * sum_terms(0, static_cast<int>(triangles.size()), [&](int k) {
               const MembraneTriangle& t = triangles[k];
               Vec3 s;
               for (int e = 0; e < 3; ++e) {
                   const Vec3 edge = positions.at(t.vertex[(e + 1) % 3]) - positions.at(t.vertex[(e + 2) % 3]);
                   s[e] = edge.squaredNorm() - t.rest_square[e];
               }
               return s.dot(t.stiffness * s);
           });
}

}  // namespace percale
