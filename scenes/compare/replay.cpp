#include "compare/replay.h"

#include <algorithm>
#include <filesystem>

#include "common/whole_file.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

constexpr const char* compared_columns[] = {"time", "status", "contact_hash", "state_hash"};

std::string table_of(const std::string& run) {
    namespace fs = std::filesystem;
    if (!fs::is_directory(run)) return run;
    const std::string whole = run + "/steps.csv", part = whole + part_suffix;
    return !fs::exists(whole) && fs::exists(part) ? part : whole;
}

}  // namespace

StepRows read_hashed_steps(const std::string& run) {
    StepRows rows = read_step_rows(table_of(run), "`percale run --replay-hash` writes it");
    for (const char* name : compared_columns) rows.column(name);  // has them all
    const auto is_bare = [state = rows.column("state_hash")](const auto& cells) { return cells[state].empty(); };
    const auto bare = std::ranges::find_if(rows.lines, is_bare);
    if (bare == rows.lines.end()) return rows;
    throw SceneError(rows.file + ":" + std::to_string(bare - rows.lines.begin() + 2) +
                     ": has no state_hash; run the scene with --replay-hash");
}

ReplayDifference compare_steps(const StepRows& first, const StepRows& second) {
    const std::size_t both = std::min(first.lines.size(), second.lines.size());
    for (std::size_t n = 0; n < both; ++n) {
        for (const char* name : compared_columns) {
            const std::string &one = first.lines[n][first.column(name)], &other = second.lines[n][second.column(name)];
            if (one != other) return {n + 1, first.lines[n][first.column("time")], name, one, other, both};
        }
    }
    return {.steps_of_both = both};
}

}  // namespace percale::scenes
