#include "format/expectations.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/text.h"

namespace percale::scenes {
namespace {

const MeasureDescription measure_list[] = {
    {"intersections", "",
     "Intersecting (not merely touching) triangle pairs of cloth and obstacles, and of cloth with self_contact (but not at "
     "one stitch, nor while seams close without contact), summed over all output frames."},
    {"deepest_penetration", "m",
     "Largest depth of a cloth vertex inside a watertight obstacle over all output frames; 0 if none."},
    {"smallest_distance", "m",
     "Smallest distance between cloth and obstacles, or in a contact between cloths, over all steps; infinite if none was near."},
    {"largest_strain", "", "Largest (l - l0)/l0 of a structural spring over all steps."},
    {"speed_at_end", "m/s", "Largest speed of a vertex in the last step."},
    {"rms_speed_at_end", "m/s", "Root of the mean squared speed of all vertices in the last step."},
    {"energy_gain", "J", "Largest rise of the total energy in one step beyond the work of pins and obstacles."},
    {"lowest_vertex", "m", "Height of the lowest cloth vertex at the end."},
    {"largest_seam_gap", "m", "Widest gap of a stitch at the end, of all seams; not measured without one."},
};

// Six digits, or all of them where six would contradict the verdict.
std::string value_text(const Expectation& expectation, double value) {
    if (std::isinf(value)) return value > 0.0 ? "infinite" : "minus infinite";
    const std::string text = short_number(value, 6);
    const bool same_verdict = within(expectation, std::strtod(text.c_str(), nullptr)) == within(expectation, value);
    return same_verdict ? text : number_text(value);
}

ExpectationResult judged(const Expectation& expectation, std::optional<double> measured) {
    ExpectationResult result{.expectation = expectation, .value = measured, .passed = false, .text = {}};
    result.passed = result.value && within(expectation, *result.value);
    const std::string file = expectation.file.empty() ? "" : " " + expectation.file;
    const std::string value = result.value ? value_text(expectation, *result.value) : "not measured";
    result.text = expectation.measure + file + when_text(expectation) + " " + value + ", expected " + limit_text(expectation) +
                  (result.passed ? ": passed" : ": failed");
    return result;
}

/// What a run has measured of an expectation.
std::optional<double> measured_of(const Expectation& expectation, std::size_t index,
                                  const std::map<std::string, double>& measures, std::span<const double> timed) {
    if (index < timed.size() && !std::isnan(timed[index])) return timed[index];
    if (expectation.at || expectation.during) return std::nullopt;
    const auto found = measures.find(expectation.measure);
    return found != measures.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace

std::span<const MeasureDescription> measure_descriptions() { return measure_list; }

std::vector<Expectation> with_every_step(std::vector<Expectation> expectations) {
    for (const char* measure : {"intersections_at_every_step", "deepest_penetration_at_every_step"}) {
        Expectation& none = expectations.emplace_back();
        none.measure = measure;
    }
    return expectations;
}

std::string limit_text(const Expectation& expectation) {
    const std::string lowest = number_text(expectation.lowest), highest = number_text(expectation.highest);
    if (expectation.lowest == expectation.highest) return "= " + lowest;
    if (std::isinf(expectation.lowest)) return (expectation.highest_included ? "<= " : "< ") + highest;
    if (std::isinf(expectation.highest)) return (expectation.lowest_included ? ">= " : "> ") + lowest;
    return lowest + " ... " + highest;
}

bool within(const Expectation& expectation, double value) {
    const bool high_enough = expectation.lowest_included ? value >= expectation.lowest : value > expectation.lowest;
    const bool low_enough = expectation.highest_included ? value <= expectation.highest : value < expectation.highest;
    return high_enough && low_enough;
}

bool read_step_measures(std::span<const Expectation> expectations) {
    return std::any_of(expectations.begin(), expectations.end(), [](const Expectation& expectation) {
        return expectation.measure == "largest_strain" || expectation.measure == "energy_gain";
    });
}

std::string when_text(const Expectation& expectation) {
    if (expectation.at) return " at " + number_text(*expectation.at) + " s";
    if (!expectation.during) return "";
    return " during " + number_text(expectation.during->front()) + " ... " + number_text(expectation.during->back()) + " s";
}

std::vector<ExpectationResult> judge(std::span<const Expectation> expectations, const std::map<std::string, double>& measures,
                                     std::span<const double> timed) {
    std::vector<ExpectationResult> results;
    for (std::size_t i = 0; i < expectations.size(); ++i)
        results.push_back(judged(expectations[i], measured_of(expectations[i], i, measures, timed)));
    return results;
}

}  // namespace percale::scenes
