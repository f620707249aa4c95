#include "tests/bench/bench_report.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "scenes/common/whole_file.h"
#include "tests/bench/figure_table.h"

namespace percale::test {
namespace {

/// The name of the first processor in /proc/cpuinfo.
std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::string compiler() {
#ifdef __clang__
    return __VERSION__;  // contains "Clang" itself
#else
    return "g++ " __VERSION__;
#endif
}

/// Requested output files; empty: none.
struct WantedFiles {
    std::string json, table;
};

/// The command line as a user types it: the program without its folder.
std::string command_line(int argc, char** argv) {
    std::string text = std::filesystem::path(argv[0]).filename().string();
    for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
    return text;
}

/// Begins the file before hours of measuring, so that one that cannot be written is known at once.
void begin(std::optional<scenes::WholeFile>& whole, const std::string& file) {
    if (!file.empty()) whole.emplace(file);
}

void finish(std::optional<scenes::WholeFile>& whole, const std::string& text) {
    if (!whole) return;
    whole->out() << text;
    whole->commit();
}

void measure_into(const WantedFiles& files, Figures report, const std::function<Figures()>& measure) {
    std::optional<scenes::WholeFile> json, table;
    begin(json, files.json);
    begin(table, files.table);
    report["figures"] = measure();
    finish(json, report.dump(2) + '\n');
    finish(table, figure_table(report));
}

}  // namespace

Figures machine_description() {
    double load[3] = {0.0, 0.0, 0.0};
    const int loads = getloadavg(load, 3);
    Figures machine{{"processor", processor()},
                    {"cores", std::thread::hardware_concurrency()},
                    {"compiler", compiler()},
                    {"flags", PERCALE_BENCH_FLAGS},
                    {"percale", PERCALE_VERSION}};
    if (loads == 3) machine["load_average"] = {load[0], load[1], load[2]};
    return machine;
}

int run_bench(CLI::App& app, int argc, char** argv, const std::function<Figures()>& measure) {
    WantedFiles files;
    app.add_option("--json", files.json, "also write machine and figures to this file");
    app.add_option("-o", files.table, "also write the figures as a Markdown table to this file");
    try {
        app.parse(argc, argv);
        measure_into(files,
                     {{"program", app.get_name()}, {"command", command_line(argc, argv)}, {"machine", machine_description()}},
                     measure);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
        return 2;
    }
}

}  // namespace percale::test
