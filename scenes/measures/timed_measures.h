#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "measures/measures.h"

namespace percale::scenes {

/// A state of a run, as expectations look at it.
struct StateFigures {
    const Simulation& simulation;
    std::span<const ClothId> cloths;
    const StepReport* step = nullptr;                               // that ended with it; null: the start
    double energy_gain = std::numeric_limits<double>::quiet_NaN();  // J, of that step
    std::function<const FrameCheck&()> check;                       // its certificate, made when it is asked for
    std::function<std::optional<double>()> seam_gap;                // m, Measures::largest_seam_gap
    bool framed = false;                                            // an output frame shows it
};

/// What expectations with a time of their own measure. `at`: everything is measured in the first state at that time or after it.
/// `during`: it is measured over the states, or frames, in between, as over a whole run; what a run has at its end only (speeds,
/// heights, distances from a mesh) must hold in each state, and the value is that of the state farthest from what is expected.
class TimedMeasures {
public:
    /// `expectations`: all of a scene, also those without times, which are passed over. `slack`: s, how far a state may be before
    /// its time by rounding.
    TimedMeasures(std::span<const Expectation> expectations, std::vector<std::vector<Vec3>> references, double slack);

    /// States come in the order of their times.
    void look(const StateFigures& state);

    /// The value of each expectation so far, NaN: none yet; for a checkpoint, too. `last`: s, of the last state.
    const std::vector<double>& values() const { return values_; }
    void go_on_from(std::vector<double> values, double last);
    /// Vertices of all cloths where an expectation with `at` compares them with a mesh; empty elsewhere.
    const std::vector<std::vector<Vec3>>& shapes() const { return shapes_; }

private:
    double value_of(std::size_t index, const StateFigures& state) const;
    void look_at(std::size_t index, const StateFigures& state);
    void look_during(std::size_t index, const StateFigures& state);

    std::span<const Expectation> expectations_;
    std::vector<std::vector<Vec3>> references_, shapes_;
    std::vector<double> values_;
    double slack_, last_ = -std::numeric_limits<double>::infinity();
};

}  // namespace percale::scenes
