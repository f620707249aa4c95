#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/whole_file.h"
#include "percale/report.h"

namespace percale::scenes {

/// The first line of a step table, without its end.
std::string step_table_header();

/// One line, without its end. Times in s, distance in m, energy (total) in J, 17 digits; an infinite distance is written as
/// `inf`, an energy that was not measured as `nan`, hashes as 16 hexadecimal digits, an absent state hash as nothing.
std::string step_table_line(const StepReport& report, std::optional<std::uint64_t> state_hash);

/// A table of steps as it lies on the disk, cell by cell.
struct StepRows {
    std::string file;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> lines;  // the first is line 2 of the file

    /// Where a column stands. Throws SceneError where there is none of that name.
    std::size_t column(const std::string& name) const;
};

/// Throws SceneError naming the file where it cannot be read, with `advice`, and where a line has other than the header's count
/// of cells. A last line without its end, as a run that was killed leaves, is not there.
StepRows read_step_rows(const std::string& file, const std::string& advice);

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
