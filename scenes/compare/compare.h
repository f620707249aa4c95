#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compare/compare_reference.h"

// Error against run time: a scene stepped in several ways beside a converged run of it.
namespace percale::scenes {

struct CompareSettings {
    std::vector<std::string> schemes = {};  // empty: all that take the scene
    std::vector<double> steps = {};         // s
    std::vector<double> tolerances = {};    // m/s, of adaptive steps. If both are empty: the largest of 1/60 s / 2^k that a
                                            // scheme survives and three halvings of it; for tr_bdf2 three tolerances, too
    int repeats = 3;                        // runs of each, of which the fastest counts
    double reference_error = 1e-9;          // m rms, to which the reference is refined
};

struct ComparedRun {
    Variant variant = {};
    VariantRun run = {};   // its CPU time is the smallest of the repeats
    Distances error = {};  // against the reference; NaN where the run did not finish
};

struct Comparison {
    std::string title = {};
    double duration = 0.0;  // s
    double extent = 0.0;    // m, diagonal of the box around the cloth at the reference's end
    Reference reference = {};
    std::vector<ComparedRun> runs = {};

    /// The error that runs are ranked by, m: rms over vertices; in chaotic scenes the largest of centre of mass, lowest vertex
    /// and stretch over the extent of the cloth.
    double rank_of(const Distances& distances) const;
};

struct CompareHooks {
    std::function<bool()> stop_asked;                      // asked after each step
    std::function<void(const Reference&)> reference_made;  // may be empty
};

/// Throws SceneError where no time is given at which all runs end: with duration = "rest".
void demand_duration(const Scene& scene);

/// Runs the reference, then every scheme at every step and tolerance, repeats in rounds. A run that failed, blew up or was
/// refused is a row that says so; one that ends farther from the reference than the cloth is large blew up, too. Throws
/// SceneError where the scene is wrong, StudyStopped after a stop.
Comparison compare_scene(const SceneSource& source, const CompareSettings& settings, const CompareHooks& hooks = {});

}  // namespace percale::scenes
