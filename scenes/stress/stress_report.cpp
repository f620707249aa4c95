#include "stress/stress_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/text.h"
#include "compare/compare.h"
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

int count(const StressRun& run, Scheme scheme, StressVerdict verdict) {
    return static_cast<int>(std::count_if(run.rows.begin(), run.rows.end(), [&](const StressRow& row) {
        return row.cell.scheme == scheme && row.verdict == verdict;
    }));
}

std::string padded(const std::string& text, std::size_t columns, bool right) {
    const std::string fill(columns > text.size() ? columns - text.size() : 0, ' ');
    return right ? fill + text : text + fill;
}

std::string brief(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

std::string cell_text(const StressCell& cell, bool of_scene) {
    std::string text = scheme_word(cell.scheme) + ", " + brief(cell.time_step) + " s, ";
    if (of_scene) return text + "stiffness x " + brief(cell.stiffness);
    text += brief(cell.stiffness) + " N/m, masses 1 : " + brief(cell.mass_ratio) + ", damping " + brief(cell.damping_ratio) +
            ", " + word_of(cell.mesh);
    if (cell.mesh == StressMesh::sliver) text += " " + brief(cell.aspect) + " : 1";
    text += std::string(", ") + word_of(cell.start);
    return cell.contact == StressContact::none ? text : text + ", contact by " + word_of(cell.contact);
}

std::string row_text(const StressRow& row, bool of_scene) {
    const StressFigures& figures = row.figures;
    std::string text = cell_text(row.cell, of_scene) + ": " + word_of(row.verdict);
    if (!figures.finite) text += ", not finite";
    if (!figures.pins_kept) text += ", a pin moved";
    text += ", gain " + brief(figures.gain) + " (bound " + brief(figures.bound) + ")";
    if (figures.step_excess > 0.0) text += ", of a step beyond its bound " + brief(figures.step_excess);
    return text + ", status " + figures.status + " after " + std::to_string(figures.steps) + " steps";
}

/// What only cells of the matrix have: six fields, empty for a scene.
std::string matrix_fields(const StressCell& cell, bool of_scene) {
    if (of_scene) return ",,,,,,";
    std::string fields;
    for (const double value : {cell.mass_ratio, cell.damping_ratio, cell.aspect}) fields += "," + csv_number(value);
    return fields + "," + word_of(cell.mesh) + "," + word_of(cell.start) + "," + word_of(cell.contact);
}

std::string csv_row(const StressRow& row, bool of_scene) {
    const auto& [cell, figures, verdict] = row;
    std::string line = std::to_string(cell.number) + "," + cell.sweep + "," + scheme_word(cell.scheme) + "," +
                       csv_number(cell.time_step) + "," + csv_number(cell.stiffness) + matrix_fields(cell, of_scene) + "," +
                       word_of(verdict);
    line += figures.finite ? ",yes" : ",no";
    line += figures.pins_kept ? ",yes" : ",no";
    for (const double value : {figures.gain, figures.bound, figures.step_excess, figures.residual, figures.strain})
        line += "," + csv_number(value);
    for (const long value : {static_cast<long>(figures.steps), static_cast<long>(figures.halved),
                             static_cast<long>(figures.not_converged), figures.newton_iterations, figures.linear_iterations})
        line += "," + std::to_string(value);
    return line + "," + csv_text(figures.status) + "," + csv_text(figures.said) + "\n";
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
    constexpr std::size_t first = 18, others = 11;
    std::string text = padded("scheme", first, false);
    for (const StressVerdict verdict : verdicts) text += padded(word_of(verdict), others, true);
    text += padded("failures", others, true) + "\n";
    for (const Scheme scheme : schemes_of(run)) {
        text += padded(scheme_word(scheme), first, false);
        int failures = 0;
        for (const StressVerdict verdict : verdicts) {
            const int number = count(run, scheme, verdict);
            if (is_failure(scheme, verdict)) failures += number;
            text += padded(std::to_string(number), others, true);
        }
        text += padded(std::to_string(failures), others, true) + "\n";
    }
    return text;
}

std::string stress_failures(const StressRun& run, int at_most) {
    std::string text;
    int reported = 0;

    for (const StressRow& row : run.rows) {
        if (reported == at_most) break;
        if (!is_failure(row.cell.scheme, row.verdict)) continue;
        text += "cell " + std::to_string(row.cell.number) + ": " + row_text(row, run.of_scene) + "\n";
        ++reported;
    }
    return text;
}

std::string stress_csv(const StressRun& run) {
    std::string text = "cell,sweep,scheme,time_step_s," + std::string(run.of_scene ? "stiffness_factor" : "stiffness_N_per_m") +
                       ",mass_ratio,damping_ratio,aspect,mesh,start,contact,verdict,finite,pins_kept,gain,gain_bound,step_excess,"
                       "largest_residual,largest_strain,steps,halved_steps,not_converged_steps,newton_iterations,"
                       "linear_iterations,status,said\n";
    for (const StressRow& row : run.rows) text += csv_row(row, run.of_scene);
    return text;
}

ColourMap stress_map(const StressRun& run) {
    ColourMap map{.title = "Where schemes are stable: " + run.title,
                  .x_label = "time step, s",
                  .y_label = run.of_scene ? "factor on the stiffness" : "stiffness of a spring, N/m",
                  .legend = {},
                  .limit_name = run.of_scene ? "" : "longest stable step of the explicit schemes by linear theory",
                  .panels = {}};
    for (std::size_t k = 0; k < verdicts.size(); ++k) map.legend.push_back({verdict_colours[k], word_of(verdicts[k])});
    for (const Scheme scheme : schemes_of(run)) {
        MapPanel panel{.name = scheme_word(scheme), .cells = {}, .limit = limit_line(run, scheme)};
        for (const StressRow& row : run.rows) {
            if (row.cell.scheme != scheme || !is_on_map(row, run)) continue;
            panel.cells.push_back({row.cell.time_step, row.cell.stiffness, static_cast<int>(row.verdict),
                                   "cell " + std::to_string(row.cell.number) + ", gain " + brief(row.figures.gain)});
        }
        map.panels.push_back(std::move(panel));
    }
    return map;
}

}  // namespace percale::scenes
