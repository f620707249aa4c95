#include "stress/stress.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "compare/compare.h"
#include "garment/vertex_selection.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

StressRow refused(const StressCell& cell, const SceneError& error) {
    StressRow row{.cell = cell, .figures = {}, .verdict = StressVerdict::refused};
    row.figures.status = "refused";
    row.figures.said = error.what();
    return row;
}

/// The watch by which the simulation is to be judged.
StressWatch watch_of(const StressCell& cell, const Simulation& simulation, std::span<const ClothId> cloths,
                     std::span<const HeldVertex> held) {
    StressWatch watch(simulation, cloths, held);
    watch.figures.bound = gain_bound(cell.scheme, cell.time_step, simulation.plan().stable_step);
    return watch;
}

void scale(Fabric& fabric, double factor) {
    for (double* constant : {&fabric.springs.structural, &fabric.springs.shear, &fabric.springs.bend}) *constant *= factor;
    if (fabric.stretch_stiffness)
        for (double& modulus : *fabric.stretch_stiffness) modulus *= factor;
    for (auto* modulus : {&fabric.shear_stiffness, &fabric.bend_stiffness})
        if (*modulus) **modulus *= factor;
}

/// The cloth that an event pins, moves or lets go; empty: none.
std::string scripted_cloth(const EventSpec& event) {
    return std::visit(
        [](const auto& what) -> std::string {
            if constexpr (requires { what.cloth; }) return what.cloth;
            return {};
        },
        event.what);
}

/// Pinned vertices of cloths that no event changes.
std::vector<HeldVertex> held_of(const BuiltScene& built) {
    std::vector<HeldVertex> held;
    for (std::size_t c = 0; c < built.cloths.size(); ++c) {
        const ClothSpec& cloth = built.scene.cloths[c];
        const bool scripted = std::any_of(built.scene.events.begin(), built.scene.events.end(),
                                          [&](const EventSpec& event) { return scripted_cloth(event) == cloth.name; });
        if (scripted) continue;
        for (const int vertex : select_vertices(cloth.pin, built.cloth_meshes[c], cloth.name))
            held.push_back({built.cloths[c], vertex, built.simulation.positions(built.cloths[c])[vertex]});
    }
    return held;
}

StressRow run_built(const StressCell& cell, BuiltScene& built, int steps) {
    StressRow row{.cell = cell, .figures = {}};
    StressWatch watch = watch_of(cell, built.simulation, built.cloths, held_of(built));
    RunHooks hooks;
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { watch.look(report, simulation); };
    hooks.stop_asked = [&] { return watch.figures.steps >= steps; };
    run_scene(built, hooks);
    row.figures = std::move(watch.figures);
    row.verdict = verdict_of(row.figures);
    return row;
}

StressRow run_scene_cell(const SceneSource& source, const StressCell& cell, const std::string& word, int steps) {
    const std::vector<Override> overrides{{"step.scheme", word, "--schemes"},
                                          {"step.time_step", number_text(cell.time_step), "--steps"}};
    Scene scene = source(overrides);
    leave_only_steps(scene);
    scene.duration = scene.latest_end();  // every scheme makes as many steps
    scene.until_rest = false;
    scene.step.measure = StepMeasures::ledger;
    for (auto& [name, fabric] : scene.fabrics) scale(fabric, cell.stiffness);
    try {
        BuiltScene built = build_scene(scene);
        return run_built(cell, built, steps);
    } catch (const SceneError& error) {
        return refused(cell, error);
    }
}

/// A change of gravity moves energy without work, so that no gain can be determined.
void refuse_gravity_events(const Scene& scene) {
    for (const EventSpec& event : scene.events)
        if (std::holds_alternative<GravityEvent>(event.what))
            fail_at(event.place, "stress cannot judge the energy of a scene whose gravity changes");
}

Scheme scheme_named(const std::string& word) {
    const std::vector<std::string> words = scheme_words();
    return static_cast<Scheme>(std::find(words.begin(), words.end(), word) - words.begin());
}

void report_progress(const StressHooks& hooks, std::size_t made, std::size_t all) {
    if (hooks.progress) hooks.progress(static_cast<int>(made), static_cast<int>(all));
    if (made < all && hooks.stop_asked && hooks.stop_asked()) throw ComparisonStopped();
}

}  // namespace

int StressRun::failures() const {
    return static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [](const StressRow& row) { return is_failure(row.cell.scheme, row.verdict); }));
}

StressRow run_cell(const StressCell& cell, int steps) {
    try {
        StressCase made = make_case(cell);
        StressWatch watch = watch_of(cell, made.simulation, made.cloths, made.held);
        const int max = std::isinf(made.simulation.plan().stable_step) ? steps : explicit_factor * steps;
        for (int n = 0; n < max && watch.figures.status == "ok"; ++n) watch.look(made.simulation.step(), made.simulation);
        StressRow row{.cell = cell, .figures = std::move(watch.figures)};
        row.verdict = verdict_of(row.figures);
        return row;
    } catch (const SceneError& error) {
        return refused(cell, error);
    }
}

StressRun stress_cells(std::span<const StressCell> cells, int steps, const StressHooks& hooks) {
    StressRun run{.title = "small cloths", .steps = steps, .rows = {}};
    for (const StressCell& cell : cells) {
        run.rows.push_back(run_cell(cell, steps));
        report_progress(hooks, run.rows.size(), cells.size());
    }
    return run;
}

StressRun stress_scene(const SceneSource& source, const SceneStress& settings, const StressHooks& hooks) {
    const Scene scene = source({});
    refuse_gravity_events(scene);
    StressRun run{.title = scene.title, .of_scene = true, .steps = settings.steps, .rows = {}};
    const std::vector<std::string> schemes = settings.schemes.empty() ? scheme_words() : settings.schemes;
    const std::size_t all = schemes.size() * settings.time_steps.size() * settings.factors.size();
    for (const std::string& scheme : schemes) {
        for (const double time_step : settings.time_steps) {
            for (const double factor : settings.factors) {
                const StressCell cell{.number = static_cast<int>(run.rows.size()),
                                      .sweep = "scene",
                                      .scheme = scheme_named(scheme),
                                      .time_step = time_step,
                                      .stiffness = factor};
                run.rows.push_back(run_scene_cell(source, cell, scheme, settings.steps));
                report_progress(hooks, run.rows.size(), all);
            }
        }
    }
    return run;
}

}  // namespace percale::scenes
