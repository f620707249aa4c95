#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/scene.h"

namespace percale::scenes {

/// What may be expected of a run.
struct MeasureDescription {
    std::string name;
    std::string unit;  // "" if it has none
    std::string sentence;
};

/// All measures of [expect] except `matches`, which carries a file.
std::span<const MeasureDescription> measure_descriptions();

/// How one expectation came out.
struct ExpectationResult {
    Expectation expectation;
    std::optional<double> value;  // empty if it was not measured: then it has failed
    bool passed = false;
    std::string text;  // "largest_strain 0.12, expected < 0.3: passed"
};

/// What is expected of a run whose every step is certified, beside what its scene says: no intersecting pair and no vertex inside
/// an obstacle after any step.
std::vector<Expectation> with_every_step(std::vector<Expectation> expectations);

/// "< 0.3", "= 0", "0.2 ... 0.45"; for matches "<= 0.002".
std::string limit_text(const Expectation& expectation);

/// Whether a value lies within the limits; NaN never does.
bool within(const Expectation& expectation, double value);

/// Whether one of them reads what steps report besides contacts (StepSettings::measure).
bool read_step_measures(std::span<const Expectation> expectations);

/// " at 1.5 s", " during 1 ... 2 s", "" for the whole run.
std::string when_text(const Expectation& expectation);

/// Judges every expectation by its value in `timed`, which has the order of the expectations; NaN or a missing entry is no value.
/// Without one, an expectation that has no time of its own is judged by the run's measure of its name.
std::vector<ExpectationResult> judge(std::span<const Expectation> expectations, const std::map<std::string, double>& measures,
                                     std::span<const double> timed = {});

}  // namespace percale::scenes
