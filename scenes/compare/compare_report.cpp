#include "compare/compare_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/text.h"
#include "report/csv.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

std::string formatted(const char* format, double value) {
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string short_text(double value) { return formatted("%.2g", value); }

bool finished(const ComparedRun& run) { return run.run.end == VariantEnd::finished; }

/// An error as the table shows it.
std::string error_text(double error, double uncertainty) {
    if (std::isnan(error)) return "-";
    return error > uncertainty ? formatted("%.2e", error) : "< " + short_text(uncertainty);
}

/// One kind of error.
struct ErrorColumn {
    const char* heading;
    double Distances::*value;
    bool chaotic, regular;  // shown in tables of such scenes
};
constexpr ErrorColumn error_columns[] = {{"rms m", &Distances::rms, false, true},
                                         {"largest m", &Distances::largest, false, true},
                                         {"mass centre m", &Distances::mass_centre, true, false},
                                         {"lowest m", &Distances::lowest, true, false},
                                         {"stretch", &Distances::stretch, true, false},
                                         {"energy J", &Distances::energy, true, true}};

using Row = std::vector<std::string>;

template <class Visit>
void for_shown_errors(const Comparison& comparison, Visit visit) {
    for (const ErrorColumn& column : error_columns)
        if (comparison.reference.chaotic ? column.chaotic : column.regular) visit(column);
}

Row heading_row(const Comparison& comparison) {
    Row row{"scheme", "step", "steps", "Newton", "linear", "CPU s"};
    for_shown_errors(comparison, [&](const ErrorColumn& column) { row.emplace_back(column.heading); });
    row.emplace_back("status");
    return row;
}

std::string status_text(const VariantRun& run) {
    if (run.end == VariantEnd::blew_up) return end_word(run.end) + (" after " + short_text(run.totals.simulated_s)) + " s";
    return end_word(run.end) + (run.reason.empty() ? "" : ": " + run.reason);
}

Row table_row(const Comparison& comparison, const ComparedRun& compared) {
    const RunTotals& totals = compared.run.totals;
    Row row{compared.variant.scheme,
            length_text(compared.variant),
            std::to_string(compared.run.steps),
            std::to_string(totals.newton_iterations),
            std::to_string(totals.linear_iterations),
            formatted("%.3g", totals.cpu_s)};
    for_shown_errors(comparison, [&](const ErrorColumn& column) {
        row.push_back(error_text(compared.error.*column.value, comparison.reference.uncertainty.*column.value));
    });
    row.push_back(status_text(compared.run));
    return row;
}

/// Columns as wide as their widest entry; the first two and the last to the left, figures to the right.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    std::string text;
    for (const Row& row : rows) {
        for (std::size_t k = 0; k + 1 < row.size(); ++k) {
            const std::string fill(widths[k] - row[k].size(), ' ');
            text += (k < 2 ? row[k] + fill : fill + row[k]) + "  ";
        }
        text += row.back() + "\n";
    }
    return text;
}

std::string csv_line(const Variant& variant, const std::string& status, const Distances& error, const VariantRun* run) {
    std::string line = variant.scheme + "," + (variant.time_step > 0.0 ? number_text(variant.time_step) : "") + "," +
                       (variant.time_step > 0.0 ? "" : number_text(variant.tolerance)) + "," + status;
    if (run) {
        for (const long count : {static_cast<long>(run->steps), static_cast<long>(run->rejected), run->totals.newton_iterations,
                                 run->totals.linear_iterations})
            line += "," + std::to_string(count);
        line += "," + csv_number(run->totals.cpu_s);
    } else {
        line += ",,,,,";
    }
    for (const ErrorColumn& column : error_columns) line += "," + csv_number(error.*column.value);
    return line;
}

std::string decade_text(int power) { return "1e" + std::to_string(power) + " m"; }

std::string series_name(const Variant& variant) { return variant.scheme + (variant.time_step > 0.0 ? "" : ", adaptive"); }

PlotSeries& series_of(Plot& plot, const std::string& name) {
    const auto found =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const PlotSeries& series) { return series.name == name; });
    return found != plot.series.end() ? *found : plot.series.emplace_back(PlotSeries{name, {}});
}

}  // namespace

