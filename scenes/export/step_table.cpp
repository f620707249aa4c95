#include "export/step_table.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "common/text.h"

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

StepTable::StepTable(const std::string& file) : file_(file) { file_.out() << step_table_header() << '\n'; }

void StepTable::add(const StepReport& report, std::optional<std::uint64_t> state_hash) {
    errno = 0;
    file_.out() << step_table_line(report, state_hash) << '\n';
    file_.check();
}

}  // namespace percale::scenes
