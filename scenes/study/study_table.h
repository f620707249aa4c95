#pragma once

#include <string>

#include "study/study_folder.h"

namespace percale::scenes {

/// What came out of the runs of a study so far.
struct StudyTables {
    std::string csv;  // a line a run: its values, status, measures, expectations; the same bytes wherever and whenever it was run
    std::string costs;                                      // CSV: CPU and wall seconds, steps, memory
    std::string svg;                                        // the measure over the key of the study's plot
    std::size_t done = 0, failed = 0, not_as_expected = 0;  // failed: by any status but finished
};

/// Reads the reports of all runs that are done.
StudyTables study_tables(const Study& study, const StudyFolder& folder);

}  // namespace percale::scenes
