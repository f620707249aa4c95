#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>

namespace percale::test {

using Figures = nlohmann::ordered_json;

/// Parses the command line (with --json FILE beside what `app` has), measures, and writes the figures with a description of the
/// machine to FILE, if one was named; nothing is written when measuring failed. Returns the exit code: 0, 2 for wrong input.
int run_bench(CLI::App& app, int argc, char** argv, const std::function<Figures()>& measure);

/// Processor, number of cores, load average, compiler, flags and version of the library.
Figures machine_description();

}  // namespace percale::test
