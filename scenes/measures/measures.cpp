#include "measures/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

/// Steps. A pinch that pauses no longer is one. 0: every step in which a surface springs back and forth begins another.
constexpr double pause_of_pinch = 6.0;

}  // namespace

void add_certificate(FrameCheck& check, const Certificate& certificate) {
    check.intersections += static_cast<int>(certificate.pairs.size());
    check.touching_pairs += certificate.touching_pairs;
    check.vertices_inside += certificate.vertices_inside;
    check.deepest_penetration = std::max(check.deepest_penetration, certificate.deepest_penetration);
    check.smallest_distance = std::min(check.smallest_distance, certificate.smallest_distance);
}

PairsOfCloths all_pairs(int cloths) {
    PairsOfCloths pairs;
    for (int first = 0; first < cloths; ++first) {
        for (int second = first; second < cloths; ++second) pairs.push_back({first, second});
    }
    return pairs;
}

void add_cloth_certificate(FrameCheck& check, const ClothCertificate& certificate) {
    check.intersections += static_cast<int>(certificate.crossing.size());
    check.touching_pairs += static_cast<int>(certificate.touching.size());
    check.at_seams += static_cast<int>(certificate.at_seams.size());
}

MeetingMesh joined_meeting_cloth(std::span<const TriangleMesh> cloths, std::span<const ClothStitches> seams,
                                 std::span<const std::array<int, 2>> meeting) {
    const int count = static_cast<int>(cloths.size());
    MeetingMesh all;
    std::vector<bool> meets(cloths.size(), false);
    for (const std::array<int, 2>& pair : all_pairs(count)) all.pairs.set(pair[0], pair[1], {.contact = false});
    for (const auto& [first, second] : meeting) {
        all.pairs.set(first, second, {});
        meets[first] = meets[second] = true;
    }
    std::vector<int> first_vertex(cloths.size(), -1);
    for (int cloth = 0; cloth < count; ++cloth) {
        if (!meets[cloth]) continue;
        const int first = first_vertex[cloth] = static_cast<int>(all.mesh.vertices.size());
        all.mesh.vertices.insert(all.mesh.vertices.end(), cloths[cloth].vertices.begin(), cloths[cloth].vertices.end());
        for (const auto& [a, b, c] : cloths[cloth].triangles) all.mesh.triangles.push_back({first + a, first + b, first + c});
        all.owner.resize(all.mesh.triangles.size(), cloth);
    }
    all.stitches = joined_stitches(seams, first_vertex);
    return all;
}

namespace {

bool worse(const FrameCheck& a, const FrameCheck& b) {
    if (a.smallest_distance != b.smallest_distance) return a.smallest_distance < b.smallest_distance;
    return a.intersections > b.intersections;
}

/// Adds to the sums and extremes that frames and steps share; whether this is the worst so far.
template <class Totals>
bool add_check(Totals& totals, const FrameCheck& check) {
    totals.intersections += check.intersections;
    totals.deepest_penetration = std::max(totals.deepest_penetration, check.deepest_penetration);
    totals.smallest_distance = std::min(totals.smallest_distance, check.smallest_distance);
    if (!worse(check, totals.worst)) return false;
    totals.worst = check;
    return true;
}

}  // namespace

void add_frame(Measures& measures, int index, const FrameCheck& check) {
    if (add_check(measures, check)) measures.worst_frame = index;
}

void add_state(StepChecks& checks, int step, double time, const FrameCheck& check) {
    ++checks.states;
    if (!add_check(checks, check)) return;
    checks.worst_step = step;
    checks.worst_time = time;
}

double energy_gain(const StepReport& report, double energy_before) {
    return report.energy.total() - energy_before - report.energy.work;
}

void add_step(Measures& measures, const StepReport& report, double energy_before) {
    measures.smallest_distance = std::min(measures.smallest_distance, report.smallest_distance);
    if (report.largest_strain > measures.largest_strain) {
        measures.largest_strain = report.largest_strain;
        measures.strain_time = report.time;
    }
    measures.energy_gain = std::max(measures.energy_gain, energy_gain(report, energy_before));
}

