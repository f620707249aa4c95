#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/whole_file.h"
#include "percale/report.h"

namespace percale::scenes {

/// The first line of a step table, without its end.
std::string step_table_header();

/// One line, without its end. Times in s, distance in m, energy (total) in J, 17 digits; an infinite distance is written as
/// `inf`, an energy that was not measured as `nan`, hashes as 16 hexadecimal digits, an absent state hash as nothing.
std::string step_table_line(const StepReport& report, std::optional<std::uint64_t> state_hash);

/// steps.csv: one line a step, a failed one included.
class StepTable {
public:
    explicit StepTable(const std::string& file);
    /// Continues after the first `bytes` of another table, or of this one where it was left.
    StepTable(const std::string& file, const std::string& source, std::uint64_t bytes) : file_(file, source, bytes) {}
    /// Throws SceneError if a line so far could not be written.
    void add(const StepReport& report, std::optional<std::uint64_t> state_hash);
    void finish() { file_.commit(); }
    /// Flushes all lines to the disk; returns their length in bytes.
    std::uint64_t sync() { return file_.sync(); }
    /// Lets the unfinished table stay under its temporary name.
    void leave() { file_.leave(); }

private:
    WholeFile file_;
};

}  // namespace percale::scenes
