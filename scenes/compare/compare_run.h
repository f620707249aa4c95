#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "study/run_variants.h"
#include "study/scene_variant.h"

// One run of a comparison: a scene stepped in a given way to its end, and how far two ends lie apart.
namespace percale::scenes {

/// How a scene is stepped.
struct Variant {
    std::string scheme = {};  // as in a scene file
    double time_step = 0.0;   // s; 0: chosen by the scheme for `tolerance`
    double tolerance = 0.0;   // m per second, where the time step is 0
};

/// "1/240 s", "0.003 s", "tolerance 0.001 m/s".
std::string length_text(const Variant& variant);
/// "rk4 at 1/3840 s", "tr_bdf2 with tolerance 0.001 m/s".
std::string variant_text(const Variant& variant);

enum class VariantEnd { finished, blew_up, failed, refused };
const char* end_word(VariantEnd end);

/// What is compared at the end.
struct EndState {
    std::vector<Vec3> positions = {};  // m, all cloths in turn
    Vec3 mass_centre = Vec3::Zero();   // m
    double energy = 0.0;               // J, total
    double lowest = 0.0;               // m, height of the lowest vertex
    double stretch = 0.0;              // largest (l - l0)/l0 of a mesh edge
};

struct VariantRun {
    VariantEnd end = VariantEnd::finished;
    std::string reason = {};  // why, if not finished
    EndState state = {};      // of a finished run
    RunTotals totals = {};
    int steps = 0;     // accepted; each of those that an adaptive step consists of counts
    int rejected = 0;  // tried and found too inexact, or redone as shorter ones
};

/// Steps a scene to its end without writing, measuring or judging anything. `disturbance`: every free vertex starts so far, m,
/// from where it should, in directions that depend on its number alone. A refusal by the scheme (an explicit one takes no
/// obstacles) is an end like any other. Throws SceneError where the scene itself is wrong, StudyStopped after a stop.
VariantRun run_variant(const SceneSource& source, const Variant& variant, const std::function<bool()>& stop_asked,
                       double disturbance = 0.0);

/// How far two ends lie apart.
struct Distances {
    double rms = std::numeric_limits<double>::quiet_NaN();          // m, root of the mean over vertices
    double largest = std::numeric_limits<double>::quiet_NaN();      // m, of a vertex
    double mass_centre = std::numeric_limits<double>::quiet_NaN();  // m
    double lowest = std::numeric_limits<double>::quiet_NaN();       // m
    double energy = std::numeric_limits<double>::quiet_NaN();       // J
    double stretch = std::numeric_limits<double>::quiet_NaN();      // of an edge's length
};

/// All of them, in the order of tables.
inline constexpr std::array<double Distances::*, 6> each_distance = {
    &Distances::rms, &Distances::largest, &Distances::mass_centre, &Distances::lowest, &Distances::stretch, &Distances::energy};

/// The two must have equally many vertices.
Distances distances_between(const EndState& a, const EndState& b);
Distances scaled(Distances distances, double factor);
/// The larger one of each of the distances.
Distances larger(Distances a, const Distances& b);

}  // namespace percale::scenes
