#pragma once

#include <string>
#include <vector>

#include "page/playback.h"
#include "page/step_series.h"

namespace percale::scenes {

/// What a page shows.
struct PageData {
    std::string report;  // report.json, JSON
    std::vector<FrameRecord> records;
    StepSeries steps;
    Playback playback;
};

/// What report.json says that its frames are of: the names of the settings where they are as many as the files, else those of the
/// files.
RunCast cast_of_report(const std::string& report, const FrameRecord& first);

/// The frame with the smallest distance by the report; -1 where it names none of `frames`.
int worst_frame_of_report(const std::string& report, int frames);

/// The title of a run, or its scene's name, or "run".
std::string title_of_report(const std::string& report);

/// Packed numbers of a page, each an element of its own: id and base64.
struct PageBlob {
    std::string id;
    const std::string& text;
};
std::vector<PageBlob> page_blobs(const Playback& playback);

/// All but the packed numbers, as JSON (README.md of this room); what is not finite is null.
std::string page_json(const PageData& data);

}  // namespace percale::scenes
