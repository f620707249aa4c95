#pragma once

#include <string>

#include "percale/simulation.h"

namespace percale::test {

/// A sheet of 1 m with n x n vertices, `height` m above the origin, that falls on `body`; without a body it hangs from two
/// corners. `deforming`: the body's vertices may move one by one.
Simulation make_sheet_scene(int n, const TriangleMesh* body, double height, const StepSettings& settings = {},
                            bool deforming = false);

/// Time of all kinds of work together, s.
double total(const StageTimes& stages);

/// Whether a sheet crosses a body or is inside of it.
bool is_crossed(const TriangleMesh& sheet, const TriangleMesh& body);

/// A body scan by its file's name, centred, its longest side half a metre; no triangles where it is absent.
TriangleMesh body_scan(const std::string& file_name);

/// The bunny scan half a metre high, centred; no triangles where it is absent.
TriangleMesh bunny_scan();

}  // namespace percale::test
