#pragma once

#include <vector>

#include "percale/rest_shape.h"

namespace percale {

/// Mass of each vertex, kg: a quarter of each cell that contains a grid vertex, a third of each triangle on a free mesh. `rest`
/// is the rest shape in m, `area_density` in kg/m^2.
std::vector<double> lumped_masses(const TriangleMesh& mesh, double area_density, const RestShape& shape = {});

}  // namespace percale
