#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace percale::test {

using Figures = nlohmann::ordered_json;

/// A report of `run_bench` as Markdown. Its first line names the command, its second paragraph the machine. Every list of rows
/// becomes a table, every figure beside the lists a line. Columns are all keys of the rows, in the order in which they first
/// occur. Numbers have four significant digits; "-" stands where a row has no figure.
std::string figure_table(const Figures& report);

}  // namespace percale::test
