#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "tests/bench/figure_table.h"

namespace percale::test {

/// Parses the command line (with --json FILE and -o FILE beside the options of `app`), measures, and writes the figures with
/// command and machine to the files named: as JSON, and as a Markdown table. Nothing is written when measuring failed. Returns
/// the exit code: 0, 2 for wrong input.
int run_bench(CLI::App& app, int argc, char** argv, const std::function<Figures()>& measure);

/// Processor, number of cores, load average, compiler, flags and version of the library.
Figures machine_description();

}  // namespace percale::test
