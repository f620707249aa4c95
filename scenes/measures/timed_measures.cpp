#include "measures/timed_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace percale::scenes {

namespace {

/// How far a value lies outside its limits; < 0 where it lies within.
double excess(const Expectation& expectation, double value) {
    return std::max(expectation.lowest - value, value - expectation.highest);
}

/// Whether a run sums a measure up over its frames.
bool is_of_frames(const std::string& measure) { return measure == "intersections" || measure == "deepest_penetration"; }

/// Whether a run has a measure at its end only.
bool is_of_end(const std::string& measure) {
    static constexpr std::array names = {"speed_at_end", "rms_speed_at_end", "lowest_vertex", "largest_seam_gap", "matches"};
    return std::ranges::find(names, measure) != names.end();
}

}  // namespace

TimedMeasures::TimedMeasures(std::span<const Expectation> expectations, std::vector<std::vector<Vec3>> references, double slack)
    : expectations_(expectations),
      references_(std::move(references)),
      shapes_(expectations.size()),
      values_(expectations.size(), std::numeric_limits<double>::quiet_NaN()),
      slack_(slack) {
    references_.resize(expectations.size());
}

void TimedMeasures::go_on_from(std::vector<double> values, double last) {
    values_ = std::move(values);
    last_ = last;
}

void TimedMeasures::look(const StateFigures& state) {
    const double time = state.simulation.time();
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        const Expectation& expectation = expectations_[i];
        if (expectation.at && last_ < *expectation.at - slack_ && time >= *expectation.at - slack_) look_at(i, state);
        if (!expectation.during) continue;
        const auto [from, to] = *expectation.during;
        if (time >= from - slack_ && time <= to + slack_) look_during(i, state);
    }
    last_ = time;
}

void TimedMeasures::look_at(std::size_t index, const StateFigures& state) {
    if (expectations_[index].measure == "matches") {
        for (const ClothId cloth : state.cloths) {
            const std::span<const Vec3> positions = state.simulation.positions(cloth);
            shapes_[index].insert(shapes_[index].end(), positions.begin(), positions.end());
        }
    }
    values_[index] = value_of(index, state);
}

void TimedMeasures::look_during(std::size_t index, const StateFigures& state) {
    const Expectation& expectation = expectations_[index];
    if (is_of_frames(expectation.measure) && !state.framed) return;
    const double value = value_of(index, state);
    double& known = values_[index];
    if (std::isnan(known)) {
        known = value;
    } else if (expectation.measure == "intersections") {
        known += value;
    } else if (expectation.measure == "smallest_distance") {
        known = std::min(known, value);
    } else if (!is_of_end(expectation.measure)) {
        known = std::max(known, value);
    } else if (excess(expectation, value) > excess(expectation, known)) {
        known = value;
    }
}

double TimedMeasures::value_of(std::size_t index, const StateFigures& state) const {
    const std::string& measure = expectations_[index].measure;
    if (measure == "intersections") return state.check().intersections;
    if (measure == "deepest_penetration") return state.check().deepest_penetration;
    if (measure == "smallest_distance") {
        // Between frames a step's own figure stands for the certificate, which costs as much as a step.
        const bool certified = expectations_[index].at || state.framed;
        const double of_state = certified ? state.check().smallest_distance : std::numeric_limits<double>::infinity();
        return std::min(of_state, state.step != nullptr ? state.step->smallest_distance : of_state);
    }
    if (measure == "largest_seam_gap") return state.seam_gap().value_or(std::numeric_limits<double>::quiet_NaN());
    if (measure == "largest_strain") return state.simulation.largest_strain();
    if (measure == "energy_gain" && !std::isnan(state.energy_gain)) return std::max(0.0, state.energy_gain);
    if (measure == "energy_gain") return state.energy_gain;
    if (measure == "matches")
        return references_[index].empty() ? std::numeric_limits<double>::quiet_NaN()
                                          : largest_vertex_distance(state.simulation, state.cloths, references_[index]);
    Measures end;
    add_end(end, state.simulation, state.cloths);
    return measure_values(end).at(measure);
}

}  // namespace percale::scenes
