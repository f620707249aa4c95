#pragma once

#include <string>
#include <vector>

#include "percale/simulation.h"

// Small cloths made to be hard to step: one for each cell of the stress matrix.
namespace percale::scenes {

enum class StressMesh { grid, sliver, random };
enum class StressStart { hang, thrown, crumpled, point };
enum class StressContact { none, penalty, projection };

const char* word_of(StressMesh mesh);
const char* word_of(StressStart start);
const char* word_of(StressContact contact);

/// What one cell of the matrix is made of. The cloth has 5 x 5 vertices 0.1 m apart and hangs from two corners.
struct StressCell {
    int number = 0;          // in the matrix
    std::string sweep = {};  // which part of the matrix it belongs to
    Scheme scheme = Scheme::backward_euler;
    double time_step = 1e-2;     // s
    double stiffness = 1e3;      // N/m of a structural spring; half of it in shear, a hundredth in bending
    double mass_ratio = 1.0;     // above 1: a second cloth, so many times as dense, is sewn to the lower edge
    double damping_ratio = 0.1;  // of the fastest mode
    StressMesh mesh = StressMesh::grid;
    double aspect = 1.0;  // longest edge over smallest height of the slivers
    /// hang: flat and at rest; thrown: every vertex 2 cm off and at 1 m/s, at random; crumpled: all vertices at random places in
    /// 4 cm; point: all free vertices at one point, springs without length.
    StressStart start = StressStart::thrown;
    StressContact contact = StressContact::none;  // a ball under the cloth, and how it pushes
};

struct HeldVertex {
    ClothId cloth;
    int vertex = 0;
    Vec3 place = Vec3::Zero();  // m
};

/// A cell's simulation before its first step.
struct StressCase {
    Simulation simulation;
    std::vector<ClothId> cloths;
    std::vector<HeldVertex> held;
};

/// Throws SceneError where the scheme takes no contact, or not in that form.
StressCase make_case(const StressCell& cell);

/// The square of the largest angular frequency of the cloth of a cell, 1/s^2, estimated.
double largest_square(const StressCell& cell);

}  // namespace percale::scenes
