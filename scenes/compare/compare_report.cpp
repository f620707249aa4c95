#include "compare/compare_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/text.h"
#include "report/csv.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

bool finished(const ComparedRun& run) { return run.run.end == VariantEnd::finished; }

/// An error as the table shows it.
std::string error_text(double error, double uncertainty) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2e", error);
    if (std::isnan(error)) return "-";
    return error > uncertainty ? text : "< " + short_number(uncertainty, 2);
}

/// What tables of regular and of chaotic scenes show, in the order of each_distance.
struct ErrorColumn {
    const char* heading;
    bool chaotic, regular;
};
constexpr std::array<ErrorColumn, each_distance.size()> error_columns = {{{"rms m", false, true},
                                                                          {"largest m", false, true},
                                                                          {"mass centre m", true, false},
                                                                          {"lowest m", true, false},
                                                                          {"stretch", true, false},
                                                                          {"energy J", true, true}}};

std::string status_text(const VariantRun& run) {
    if (run.end == VariantEnd::blew_up) return end_word(run.end) + (" after " + short_number(run.totals.simulated_s, 2)) + " s";
    return end_word(run.end) + (run.reason.empty() ? "" : ": " + run.reason);
}

/// A line of the table for programs; the reference has no counts.
std::string comparison_line(const ComparedRun& compared, const std::string& status, const std::string& reason,
                            bool counted = true) {
    const auto& [variant, run, error] = compared;
    const auto count = [&](long value) { return counted ? std::to_string(value) : ""; };
    const bool fixed = variant.time_step > 0.0;
    return csv_line(variant.scheme, fixed ? number_text(variant.time_step) : "", fixed ? "" : number_text(variant.tolerance),
                    status, count(run.steps), count(run.rejected), count(run.totals.newton_iterations),
                    count(run.totals.linear_iterations), counted ? csv_number(run.totals.cpu_s) : "", error.rms, error.largest,
                    error.mass_centre, error.lowest, error.stretch, error.energy, reason);
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
    std::string text = "reference: " + variant_text(reference.variant) + ", known to " + short_number(u.rms, 2) + " m rms, " +
                       short_number(u.largest, 2) + " m at the worst vertex, " + short_number(u.energy, 2) + " J\n";
    text +=
        "a disturbance of " + short_number(disturbance_at_start, 2) + " m grows " + short_number(reference.growth, 2) + "-fold";
    if (!reference.chaotic) return text + ": positions are compared\n";
    return text + ", more than " + short_number(chaos_growth, 2) +
           "-fold: chaotic, so that centre of mass, lowest vertex, stretch and energy are compared, not positions\n"
           "(the centre of mass is known to " +
           short_number(u.mass_centre, 2) + " m)\n";
}

std::string comparison_table(const Comparison& comparison) {
    const Reference& reference = comparison.reference;
    TableCells rows = {{"scheme", "step", "steps", "Newton", "linear", "CPU s"}};
    for (const auto& [variant, run, error] : comparison.runs)
        rows.push_back({variant.scheme, length_text(variant), std::to_string(run.steps),
                        std::to_string(run.totals.newton_iterations), std::to_string(run.totals.linear_iterations),
                        short_number(run.totals.cpu_s)});
    for (std::size_t k = 0; k < each_distance.size(); ++k) {
        if (!(reference.chaotic ? error_columns[k].chaotic : error_columns[k].regular)) continue;
        const auto distance = each_distance[k];
        rows[0].emplace_back(error_columns[k].heading);
        for (std::size_t i = 0; i < comparison.runs.size(); ++i)
            rows[i + 1].push_back(error_text(comparison.runs[i].error.*distance, reference.uncertainty.*distance));
    }
    rows[0].emplace_back("status");
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) rows[i + 1].push_back(status_text(comparison.runs[i].run));
    return aligned_table(rows, 2, true);
}

std::string comparison_csv(const Comparison& comparison) {
    std::string text =
        "scheme,time_step_s,tolerance_m_per_s,status,steps,rejected_steps,newton_iterations,linear_iterations,cpu_s,rms_error_m,"
        "largest_error_m,mass_centre_error_m,lowest_vertex_error_m,stretch_error,energy_error_J,reason\n";
    const Reference& reference = comparison.reference;
    text +=
        comparison_line({reference.variant, {}, reference.uncertainty}, "reference",
                        reference.chaotic ? "chaotic: compare invariants, not positions" : "errors are the uncertainty", false);
    for (const ComparedRun& run : comparison.runs) text += comparison_line(run, end_word(run.run.end), run.run.reason);
    return text;
}

/// Errors below 1e-15 m are rounding, those of schemes that are exact for a scene may be 0.
constexpr int lowest_power = -15;

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
    const auto cheapest = [&](int power) {
        return power < lowest_power ? nullptr : cheapest_within(comparison, std::pow(10.0, power));
    };
    for (int power = -1; const ComparedRun* best = cheapest(power);) {
        const int first = power;
        while (cheapest(power - 1) == best) --power;
        const std::string range = decade_text(first) + (power < first ? " to " + decade_text(power) : "");
        sentences.push_back("for an error of " + range + " use " + variant_text(best->variant) + " (" +
                            short_number(best->run.totals.cpu_s, 2) + " CPU s)");
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
        const std::string label = variant_text(compared.variant) + ": " + short_number(error, 2) + " m, " +
                                  short_number(compared.run.totals.cpu_s, 2) + " CPU s";
        series_of(plot, series_name(compared.variant)).points.push_back({compared.run.totals.cpu_s, error, label});
    }
    return plot;
}

}  // namespace percale::scenes
