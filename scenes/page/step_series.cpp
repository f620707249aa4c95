#include "page/step_series.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "export/step_table.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

constexpr const char* shown_columns[] = {"dt", "newton", "linear", "residual", "contacts", "smallest_distance", "energy"};

/// A number of the table, inf and nan included.
double step_number(const StepRows& table, std::size_t line, std::size_t cell) {
    const std::string& word = table.lines[line][cell];
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (!word.empty() && error == std::errc() && end == word.data() + word.size()) return value;
    throw SceneError(table.file + ":" + std::to_string(line + 2) + ": '" + word.substr(0, 40) + "' is not a number");
}

StepColumn grouped(const StepRows& table, const char* name, std::size_t every) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    StepColumn column{name, {}, {}};
    const std::size_t cell = table.column(name);
    for (std::size_t line = 0; line < table.lines.size(); ++line) {
        if (line % every == 0) {
            column.min.push_back(none);
            column.max.push_back(none);
        }
        const double value = step_number(table, line, cell);
        if (!std::isfinite(value)) continue;
        // fmin and fmax pass over what is not a number.
        column.min.back() = std::fmin(column.min.back(), value);
        column.max.back() = std::fmax(column.max.back(), value);
    }
    return column;
}

}  // namespace

StepSeries read_step_series(const std::string& folder, int max_groups) {
    const StepRows table = read_step_rows(folder + "/steps.csv", "a folder written by `percale run` holds it");
    const std::size_t time_cell = table.column("time"), status = table.column("status");
    const std::size_t steps = table.lines.size(), max = static_cast<std::size_t>(max_groups);
    const std::size_t every = std::max<std::size_t>(1, (steps + max - 1) / max);
    StepSeries series;
    series.steps = static_cast<int>(steps);
    series.every = static_cast<int>(every);
    for (std::size_t line = 0; line < steps; ++line) {
        const double time = step_number(table, line, time_cell);
        if (line % every == every - 1 || line + 1 == steps) series.time.push_back(time);
        if (table.lines[line][status] == "ok") continue;
        ++series.bad_steps;
        if (series.bad.size() < max) series.bad.push_back(time);
    }
    for (const char* name : shown_columns) series.columns.push_back(grouped(table, name, every));
    return series;
}

}  // namespace percale::scenes