void find_strained_cloth(Measures& measures, const StepReport& report, const Simulation& simulation,
                         std::span<const ClothId> cloths) {
    if (measures.largest_strain == 0.0 || measures.strain_time != report.time) return;
    const auto strain = [&](const ClothId cloth) { return simulation.largest_strain(cloth); };
    measures.strained_cloth = static_cast<int>(std::ranges::max_element(cloths, {}, strain) - cloths.begin());
}

void add_end(Measures& measures, const Simulation& simulation, std::span<const ClothId> cloths) {
    double largest_squared = 0.0, sum_squared = 0.0;
    std::size_t count = 0;
    for (const ClothId cloth : cloths) {
        for (const Vec3& v : simulation.velocities(cloth)) {
            largest_squared = std::max(largest_squared, v.squaredNorm());
            sum_squared += v.squaredNorm();
            ++count;
        }
        for (const Vec3& x : simulation.positions(cloth)) measures.lowest_vertex = std::min(measures.lowest_vertex, x.y());
    }
    measures.speed_at_end = std::sqrt(largest_squared);
    measures.rms_speed_at_end = count > 0 ? std::sqrt(sum_squared / static_cast<double>(count)) : 0.0;
}

namespace {

std::vector<Vec3> of_all(const Simulation& simulation, std::span<const ClothId> cloths,
                         std::span<const Vec3> (Simulation::*view)(ClothId) const) {
    std::vector<Vec3> all;
    for (const ClothId cloth : cloths) {
        const std::span<const Vec3> values = (simulation.*view)(cloth);
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

/// The cloth of a vertex; vertices are counted through all cloths.
int number_of_cloth(const Simulation& simulation, std::span<const ClothId> cloths, std::size_t vertex) {
    std::size_t cloth = 0, end = simulation.positions(cloths[0]).size();
    while (vertex >= end) end += simulation.positions(cloths[++cloth]).size();
    return static_cast<int>(cloth);
}

}  // namespace

void RestWatch::begin(const Simulation& simulation, std::span<const ClothId> cloths) {
    positions_ = of_all(simulation, cloths, &Simulation::positions);
    velocities_ = of_all(simulation, cloths, &Simulation::velocities);
}

void RestWatch::look(const Simulation& simulation, std::span<const ClothId> cloths, const StepReport& report, const Vec3& gravity,
                     bool over) {
    const bool asleep = report.sleeping_cloths == static_cast<int>(cloths.size());
    figures_.time = report.time;
    figures_.at_rest = asleep && over;
    if (report.slept) return;
    const std::vector<Vec3> from = std::move(positions_), before = std::move(velocities_);
    begin(simulation, cloths);
    double fastest = -1.0, sum = 0.0, change = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        // Falling asleep and kinetic damping have set velocities to zero, so that they are taken from the displacement.
        const Vec3 velocity = asleep || report.stopped ? Vec3((positions_[i] - from[i]) / report.dt) : velocities_[i];
        change = std::max(change, (velocity - before[i]).squaredNorm());
        sum += velocity.squaredNorm();
        if (velocity.squaredNorm() <= fastest) continue;
        fastest = velocity.squaredNorm();
        figures_.fastest_cloth = number_of_cloth(simulation, cloths, i);
    }
    figures_.largest_speed = std::sqrt(std::max(0.0, fastest));
    figures_.rms_speed = from.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(from.size()));
    const double fall = report.dt * gravity.norm();
    figures_.force_over_weight = fall > 0.0 ? std::sqrt(change) / fall : std::numeric_limits<double>::quiet_NaN();
}

std::string not_at_rest_text(const RestFigures& figures, const std::string& cloth) {
    const std::string text = "not at rest (still for half a second, its forces balanced) after " + short_number(figures.time) +
                             " s, the longest that it may take: cloth '" + cloth + "' moves fastest, at " +
                             short_number(figures.largest_speed) + " m/s; all vertices " + short_number(figures.rms_speed) +
                             " m/s rms";
    if (std::isnan(figures.force_over_weight)) return text;
    return text + "; the largest net force on one is " + short_number(figures.force_over_weight) + " times its weight";
}

