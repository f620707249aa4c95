#pragma once

#include <span>
#include <string>
#include <vector>

#include "../tolerances.h"
#include "stress/stress_watch.h"
#include "study/run_variants.h"
#include "study/scene_variant.h"

// Cloth stepped in ways that break schemes: where each is stable, and whether what is not says so.
namespace percale::scenes {

struct StressRow {
    StressCell cell;  // of a scene: scheme, time step, and its stiffness as a factor
    StressFigures figures;
    StressVerdict verdict = StressVerdict::stable;
};

struct StressRun {
    std::string title;
    bool of_scene = false;  // stiffness is a factor on that of the scene
    int steps = 0;          // of each cell, at most; cells of the matrix: run_cell
    std::vector<StressRow> rows;

    /// The number of rows with a verdict that their scheme must not have.
    int failures() const;
};

/// The default matrix: a base sweep of time step, stiffness and scheme, and sweeps of masses, damping, meshes, starts and contact
/// around some of its points. Always the same cells in the same order.
std::vector<StressCell> stress_matrix();

/// Runs one cell for so many steps, of an explicit scheme `explicit_factor` times as many.
StressRow run_cell(const StressCell& cell, int steps);

/// Runs cells; the rows are the same whatever the number of jobs. Throws StudyStopped after a stop.
StressRun stress_cells(std::span<const StressCell> cells, int steps, const VariantWork& work);

/// Which steps, stiffness factors and schemes a scene is run with.
struct SceneStress {
    std::vector<std::string> schemes = {};                           // empty: all
    std::vector<double> time_steps = {1e-4, 1e-3, 1e-2, 1e-1, 1.0};  // s
    std::vector<double> factors = {1e-2, 1.0, 1e2, 1e4};             // on all constants of springs and moduli
    int steps = usual_steps;                                         // of each run, at most
};

/// Every scheme with every step and factor.
std::vector<StressCell> scene_cells(const SceneStress& settings);

/// The same with a scene: each run ends with the scene's duration or after so many steps. Throws SceneError where the scene is
/// wrong, StudyStopped after a stop.
StressRun stress_scene(const SceneSource& source, const SceneStress& settings, const VariantWork& work);

}  // namespace percale::scenes
