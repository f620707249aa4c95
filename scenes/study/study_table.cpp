#include "study/study_table.h"

#include <array>
#include <optional>

#include "export/kept_run.h"
#include "format/expectations.h"
#include "report/csv.h"
#include "study/study_plot.h"

namespace percale::scenes {

namespace {

using CsvCells = std::vector<std::string>;

CsvCells study_headings(const Study& study) {
    CsvCells cells = {"run"};
    cells.insert(cells.end(), study.keys.begin(), study.keys.end());
    cells.emplace_back("status");
    for (const MeasureDescription& measure : measure_descriptions()) cells.push_back(measure.name);
    cells.insert(cells.end(), {"expectations", "passed"});
    return cells;
}

std::string number_cell(const std::optional<EndedRun>& ended, const std::string& name) {
    return ended && ended->numbers.contains(name) ? csv_number(ended->numbers.at(name)) : "";
}

CsvCells study_cells(const Study& study, std::size_t run, const std::optional<EndedRun>& ended) {
    CsvCells cells = {std::to_string(run)};
    for (const std::string& value : study.runs[run]) cells.push_back(shown_value(value));
    cells.push_back(ended ? ended->status : "missing");
    for (const MeasureDescription& measure : measure_descriptions()) cells.push_back(number_cell(ended, measure.name));
    cells.push_back(ended ? std::to_string(ended->expectations.size()) : "");
    cells.push_back(ended ? std::to_string(ended->passed()) : "");
    return cells;
}

}  // namespace

StudyTables study_tables(const Study& study, const StudyFolder& folder) {
    constexpr std::array costs = {"steps", "cpu_s", "wall_s", "peak_memory_bytes"};
    StudyTables tables{
        .csv = csv_table({study_headings(study)}), .costs = "run,steps,cpu_s,wall_s,peak_memory_bytes\n", .svg = {}};
    std::vector<std::optional<double>> shown(study.runs.size());
    for (std::size_t run = 0; run < study.runs.size(); ++run) {
        const std::optional<EndedRun> ended = ended_run(folder.folder_of(run));
        tables.csv += csv_table({study_cells(study, run, ended)});
        if (!ended) continue;
        ++tables.done;
        tables.failed += ended->status != "finished" ? 1 : 0;
        tables.not_as_expected += ended->passed() < ended->expectations.size() ? 1 : 0;
        CsvCells cells = {std::to_string(run)};
        for (const char* cost : costs) cells.push_back(number_cell(ended, cost));
        tables.costs += csv_table({cells});
        if (const auto found = ended->numbers.find(study.plot_measure); found != ended->numbers.end()) shown[run] = found->second;
    }
    tables.svg = plot_svg(study_plot(study, shown));
    return tables;
}

}  // namespace percale::scenes
