#pragma once

#include <span>
#include <string>
#include <vector>

#include "export/frames.h"
#include "format/expectations.h"
#include "garment/seam_stitches.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// report.json as text: status, counts, costs, energies, measures, expectations, frames and every setting used. SI units; what
/// JSON cannot say (infinity) is null; the order of the entries is fixed.
std::string run_report_text(const BuiltScene& built, const RunResult& result, std::span<const FrameRecord> frames,
                            std::span<const ExpectationResult> expectations);

/// What went wrong in a run besides pinches, whatever is expected: torn and tight cloth, open seams.
std::vector<Finding> end_warnings(const BuiltScene& built, const RunResult& result);

/// All that is found in a run: what its start moved, the warnings of its plan, its pinches, and what went wrong besides.
std::vector<Finding> run_findings(const BuiltScene& built, const RunResult& result);

/// The frames that FOLDER/report.json lists. Throws SceneError naming the file if it is missing or is no report.
std::vector<FrameRecord> read_frame_records(const std::string& folder);
/// The seams that it lists, likewise.
std::vector<ClothStitches> read_seam_records(const std::string& folder);
/// The whole report, in one line. Throws likewise.
std::string read_report_text(const std::string& folder);

}  // namespace percale::scenes
