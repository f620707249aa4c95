#include "page/step_series.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

#include "common/input_file.h"
#include "percale/error.h"
#include "report/csv.h"

namespace percale::scenes {

namespace {

constexpr const char* shown_columns[] = {"dt", "newton", "linear", "residual", "contacts", "smallest_distance", "energy"};

/// The numbers of the columns that are read.
struct StepPlaces {
    std::size_t cells = 0, time = 0, status = 0;
    std::vector<std::size_t> shown;
};

struct StepTableText {
    StepPlaces places;
    std::vector<std::vector<std::string>> lines;
    std::string file;
};

std::size_t place_of_column(const std::vector<std::string>& header, const std::string& name, const std::string& file) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) throw SceneError(file + ":1: is no table of steps: it has no column '" + name + "'");
    return static_cast<std::size_t>(found - header.begin());
}

StepTableText read_step_table(const std::string& file) {
    StepTableText table{.places = {}, .lines = {}, .file = file};
    std::ifstream in = open_input(file);
    std::string line;
    if (!in || !std::getline(in, line)) throw SceneError(file + ": cannot be read; a folder written by `percale run` holds it");
    const std::vector<std::string> header = csv_cells(line);
    table.places = {header.size(), place_of_column(header, "time", file), place_of_column(header, "status", file), {}};
    for (const char* name : shown_columns) table.places.shown.push_back(place_of_column(header, name, file));
    while (std::getline(in, line)) {
        table.lines.push_back(csv_cells(line));
        if (table.lines.back().size() != header.size())
            throw SceneError(file + ":" + std::to_string(table.lines.size() + 1) + ": has " +
                             std::to_string(table.lines.back().size()) + " columns, not " + std::to_string(header.size()));
    }
    return table;
}

/// A number of the table, inf and nan included.
double step_number(const StepTableText& table, std::size_t line, std::size_t cell) {
    const std::string& word = table.lines[line][cell];
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (!word.empty() && error == std::errc() && end == word.data() + word.size()) return value;
    throw SceneError(table.file + ":" + std::to_string(line + 2) + ": '" + word.substr(0, 40) + "' is not a number");
}

StepColumn grouped(const StepTableText& table, std::size_t shown, std::size_t every) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    StepColumn column{shown_columns[shown], {}, {}};
    for (std::size_t line = 0; line < table.lines.size(); ++line) {
        if (line % every == 0) {
            column.min.push_back(none);
            column.max.push_back(none);
        }
        const double value = step_number(table, line, table.places.shown[shown]);
        if (!std::isfinite(value)) continue;
        // fmin and fmax pass over what is not a number.
        column.min.back() = std::fmin(column.min.back(), value);
        column.max.back() = std::fmax(column.max.back(), value);
    }
    return column;
}

}  // namespace

StepSeries read_step_series(const std::string& folder, int max_groups) {
    const StepTableText table = read_step_table(folder + "/steps.csv");
    const std::size_t steps = table.lines.size(), max = static_cast<std::size_t>(max_groups);
    const std::size_t every = std::max<std::size_t>(1, (steps + max - 1) / max);
    StepSeries series;
    series.steps = static_cast<int>(steps);
    series.every = static_cast<int>(every);
    for (std::size_t line = 0; line < steps; ++line) {
        const double time = step_number(table, line, table.places.time);
        if (line % every == every - 1 || line + 1 == steps) series.time.push_back(time);
        if (table.lines[line][table.places.status] == "ok") continue;
        ++series.bad_steps;
        if (series.bad.size() < max) series.bad.push_back(time);
    }
    for (std::size_t shown = 0; shown < std::size(shown_columns); ++shown) series.columns.push_back(grouped(table, shown, every));
    return series;
}

}  // namespace percale::scenes