std::string reference_text(const Reference& reference) {
    const Distances& u = reference.uncertainty;
    std::string text = "reference: " + variant_text(reference.variant) + ", known to " + short_text(u.rms) + " m rms, " +
                       short_text(u.largest) + " m at the worst vertex, " + short_text(u.energy) + " J\n";
    text += "a disturbance of " + short_text(disturbance_at_start) + " m grows " + short_text(reference.growth) + "-fold";
    if (!reference.chaotic) return text + ": positions are compared\n";
    return text + ", more than " + short_text(chaos_growth) +
           "-fold: chaotic, so that centre of mass, lowest vertex, stretch and energy are compared, not positions\n"
           "(the centre of mass is known to " +
           short_text(u.mass_centre) + " m)\n";
}

std::string comparison_table(const Comparison& comparison) {
    std::vector<Row> rows{heading_row(comparison)};
    for (const ComparedRun& run : comparison.runs) rows.push_back(table_row(comparison, run));
    return aligned(rows);
}

std::string comparison_csv(const Comparison& comparison) {
    std::string text =
        "scheme,time_step_s,tolerance_m_per_s,status,steps,rejected_steps,newton_iterations,linear_iterations,cpu_s,rms_error_m,"
        "largest_error_m,mass_centre_error_m,lowest_vertex_error_m,stretch_error,energy_error_J,reason\n";
    const Reference& reference = comparison.reference;
    const std::string kind = reference.chaotic ? "chaotic: compare invariants, not positions" : "errors are the uncertainty";
    text += csv_line(reference.variant, "reference", reference.uncertainty, nullptr) + "," + kind + "\n";
    for (const ComparedRun& compared : comparison.runs) {
        text += csv_line(compared.variant, end_word(compared.run.end), compared.error, &compared.run) + "," +
                csv_text(compared.run.reason) + "\n";
    }
    return text;
}

const ComparedRun* cheapest_within(const Comparison& comparison, double largest_error) {
    const double uncertainty = comparison.rank_of(comparison.reference.uncertainty);
    const ComparedRun* cheapest = nullptr;
    for (const ComparedRun& compared : comparison.runs) {
        if (!finished(compared) || !(comparison.rank_of(compared.error) + uncertainty <= largest_error)) continue;
        if (!cheapest || compared.run.totals.cpu_s < cheapest->run.totals.cpu_s) cheapest = &compared;
    }
    return cheapest;
}

std::vector<std::string> advice(const Comparison& comparison) {
    std::vector<std::string> sentences;
    for (int power = -1; const ComparedRun* best = cheapest_within(comparison, std::pow(10.0, power));) {
        const int first = power;
        while (cheapest_within(comparison, std::pow(10.0, power - 1)) == best) --power;
        const std::string range = decade_text(first) + (power < first ? " to " + decade_text(power) : "");
        sentences.push_back("for an error of " + range + " use " + variant_text(best->variant) + " (" +
                            short_text(best->run.totals.cpu_s) + " CPU s)");
        --power;
    }
    if (sentences.empty()) sentences.emplace_back("no run here has an error of certainly 1e-1 m or less");
    return sentences;
}

Plot comparison_plot(const Comparison& comparison) {
    const double uncertainty = comparison.rank_of(comparison.reference.uncertainty);
    Plot plot{.title = comparison.title.empty() ? "error against run time" : comparison.title,
              .x_label = "CPU time of " + number_text(comparison.duration) + " s, s",
              .y_label = comparison.reference.chaotic ? "error of centre of mass, lowest vertex and stretch, m"
                                                      : "error, rms over vertices, m",
              .series = {},
              .floor = uncertainty,
              .floor_label = "reference"};
    for (const ComparedRun& compared : comparison.runs) {
        if (!finished(compared)) continue;
        const double error = std::max(comparison.rank_of(compared.error), uncertainty);
        const std::string label =
            variant_text(compared.variant) + ": " + short_text(error) + " m, " + short_text(compared.run.totals.cpu_s) + " CPU s";
        series_of(plot, series_name(compared.variant)).points.push_back({compared.run.totals.cpu_s, error, label});
    }
    return plot;
}

}  // namespace percale::scenes
