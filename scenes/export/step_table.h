#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "percale/report.h"
#include "whole_file.h"

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
    /// Throws SceneError if what was written until now could not be.
    void add(const StepReport& report, std::optional<std::uint64_t> state_hash);
    void finish() { file_.commit(); }

private:
    WholeFile file_;
};

}  // namespace percale::scenes
