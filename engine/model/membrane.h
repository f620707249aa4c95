#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "mesh/rest_edges.h"
#include "percale/fabric.h"
#include "percale/mesh.h"
#include "spring_network.h"

namespace percale {

/// The plane stress law of a fabric, in N/m: stresses (xx, yy, xy) = C (E_xx, E_yy, 2 E_xy), x along warp.
/// With E_1, E_2 = stretch_stiffness and nu = poisson_ratio: C11 = E_1/(1 - nu^2), C22 = E_2/(1 - nu^2),
/// C12 = nu sqrt(E_1 E_2)/(1 - nu^2), C33 = shear_stiffness, or sqrt(E_1 E_2)/(2 (1 + nu)) where that is not set.
/// The fabric has moduli.
Eigen::Matrix3d stress_law(const Fabric& fabric);

/// Whether a fabric with moduli is isotropic, to one part in a thousand.
bool is_isotropic(const Fabric& fabric);

/// A triangle as three springs on squared lengths, s_e = l_e^2 - L_e^2, edge e opposite vertex e: energy 1/2 s.K s. Green's
/// strain is linear in s, so this is the St. Venant-Kirchhoff membrane itself (Delingette, IEEE Transactions on Visualization and
/// Computer Graphics 14, 2008, for isotropic ones).
struct MembraneTriangle {
    Triangle vertex;
    Eigen::Matrix3d stiffness;          // K, N/m^3
    std::array<double, 3> rest_square;  // L_e^2, m^2
};

/// K of a triangle with these corners in its plane, in m, x along warp.
Eigen::Matrix3d triangle_stiffness(const std::array<Eigen::Vector2d, 3>& corner, const Eigen::Matrix3d& law);

/// Appends the edges of a cloth of given moduli as springs, whose vertices start at `first_vertex`, and for triangle springs the
/// triangles. Edges of triangle springs have stiffness 0 there, only damping; edges of van Gelder springs have E
/// sum(areas)/length^2 (van Gelder, Journal of Graphics Tools 3, 1998). Warp is along the rows of a grid; on a free mesh its
/// rest shape gives it, or the fabric must be isotropic; otherwise throws SceneError naming `name`. Kinds: structural, but shear
/// for diagonals of a grid. damping_time refers to the stiffness of an edge alone, 4 L^2 sum(K_ee).
void append_membrane(SpringNetwork& network, std::vector<MembraneTriangle>& triangles, const ShapedMesh& rest,
                     const Fabric& fabric, int first_vertex, const std::string& name);

}  // namespace percale
