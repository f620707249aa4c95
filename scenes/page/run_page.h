#pragma once

#include <cstddef>
#include <string>

namespace percale::scenes {

struct PageOptions {
    double max_megabytes = 50.0;  // of the file: frames are left out where they would take more
    bool distances = true;        // PlaybackOptions::distances
};

/// What was written.
struct PageSummary {
    std::size_t bytes = 0;
    int frames = 0, shown = 0, every = 1;  // of the run, in the page, and every how many
};

/// The range of PageOptions::max_megabytes: the first holds the page's own scripts, and browsers take no longer texts than the
/// second.
inline constexpr double min_page_megabytes = 2.0, largest_page_megabytes = 500.0;

/// Throws SceneError, beginning with `asked`, where this build has no three.js and so no pages.
void check_pages(const std::string& asked);

/// Writes the page of a run's folder, a whole HTML file or none, which needs nothing besides itself. Throws SceneError naming the
/// file of the run that is missing or broken, or the page where it cannot be written; and for options out of their range.
PageSummary write_run_page(const std::string& folder, const std::string& file, const PageOptions& options = {});

/// "out/report.html: 31 frames, 2.1 MB", and how many frames are left out.
std::string page_summary_text(const std::string& file, const PageSummary& page);

}  // namespace percale::scenes
