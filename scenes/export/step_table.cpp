#include "export/step_table.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "common/input_file.h"
#include "common/text.h"
#include "percale/error.h"
#include "report/csv.h"

namespace percale::scenes {

std::string step_table_header() {
    return "time,dt,newton,linear,residual,contacts,smallest_distance,energy,status,contact_hash,state_hash,dropped";
}

std::string step_table_line(const StepReport& report, std::optional<std::uint64_t> state_hash) {
    char text[256];
    std::snprintf(text, sizeof text, "%.17g,%.17g,%d,%d,%.17g,%d,%.17g,%.17g,%s,", report.time, report.dt,
                  report.newton_iterations, report.linear_iterations, report.residual, report.contacts, report.smallest_distance,
                  report.energy.total(), status_word(report.status));
    std::string dropped = report.dropped.text();
    std::replace(dropped.begin(), dropped.end(), ',', ';');
    return text + hexadecimal(report.contact_hash) + "," + (state_hash ? hexadecimal(*state_hash) : "") + "," + dropped;
}

std::size_t StepRows::column(const std::string& name) const {
    if (const std::optional<std::size_t> found = csv_column(header, name)) return *found;
    throw SceneError(file + ":1: is no table of steps: it has no column '" + name + "'");
}

StepRows read_step_rows(const std::string& file, const std::string& advice) {
    std::ifstream in = open_input(file);
    std::string line;
    if (!in || !std::getline(in, line)) throw SceneError(file + ": cannot be read; " + advice);
    StepRows rows{.file = file, .header = csv_cells(line), .lines = {}};
    while (std::getline(in, line) && !in.eof()) {
        rows.lines.push_back(csv_cells(line));
        const std::size_t number = rows.lines.size() + 1, cells = rows.lines.back().size();
        if (cells != rows.header.size())
            throw SceneError(file + ":" + std::to_string(number) + ": has " + std::to_string(cells) + " columns, not " +
                             std::to_string(rows.header.size()));
    }
    return rows;
}

StepTable::StepTable(const std::string& file) : file_(file) { file_.out() << step_table_header() << '\n'; }

void StepTable::add(const StepReport& report, std::optional<std::uint64_t> state_hash) {
    errno = 0;
    file_.out() << step_table_line(report, state_hash) << '\n';
    file_.check();
}

}  // namespace percale::scenes
