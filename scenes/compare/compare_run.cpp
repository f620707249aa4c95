#include "compare/compare_run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/text.h"
#include "garment/vertex_selection.h"

namespace percale::scenes {

namespace {

/// Fraction by which a rate of steps may differ from a whole number and still be written as 1/number.
constexpr double whole_rate_rounding = 1e-9;

std::vector<Override> overrides_of(const Variant& variant) {
    std::vector<Override> overrides{{"step.scheme", variant.scheme, "--schemes"}};
    if (variant.time_step > 0.0) {
        overrides.push_back({"step.time_step", number_text(variant.time_step), "--steps"});
        return overrides;
    }
    overrides.push_back({"step.time_step", "auto", "--tolerances"});
    overrides.push_back({"step.tolerance", number_text(variant.tolerance), "--tolerances"});
    return overrides;
}

/// A number in -1 ... 1 from the bits of an index (splitmix64, Steele 2014).
double scatter(std::uint64_t index) {
    std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>(static_cast<std::int64_t>(z ^ (z >> 31))) / 9223372036854775808.0;
}

Vec3 direction_of(std::uint64_t vertex) {
    const Vec3 v(scatter(3 * vertex), scatter(3 * vertex + 1), scatter(3 * vertex + 2));
    return v.norm() > 0.0 ? Vec3(v / v.norm()) : Vec3(Vec3::UnitX());
}

void disturb(BuiltScene& built, double disturbance) {
    for (std::size_t c = 0; c < built.cloths.size(); ++c) {
        const std::span<const Vec3> now = built.simulation.positions(built.cloths[c]);
        std::vector<Vec3> moved(now.begin(), now.end());
        const ClothSpec& cloth = built.scene.cloths[c];
        const std::vector<int> pinned = select_vertices(cloth.pin, built.cloth_meshes[c], cloth.name);
        for (std::size_t i = 0; i < moved.size(); ++i)
            if (!std::binary_search(pinned.begin(), pinned.end(), static_cast<int>(i))) moved[i] += disturbance * direction_of(i);
        built.simulation.set_positions(built.cloths[c], moved);
    }
}

double largest_stretch(const TriangleMesh& rest, std::span<const Vec3> positions) {
    double largest = -1.0;
    for (const auto& triangle : rest.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = triangle[k], b = triangle[(k + 1) % 3];
            const double length = (rest.vertices[a] - rest.vertices[b]).norm();
            largest = std::max(largest, (positions[a] - positions[b]).norm() / length - 1.0);
        }
    }
    return largest;
}

EndState end_of(const BuiltScene& built) {
    EndState end{.energy = built.simulation.energy().total(), .lowest = std::numeric_limits<double>::infinity(), .stretch = -1.0};
    double mass = 0.0;
    for (std::size_t c = 0; c < built.cloths.size(); ++c) {
        const std::span<const Vec3> positions = built.simulation.positions(built.cloths[c]);
        const std::span<const double> masses = built.simulation.masses(built.cloths[c]);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            end.positions.push_back(positions[i]);
            end.mass_centre += masses[i] * positions[i];
            mass += masses[i];
            end.lowest = std::min(end.lowest, positions[i].y());
        }
        end.stretch = std::max(end.stretch, largest_stretch(built.cloth_meshes[c], positions));
    }
    end.mass_centre /= mass;
    return end;
}

VariantEnd end_of(RunStatus status, bool finite) {
    if (status == RunStatus::stopped) throw StudyStopped();
    if (status == RunStatus::finished) return VariantEnd::finished;
    return finite ? VariantEnd::failed : VariantEnd::blew_up;
}

/// Steps a built scene to its end.
VariantRun run_built(BuiltScene& built, const std::function<bool()>& stop_asked) {
    VariantRun run;
    bool finite = true;
    RunHooks hooks;
    hooks.stop_asked = stop_asked;
    hooks.step = [&](const StepReport& report, const Simulation&) {
        finite = report.status != StepStatus::not_finite;
        run.steps += report.ok() ? report.parts : 0;
        run.rejected += report.rejected + report.halvings;
    };
    RunResult result = run_scene(built, hooks);
    run.end = end_of(result.status, finite);
    run.reason = std::move(result.reason);
    run.totals = std::move(result.totals);
    if (run.end == VariantEnd::finished) run.state = end_of(built);
    return run;
}

}  // namespace

std::string length_text(const Variant& variant) {
    if (variant.time_step <= 0.0) return "tolerance " + number_text(variant.tolerance) + " m/s";
    const double rate = 1.0 / variant.time_step, whole = std::round(rate);
    if (whole >= 10.0 && std::abs(rate - whole) <= whole_rate_rounding * whole)
        return "1/" + std::to_string(static_cast<long>(whole)) + " s";
    return number_text(variant.time_step) + " s";
}

std::string variant_text(const Variant& variant) {
    return variant.scheme + (variant.time_step > 0.0 ? " at " : " with ") + length_text(variant);
}

const char* end_word(VariantEnd end) {
    return std::array{"finished", "blew up", "failed", "refused"}[static_cast<std::size_t>(end)];
}

VariantRun run_variant(const SceneSource& source, const Variant& variant, const std::function<bool()>& stop_asked,
                       double disturbance) {
    Scene scene = source(overrides_of(variant));
    scene.step.measure = StepMeasures::none;
    if (scene.step.threads == 0) scene.step.threads = 1;  // what is compared is CPU time
    VariantRun run;
    const std::string refused = use_steps(std::move(scene), [&](BuiltScene& built) {
        if (disturbance > 0.0) disturb(built, disturbance);
        run = run_built(built, stop_asked);
    });
    if (refused.empty()) return run;
    VariantRun none;
    none.end = VariantEnd::refused;
    none.reason = refused;
    return none;
}

Distances distances_between(const EndState& a, const EndState& b) {
    double sum = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        const double squared = (a.positions[i] - b.positions[i]).squaredNorm();
        sum += squared;
        largest = std::max(largest, squared);
    }
    return {.rms = std::sqrt(sum / static_cast<double>(a.positions.size())),
            .largest = std::sqrt(largest),
            .mass_centre = (a.mass_centre - b.mass_centre).norm(),
            .lowest = std::abs(a.lowest - b.lowest),
            .energy = std::abs(a.energy - b.energy),
            .stretch = std::abs(a.stretch - b.stretch)};
}

Distances scaled(Distances distances, double factor) {
    for (const auto distance : each_distance) distances.*distance *= factor;
    return distances;
}

Distances larger(Distances a, const Distances& b) {
    for (const auto distance : each_distance) a.*distance = std::max(a.*distance, b.*distance);
    return a;
}

}  // namespace percale::scenes
