#include "compare/replay.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "common/input_file.h"
#include "common/whole_file.h"
#include "percale/error.h"
#include "report/csv.h"

namespace percale::scenes {

namespace {

/// The number of a column.
std::size_t column(const std::vector<std::string>& header, const std::string& name, const std::string& file) {
    if (const std::optional<std::size_t> found = csv_column(header, name)) return *found;
    throw SceneError(file + ":1: is no table of steps: it has no column '" + name + "'");
}

std::string table_of(const std::string& run) {
    namespace fs = std::filesystem;
    if (!fs::is_directory(run)) return run;
    const std::string whole = run + "/steps.csv", part = whole + part_suffix;
    return !fs::exists(whole) && fs::exists(part) ? part : whole;
}

}  // namespace

std::vector<StepHashes> read_step_hashes(const std::string& run) {
    const std::string file = table_of(run);
    std::ifstream in = open_input(file);
    std::string line;
    if (!in || !std::getline(in, line)) throw SceneError(file + ": cannot be read; `percale run --replay-hash` writes it");
    const std::vector<std::string> header = csv_cells(line);
    const std::size_t time = column(header, "time", file), status = column(header, "status", file),
                      contacts = column(header, "contact_hash", file), state = column(header, "state_hash", file);
    std::vector<StepHashes> steps;
    while (std::getline(in, line)) {
        // The last line of a run that was killed may be cut off.
        if (in.eof()) break;
        const std::vector<std::string> cells = csv_cells(line);
        const std::string place = file + ":" + std::to_string(steps.size() + 2);
        if (cells.size() != header.size())
            throw SceneError(place + ": has " + std::to_string(cells.size()) + " columns, not " + std::to_string(header.size()));
        if (cells[state].empty()) throw SceneError(place + ": has no state_hash; run the scene with --replay-hash");
        steps.push_back({cells[time], cells[status], cells[contacts], cells[state]});
    }
    return steps;
}

ReplayDifference compare_steps(const std::vector<StepHashes>& first, const std::vector<StepHashes>& second) {
    ReplayDifference difference;
    difference.steps_of_both = std::min(first.size(), second.size());
    for (std::size_t n = 0; n < difference.steps_of_both; ++n) {
        const StepHashes &a = first[n], &b = second[n];
        const auto set = [&](const char* what, const std::string& one, const std::string& other) {
            if (difference.step != 0 || one == other) return;
            difference.step = n + 1;
            difference.what = what;
            difference.first = one;
            difference.second = other;
        };
        set("time", a.time, b.time);
        set("status", a.status, b.status);
        set("contact_hash", a.contacts, b.contacts);
        set("state_hash", a.state, b.state);
        if (difference.step != 0) break;
    }
    return difference;
}

}  // namespace percale::scenes
