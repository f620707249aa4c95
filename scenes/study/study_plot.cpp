#include "study/study_plot.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "common/text.h"

namespace percale::scenes {

namespace {

/// Values of a key that a plot shows apart, at most; and ranges of one that has more.
constexpr std::size_t max_shown_values = 12, value_ranges = 3;

/// Largest over smallest value from which an axis is logarithmic. Smaller: axes of what hardly varies are. Larger: small values
/// cannot be told apart.
constexpr double logarithmic_ratio = 100.0;

double number_of(const std::string& value) { return std::strtod(value.c_str(), nullptr); }

AxisScale scale_of(const std::vector<double>& values) {
    if (values.empty()) return AxisScale::linear;
    const auto [min, max] = std::ranges::minmax(values);
    return min > 0.0 && max >= logarithmic_ratio * min ? AxisScale::logarithmic : AxisScale::linear;
}

/// Runs that are alike in one key.
struct RunGroups {
    std::vector<std::string> names = {};   // without any all runs are one group
    std::vector<std::size_t> of_run = {};  // the group of each run
    bool exact = true;                     // runs of a group have the same value
};

/// A group a value, in the order of their first runs; none where they are too many.
RunGroups groups_of_values(const std::string& key, const std::vector<std::string>& values) {
    RunGroups groups;
    for (const std::string& value : values) {
        const std::string name = key + " = " + shown_value(value);
        const auto found = std::ranges::find(groups.names, name);
        groups.of_run.push_back(static_cast<std::size_t>(found - groups.names.begin()));
        if (found == groups.names.end()) groups.names.push_back(name);
        if (groups.names.size() > max_shown_values) return {};
    }
    return groups;
}

/// Ranges of the key's numbers with equally many runs.
RunGroups groups_of_ranges(const std::string& key, const std::vector<std::string>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t run) { return number_of(values[run]); });
    RunGroups groups{.names = {}, .of_run = std::vector<std::size_t>(values.size()), .exact = false};
    for (std::size_t range = 0; range < value_ranges; ++range) {
        const std::size_t first = range * values.size() / value_ranges, end = (range + 1) * values.size() / value_ranges;
        if (first == end) continue;
        for (std::size_t k = first; k < end; ++k) groups.of_run[order[k]] = groups.names.size();
        groups.names.push_back(key + " = " + short_number(number_of(values[order[first]]), 2) + " ... " +
                               short_number(number_of(values[order[end - 1]]), 2));
    }
    return groups;
}

std::vector<std::string> values_of(const Study& study, std::size_t key) {
    std::vector<std::string> values;
    for (const std::vector<std::string>& run : study.runs) values.push_back(run[key]);
    return values;
}

/// What the keys of a study are in its plot.
struct PlotKeys {
    std::size_t x = 0;
    std::vector<RunGroups> groups = {};  // of the other keys that vary: series, panels, and what is shown by neither
    bool grid = true;                    // each place of the plot has one run
};

PlotKeys plot_keys(const Study& study) {
    PlotKeys keys;
    for (std::size_t k = 0; k < study.keys.size(); ++k) {
        const bool random = is_random_form(study.forms[k]);
        const std::vector<std::string> values = values_of(study, k);
        if (random) keys.grid = false;
        if (study.keys[k] == study.plot_key) keys.x = k;
        if (study.keys[k] == study.plot_key || std::ranges::all_of(values, [&](const auto& value) { return value == values[0]; }))
            continue;
        RunGroups groups = random ? RunGroups() : groups_of_values(study.keys[k], values);
        if (groups.names.empty() && std::ranges::all_of(values, is_number)) groups = groups_of_ranges(study.keys[k], values);
        if (groups.names.empty() || !groups.exact) keys.grid = false;
        if (!groups.names.empty()) keys.groups.push_back(std::move(groups));
    }
    if (keys.groups.size() > 2) keys.grid = false;
    const RunGroups all{.names = {}, .of_run = std::vector<std::size_t>(study.runs.size())};
    keys.groups.resize(2 + keys.groups.size(), all);
    return keys;
}

}  // namespace

Plot study_plot(const Study& study, const std::vector<std::optional<double>>& values) {
    Plot plot{.title = study.plot_measure + " over " + study.plot_key, .x_label = study.plot_key, .y_label = study.plot_measure};
    if (study.plot_key.empty()) return plot;
    const PlotKeys keys = plot_keys(study);
    const RunGroups &names = keys.groups[0], &panels = keys.groups[1];
    plot.panels = panels.names;
    for (std::size_t panel = 0; panel < std::max<std::size_t>(1, panels.names.size()); ++panel)
        for (std::size_t name = 0; name < std::max<std::size_t>(1, names.names.size()); ++name)
            plot.series.push_back(
                {names.names.empty() ? "" : names.names[name], {}, panel, keys.grid ? PlotMarks::lines : PlotMarks::points});
    std::vector<double> x, y;
    for (std::size_t run = 0; run < study.runs.size(); ++run) {
        x.push_back(number_of(study.runs[run][keys.x]));
        if (!values[run]) continue;
        y.push_back(*values[run]);
        const std::size_t series = panels.of_run[run] * std::max<std::size_t>(1, names.names.size()) + names.of_run[run];
        plot.series[series].points.push_back({x.back(), y.back(), "run " + std::to_string(run)});
    }
    for (PlotSeries& series : plot.series) std::ranges::stable_sort(series.points, {}, &PlotPoint::x);
    std::erase_if(plot.series, [](const PlotSeries& series) { return series.points.empty(); });
    const std::string& form = study.forms[keys.x];
    plot.x_scale = form == "list" ? scale_of(x) : is_log_form(form) ? AxisScale::logarithmic : AxisScale::linear;
    plot.y_scale = scale_of(y);
    return plot;
}

}  // namespace percale::scenes