double largest_vertex_distance(const Simulation& simulation, std::span<const ClothId> cloths, std::span<const Vec3> reference) {
    double largest = 0.0;
    std::size_t next = 0;
    for (const ClothId cloth : cloths)
        for (const Vec3& x : simulation.positions(cloth)) largest = std::max(largest, (x - reference[next++]).norm());
    return largest;
}

void add_pinch(std::vector<Pinch>& pinches, const StepReport& report) {
    if (report.yielded == 0.0) return;
    if (report.pinched == 0) {  // the surface goes back
        const bool recent = !pinches.empty() && pinches.back().to > report.time - (1.0 + pause_of_pinch) * report.dt;
        if (recent) pinches.back().to = report.time;
        return;
    }
    const auto [low, high] = std::minmax(report.pinching[0], report.pinching[1]);
    const std::array pair{low, high};
    const double from = report.time - report.dt;
    const auto goes_on = [&](const Pinch& pinch) {
        return pinch.obstacles == pair && pinch.to > from - pause_of_pinch * report.dt;
    };
    const auto known = std::ranges::find_if(pinches, goes_on);
    Pinch& pinch = known != pinches.end() ? *known : pinches.emplace_back(Pinch{.obstacles = pair, .from = from});
    pinch.to = report.time;
    pinch.yielded = std::max(pinch.yielded, report.yielded);
}

Finding pinch_warning(const Pinch& pinch, const Scene& scene) {
    const ObstacleSpec &first = scene.obstacles.at(static_cast<std::size_t>(pinch.obstacles[0])),
                       &second = scene.obstacles.at(static_cast<std::size_t>(pinch.obstacles[1]));
    return finding("pinched", first.place,
                   "'" + first.name + "'" + (&first == &second ? "" : " and '" + second.name + "'") +
                       " pinched cloth; the compliant obstacle (on_pinch) gave way by up to " + short_number(pinch.yielded) +
                       " m, from " + short_number(pinch.from) + " s to " + short_number(pinch.to) + " s");
}

namespace {

/// Where and when what was measured over a whole run was largest, or nearest; "" where that is not known, as of depth, by which
/// the worst frame is not chosen.
std::string place_of(const std::string& measure, const Measures& measures, const Scene& scene) {
    if (measure == "largest_strain" && measures.strained_cloth >= 0)
        return " (cloth '" + scene.cloths[static_cast<std::size_t>(measures.strained_cloth)].name + "' at " +
               short_number(measures.strain_time) + " s)";
    const bool of_frames = measure == "intersections" || measure == "smallest_distance";
    return of_frames && measures.worst_frame >= 0 ? " (nearest in frame " + std::to_string(measures.worst_frame) + ")" : "";
}

}  // namespace

std::vector<ExpectationResult> judge_run(std::span<const Expectation> expectations, const Measures& measures,
                                         std::span<const double> timed, const Scene& scene) {
    std::vector<ExpectationResult> results = judge(expectations, measure_values(measures), timed);
    for (ExpectationResult& result : results) {
        if (!result.passed && !result.expectation.at && !result.expectation.during)
            result.text += place_of(result.expectation.measure, measures, scene);
    }
    return results;
}

std::map<std::string, double> measure_values(const Measures& measures) {
    std::map<std::string, double> values = {
        {"intersections", static_cast<double>(measures.intersections)},
        {"deepest_penetration", measures.deepest_penetration},
        {"smallest_distance", measures.smallest_distance},
        {"worst_frame", static_cast<double>(measures.worst_frame)},
        {"largest_strain", measures.largest_strain},
        {"speed_at_end", measures.speed_at_end},
        {"rms_speed_at_end", measures.rms_speed_at_end},
        {"energy_gain", measures.energy_gain},
        {"lowest_vertex", measures.lowest_vertex},
    };
    std::erase_if(values, [](const auto& value) { return std::isnan(value.second); });
    if (measures.steps) {
        values["intersections_at_every_step"] = measures.steps->intersections;
        values["deepest_penetration_at_every_step"] = measures.steps->deepest_penetration;
    }
    if (measures.matches) values["matches"] = *measures.matches;
    if (measures.largest_seam_gap) values["largest_seam_gap"] = *measures.largest_seam_gap;
    return values;
}

}  // namespace percale::scenes
