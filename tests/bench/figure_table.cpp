#include "tests/bench/figure_table.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace percale::test {
namespace {

std::string cell(const Figures& value) {
    if (value.is_null()) return "-";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_number_float()) return value.dump();
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value.get<double>());
    return text;
}

/// A row without tables in it: their keys follow the key of the table after a space.
Figures flat(const Figures& row) {
    Figures result = Figures::object();
    for (const auto& [key, value] : row.items()) {
        if (!value.is_object()) {
            result[key] = value;
            continue;
        }
        for (const auto& [inner, figure] : value.items()) result[key + " " + inner] = figure;
    }
    return result;
}

std::string line(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& one : cells) text += " " + one + " |";
    return text + "\n";
}

std::string table(const Figures& list) {
    std::vector<Figures> rows;
    std::vector<std::string> columns;
    for (const Figures& row : list) {
        rows.push_back(flat(row));
        for (const auto& [key, value] : rows.back().items())
            if (std::find(columns.begin(), columns.end(), key) == columns.end()) columns.push_back(key);
    }
    std::string text = line(columns) + line(std::vector<std::string>(columns.size(), "---"));
    for (const Figures& row : rows) {
        std::vector<std::string> cells;
        for (const std::string& column : columns) cells.push_back(row.contains(column) ? cell(row[column]) : "-");
        text += line(cells);
    }
    return text;
}

std::string figures_text(const Figures& figures) {
    if (figures.is_array()) return "\n" + table(figures);
    std::string text = "\n", tables;
    for (const auto& [key, value] : figures.items()) {
        if (value.is_array())
            tables += "\n## " + key + "\n\n" + table(value);
        else
            text += "- " + key + ": " + cell(value) + "\n";
    }
    return text + tables;
}

std::string machine_text(const Figures& machine) {
    std::string text;
    for (const auto& [key, value] : machine.items()) {
        if (!text.empty()) text += ", ";
        if (!value.is_array()) {
            text += key + " " + cell(value);
            continue;
        }
        text += key;
        for (const Figures& one : value) text += " " + cell(one);
    }
    return text;
}

}  // namespace

std::string figure_table(const Figures& report) {
    return "Written by `" + cell(report["command"]) + "`.\n\nMachine: " + machine_text(report["machine"]) + ".\n" +
           figures_text(report["figures"]);
}

}  // namespace percale::test
