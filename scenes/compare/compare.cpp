#include "compare/compare.h"

#include <algorithm>

#include "common/bounds.h"
#include "common/scene_file_error.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// Steps of each scheme, and tolerances of adaptive steps in m/s, where none are asked for.
constexpr int default_steps = 4;
constexpr double default_tolerances[] = {1e-2, 1e-3, 1e-4};

void add_default_steps(const SceneSource& source, const std::string& scheme, const CompareHooks& hooks,
                       std::vector<Variant>& variants) {
    const std::optional<Survivor> survivor = largest_surviving_step(source, scheme, hooks.stop_asked);
    double step = survivor ? survivor->step : largest_compared_step;
    for (int k = 0; k < (survivor ? default_steps : 1); ++k, step *= 0.5) variants.push_back({scheme, step, 0.0});
    if (scheme != "tr_bdf2") return;
    for (const double tolerance : default_tolerances) variants.push_back({scheme, 0.0, tolerance});
}

/// Whether a scheme takes the scene at all.
bool is_refused(const SceneSource& source, const std::string& scheme) {
    return !use_steps(source(std::vector<Override>{{"step.scheme", scheme}}), [](BuiltScene&) {}).empty();
}

std::vector<std::string> wanted_schemes(const SceneSource& source, const CompareSettings& settings) {
    if (!settings.schemes.empty()) return settings.schemes;
    std::vector<std::string> schemes = scheme_words();
    std::erase_if(schemes, [&](const std::string& scheme) { return is_refused(source, scheme); });
    return schemes;
}

std::vector<Variant> all_variants(const SceneSource& source, const CompareSettings& settings, const CompareHooks& hooks) {
    std::vector<Variant> variants;
    for (const std::string& scheme : wanted_schemes(source, settings)) {
        if (settings.steps.empty() && settings.tolerances.empty()) {
            is_refused(source, scheme) ? variants.push_back({scheme, largest_compared_step, 0.0})
                                       : add_default_steps(source, scheme, hooks, variants);
        }
        for (const double step : settings.steps) variants.push_back({scheme, step, 0.0});
        for (const double tolerance : settings.tolerances) variants.push_back({scheme, 0.0, tolerance});
    }
    return variants;
}

ComparedRun judged(const Variant& variant, VariantRun run, const Comparison& comparison) {
    const Reference& reference = comparison.reference;
    ComparedRun compared{variant, std::move(run), {}};
    if (compared.run.end != VariantEnd::finished) return compared;
    compared.error = distances_between(compared.run.state, reference.state);
    if (compared.error.rms <= comparison.extent) return compared;
    compared.run.end = VariantEnd::blew_up;
    compared.run.reason = "ended farther from the reference than the cloth is large";
    return compared;
}

}  // namespace

double Comparison::rank_of(const Distances& distances) const {
    if (!reference.chaotic) return distances.rms;
    return std::max({distances.mass_centre, distances.lowest, distances.stretch * extent});
}

void demand_duration(const Scene& scene) {
    if (!scene.until_rest) return;
    fail_at(
        scene.duration_place,
        "duration = \"rest\": runs are compared at one time, and each would end at its own; say one, such as --set duration=2");
}

Comparison compare_scene(const SceneSource& source, const CompareSettings& settings, const CompareHooks& hooks) {
    const Scene scene = source({});
    demand_duration(scene);
    Comparison comparison{.title = scene.title,
                          .duration = scene.duration,
                          .reference = make_reference(source, settings.reference_error, hooks.stop_asked),
                          .runs = {}};
    comparison.extent = Bounds(comparison.reference.state.positions).extent().norm();
    if (hooks.reference_made) hooks.reference_made(comparison.reference);
    const std::vector<Variant> variants = all_variants(source, settings, hooks);
    comparison.runs.resize(variants.size());
    const auto run = [&](std::size_t k) {
        ComparedRun& compared = comparison.runs[k % variants.size()];
        if (k >= variants.size() && compared.run.end != VariantEnd::finished) return;
        VariantRun made = run_variant(source, variants[k % variants.size()], hooks.stop_asked);
        if (k < variants.size())
            compared = judged(variants[k], std::move(made), comparison);
        else
            compared.run.totals.cpu_s = std::min(compared.run.totals.cpu_s, made.totals.cpu_s);
    };
    // One at a time: their CPU times are compared.
    const std::size_t count = variants.size() * static_cast<std::size_t>(settings.repeats);
    if (!run_variants(count, {.stop_asked = hooks.stop_asked}, run)) throw StudyStopped();
    return comparison;
}

}  // namespace percale::scenes
