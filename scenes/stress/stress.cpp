#include "stress/stress.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "garment/vertex_selection.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

StressRow refused(const StressCell& cell, const std::string& why) {
    StressRow row{.cell = cell, .figures = {}, .verdict = StressVerdict::refused};
    row.figures.status = "refused";
    row.figures.said = why;
    return row;
}

StressRow judged_row(const StressCell& cell, StressFigures figures) {
    const StressVerdict verdict = verdict_of(figures);
    return {cell, std::move(figures), verdict};
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

StressFigures figures_of(const StressCell& cell, BuiltScene& built, int steps) {
    StressWatch watch = watch_of(cell, built.simulation, built.cloths, held_of(built));
    RunHooks hooks;
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { watch.look(report, simulation); };
    hooks.stop_asked = [&] { return watch.figures.steps >= steps; };
    run_scene(built, hooks);
    return std::move(watch.figures);
}

StressRow run_scene_cell(const SceneSource& source, const StressCell& cell, int steps, bool alone) {
    const std::vector<Override> overrides{{"step.scheme", scheme_words()[static_cast<std::size_t>(cell.scheme)], "--schemes"},
                                          {"step.time_step", number_text(cell.time_step), "--steps"}};
    Scene scene = source(overrides);
    scene.duration = scene.latest_end();  // every scheme makes as many steps
    scene.until_rest = false;
    scene.step.measure = StepMeasures::ledger;
    if (!alone && scene.step.threads == 0) scene.step.threads = 1;  // the jobs use the cores
    for (auto& [name, fabric] : scene.fabrics) scale(fabric, cell.stiffness);
    StressFigures figures;
    const std::string why = use_steps(std::move(scene), [&](BuiltScene& built) { figures = figures_of(cell, built, steps); });
    return why.empty() ? judged_row(cell, std::move(figures)) : refused(cell, why);
}

/// A change of gravity moves energy without work, so that no gain can be determined.
void refuse_gravity_events(const Scene& scene) {
    for (const EventSpec& event : scene.events)
        if (std::holds_alternative<GravityEvent>(event.what))
            fail_at(event.place, "stress cannot judge the energy of a scene whose gravity changes");
}

/// The run with a row a cell, made by `row_of`.
StressRun with_rows(StressRun run, std::span<const StressCell> cells, const VariantWork& work,
                    const std::function<StressRow(const StressCell&)>& row_of) {
    run.rows.resize(cells.size());
    if (!run_variants(cells.size(), work, [&](std::size_t k) { run.rows[k] = row_of(cells[k]); })) throw StudyStopped();
    return run;
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
        return judged_row(cell, std::move(watch.figures));
    } catch (const SceneError& error) {
        return refused(cell, error.what());
    }
}

StressRun stress_cells(std::span<const StressCell> cells, int steps, const VariantWork& work) {
    return with_rows({.title = "small cloths", .steps = steps, .rows = {}}, cells, work,
                     [&](const StressCell& cell) { return run_cell(cell, steps); });
}

std::vector<StressCell> scene_cells(const SceneStress& settings) {
    const std::vector<std::string> words = scheme_words();
    std::vector<StressCell> cells;
    for (const std::string& scheme : settings.schemes.empty() ? words : settings.schemes)
        for (const double time_step : settings.time_steps)
            for (const double factor : settings.factors)
                cells.push_back({.number = static_cast<int>(cells.size()),
                                 .sweep = "scene",
                                 .scheme = static_cast<Scheme>(std::ranges::find(words, scheme) - words.begin()),
                                 .time_step = time_step,
                                 .stiffness = factor});
    return cells;
}

StressRun stress_scene(const SceneSource& source, const SceneStress& settings, const VariantWork& work) {
    const Scene scene = source({});
    refuse_gravity_events(scene);
    return with_rows({.title = scene.title, .of_scene = true, .steps = settings.steps, .rows = {}}, scene_cells(settings), work,
                     [&](const StressCell& cell) { return run_scene_cell(source, cell, settings.steps, work.jobs == 1); });
}

}  // namespace percale::scenes
