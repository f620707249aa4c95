#include "sweep/study_table.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "format/expectations.h"
#include "report/csv.h"
#include "report/plot_svg.h"

namespace percale::scenes {

namespace {

using Report = nlohmann::json;

std::string number_cell(const Report& report, const std::string& key) {
    const auto found = report.find(key);
    return found != report.end() && found->is_number() ? csv_number(found->get<double>()) : "";
}

/// A value of --set as people read it: a text without its quotes.
std::string shown_value(const std::string& value) {
    const Report text = value.starts_with('"') ? Report::parse(value, nullptr, false) : Report();
    return text.is_string() ? text.get<std::string>() : value;
}

struct Expected {
    int all = 0, passed = 0;
};

Expected expected_of(const Report& report) {
    Expected expected;
    if (!report.is_object()) return expected;
    for (const Report& one : report.value("expectations", Report::array())) {
        ++expected.all;
        expected.passed += one.value("passed", false) ? 1 : 0;
    }
    return expected;
}

std::string header_of(const Study& study) {
    std::string header = "run";
    for (const std::string& key : study.keys) header += "," + csv_text(key);
    header += ",status";
    for (const MeasureDescription& measure : measure_descriptions()) header += "," + measure.name;
    return header + ",expectations,passed\n";
}

std::string line_of(const Study& study, std::size_t run, const Report& report) {
    std::string line = std::to_string(run);
    for (const std::string& value : study.runs[run]) line += "," + csv_text(shown_value(value));
    line += "," + csv_text(report.is_object() ? report.value("status", "") : "missing");
    for (const MeasureDescription& measure : measure_descriptions()) line += "," + number_cell(report, measure.name);
    const Expected expected = expected_of(report);
    return line + "," + (report.is_object() ? std::to_string(expected.all) + "," + std::to_string(expected.passed) : ",") + "\n";
}

/// Points of the plot. The first other key with 2 ... 12 values makes a series for each of them; without one there is one series.
class StudyPlot {
public:
    explicit StudyPlot(const Study& study) : study_(study) {
        for (std::size_t k = 0; k < study.keys.size(); ++k) {
            std::vector<std::string> values;
            for (const auto& run : study.runs)
                if (std::ranges::find(values, run[k]) == values.end() && values.size() <= max_series) values.push_back(run[k]);
            if (study.keys[k] == study.plot_key)
                x_ = k;
            else if (values.size() > 1 && values.size() <= max_series && series_key_ == study.keys.size())
                series_key_ = k;
        }
    }

    void add(std::size_t run, const Report& report) {
        const auto found = report.find(study_.plot_measure);
        if (study_.plot_key.empty() || found == report.end() || !found->is_number()) return;
        const bool several = series_key_ < study_.keys.size();
        const std::string name = several ? study_.keys[series_key_] + " = " + shown_value(study_.runs[run][series_key_]) : "";
        series_[name].push_back(
            {std::strtod(study_.runs[run][x_].c_str(), nullptr), found->get<double>(), "run " + std::to_string(run)});
    }

    std::string svg() {
        Plot plot{.title = study_.plot_measure + " over " + study_.plot_key,
                  .x_label = study_.plot_key,
                  .y_label = study_.plot_measure};
        for (auto& [name, points] : series_) {
            std::ranges::stable_sort(points, {}, &PlotPoint::x);
            plot.series.push_back({name, points});
        }
        return plot_svg(plot);
    }

private:
    static constexpr std::size_t max_series = 12;
    const Study& study_;
    std::size_t x_ = 0, series_key_ = study_.keys.size();
    std::map<std::string, std::vector<PlotPoint>> series_;
};

}  // namespace

StudyTables study_tables(const Study& study, const StudyFolder& folder) {
    StudyTables tables{.csv = header_of(study), .costs = "run,steps,cpu_s,wall_s,peak_memory_bytes\n", .svg = {}};
    StudyPlot plot(study);
    for (std::size_t run = 0; run < study.runs.size(); ++run) {
        std::ifstream in(folder.is_done(run) ? folder.folder_of(run) + "/report.json" : "");
        const Report report = in ? Report::parse(in, nullptr, false) : Report();
        tables.csv += line_of(study, run, report);
        if (!report.is_object()) continue;
        ++tables.done;
        tables.failed += report.value("status", "finished") != "finished" ? 1 : 0;
        const Expected expected = expected_of(report);
        tables.not_as_expected += expected.passed < expected.all ? 1 : 0;
        tables.costs += std::to_string(run);
        for (const char* key : {"steps", "cpu_s", "wall_s", "peak_memory_bytes"}) tables.costs += "," + number_cell(report, key);
        tables.costs += "\n";
        plot.add(run, report);
    }
    tables.svg = plot.svg();
    return tables;
}

}  // namespace percale::scenes
