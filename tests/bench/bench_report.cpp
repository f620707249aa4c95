#include "tests/bench/bench_report.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "scenes/common/whole_file.h"

namespace percale::test {
namespace {

/// What /proc/cpuinfo calls the first processor.
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
    return __VERSION__;  // says "Clang" itself
#else
    return "g++ " __VERSION__;
#endif
}

void measure_into(const std::string& file, const std::string& program, const std::function<Figures()>& measure) {
    std::optional<scenes::WholeFile> whole;
    if (!file.empty()) whole.emplace(file);  // before hours of measuring
    Figures report{{"program", program}, {"machine", machine_description()}};
    report["figures"] = measure();
    if (!whole) return;
    whole->out() << report.dump(2) << '\n';
    whole->commit();
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
    std::string file;
    app.add_option("--json", file, "also write machine and figures to this file");
    try {
        app.parse(argc, argv);
        measure_into(file, app.get_name(), measure);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
        return 2;
    }
}

}  // namespace percale::test
