#include "stress/stress_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/text.h"
#include "percale/stability.h"
#include "report/csv.h"

namespace percale::scenes {

namespace {

constexpr std::array verdicts = {StressVerdict::stable, StressVerdict::refused, StressVerdict::not_finite, StressVerdict::gained,
                                 StressVerdict::silent};
constexpr std::array verdict_colours = {"#9ecae1", "#bdbdbd", "#fdae61", "#d7301f", "#000000"};

std::string scheme_word(Scheme scheme) { return scheme_words()[static_cast<std::size_t>(scheme)]; }

/// The schemes of a run in the order of their first rows.
std::vector<Scheme> schemes_of(const StressRun& run) {
    std::vector<Scheme> schemes;
    for (const StressRow& row : run.rows)
        if (std::find(schemes.begin(), schemes.end(), row.cell.scheme) == schemes.end()) schemes.push_back(row.cell.scheme);
    return schemes;
}

std::string cell_text(const StressCell& cell, bool of_scene) {
    std::string text = scheme_word(cell.scheme) + ", " + short_number(cell.time_step, 2) + " s, ";
    if (of_scene) return text + "stiffness x " + short_number(cell.stiffness, 2);
    text += short_number(cell.stiffness, 2) + " N/m, masses 1 : " + short_number(cell.mass_ratio, 2) + ", damping " +
            short_number(cell.damping_ratio, 2) + ", " + word_of(cell.mesh);
    if (cell.mesh == StressMesh::sliver) text += " " + short_number(cell.aspect, 2) + " : 1";
    text += std::string(", ") + word_of(cell.start);
    return cell.contact == StressContact::none ? text : text + ", contact by " + word_of(cell.contact);
}

std::string row_text(const StressRow& row, bool of_scene) {
    const StressFigures& figures = row.figures;
    std::string text = cell_text(row.cell, of_scene) + ": " + word_of(row.verdict);
    if (!figures.finite) text += ", not finite";
    if (!figures.pins_kept) text += ", a pin moved";
    text += ", gain " + short_number(figures.gain, 2) + " (bound " + short_number(figures.bound, 2) + ")";
    if (figures.step_excess > 0.0) text += ", of a step beyond its bound " + short_number(figures.step_excess, 2);
    return text + ", status " + figures.status + " after " + std::to_string(figures.steps) + " steps";
}

std::string stress_line(const StressRow& row, bool of_scene) {
    const auto& [cell, figures, verdict] = row;
    const auto of_matrix = [&](const std::string& text) { return of_scene ? "" : text; };  // what only its cells have
    return csv_line(cell.number, cell.sweep, scheme_word(cell.scheme), cell.time_step, cell.stiffness,
                    of_matrix(csv_number(cell.mass_ratio)), of_matrix(csv_number(cell.damping_ratio)),
                    of_matrix(csv_number(cell.aspect)), of_matrix(word_of(cell.mesh)), of_matrix(word_of(cell.start)),
                    of_matrix(word_of(cell.contact)), word_of(verdict), figures.finite, figures.pins_kept, figures.gain,
                    figures.bound, figures.step_excess, figures.residual, figures.strain, figures.steps, figures.halved,
                    figures.not_converged, figures.newton_iterations, figures.linear_iterations, figures.status, figures.said);
}

bool is_on_map(const StressRow& row, const StressRun& run) { return run.of_scene || row.cell.sweep == "base"; }

/// The longest stable steps of an explicit scheme at each stiffness of the base sweep.
std::vector<PlotPoint> limit_line(const StressRun& run, Scheme scheme) {
    std::vector<PlotPoint> points;
    if (run.of_scene) return points;
    for (const StressRow& row : run.rows) {
        if (row.cell.scheme != scheme || !is_on_map(row, run)) continue;
        const double square = largest_square(row.cell);
        const double limit =
            longest_stable_step(scheme, {.square = square, .damping = 2.0 * row.cell.damping_ratio * std::sqrt(square)});
        if (std::isinf(limit)) return points;
        if (points.empty() || points.back().y < row.cell.stiffness) points.push_back({limit, row.cell.stiffness});
    }
    return points;
}

}  // namespace

std::string stress_summary(const StressRun& run) {
    TableCells rows = {{"scheme"}};
    for (const StressVerdict verdict : verdicts) rows[0].emplace_back(word_of(verdict));
    rows[0].emplace_back("failures");
    for (const Scheme scheme : schemes_of(run)) {
        std::vector<int> counts(verdicts.size() + 1, 0);
        for (const StressRow& row : run.rows) {
            if (row.cell.scheme != scheme) continue;
            ++counts[static_cast<std::size_t>(row.verdict)];
            counts.back() += is_failure(scheme, row.verdict) ? 1 : 0;
        }
        rows.push_back({scheme_word(scheme)});
        for (const int count : counts) rows.back().push_back(std::to_string(count));
    }
    return aligned_table(rows, 1);
}

std::string stress_failures(const StressRun& run, int at_most) {
    std::string text;
    for (const StressRow& row : run.rows) {
        if (at_most == 0 || !is_failure(row.cell.scheme, row.verdict)) continue;
        text += "cell " + std::to_string(row.cell.number) + ": " + row_text(row, run.of_scene) + "\n";
        --at_most;
    }
    return text;
}

std::string stress_csv(const StressRun& run) {
    std::string text = "cell,sweep,scheme,time_step_s," + std::string(run.of_scene ? "stiffness_factor" : "stiffness_N_per_m") +
                       ",mass_ratio,damping_ratio,aspect,mesh,start,contact,verdict,finite,pins_kept,gain,gain_bound,step_excess,"
                       "largest_residual,largest_strain,steps,halved_steps,not_converged_steps,newton_iterations,"
                       "linear_iterations,status,said\n";
    for (const StressRow& row : run.rows) text += stress_line(row, run.of_scene);
    return text;
}

Plot stress_map(const StressRun& run) {
    Plot map{.title = "Where schemes are stable: " + run.title,
             .x_label = "time step, s",
             .y_label = run.of_scene ? "factor on the stiffness" : "stiffness of a spring, N/m"};
    for (const Scheme scheme : schemes_of(run)) {
        const std::size_t panel = map.panels.size(), first = map.series.size();
        map.panels.push_back(scheme_word(scheme));
        for (std::size_t k = 0; k < verdicts.size(); ++k)
            map.series.push_back({word_of(verdicts[k]), {}, panel, PlotMarks::cells, verdict_colours[k]});
        for (const StressRow& row : run.rows) {
            if (row.cell.scheme != scheme || !is_on_map(row, run)) continue;
            const std::string label = "cell " + std::to_string(row.cell.number) + ", gain " + short_number(row.figures.gain, 2);
            map.series[first + static_cast<std::size_t>(row.verdict)].points.push_back(
                {row.cell.time_step, row.cell.stiffness, label});
        }
        std::vector<PlotPoint> limit = limit_line(run, scheme);
        if (limit.empty()) continue;
        map.series.push_back({"longest stable step of the explicit schemes by linear theory", std::move(limit), panel,
                              PlotMarks::curve, "#000000"});
    }
    return map;
}

}  // namespace percale::scenes
