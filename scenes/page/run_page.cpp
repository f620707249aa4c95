#include "page/run_page.h"

#include <filesystem>
#include <ostream>
#include <sstream>
#include <system_error>

#include "common/text.h"
#include "common/whole_file.h"
#include "export/run_report.h"
#include "page/page_data.h"
#include "page/page_parts.h"
#include "page/page_text.h"
#include "percale/error.h"
#include "report/svg_text.h"

namespace percale::scenes {

namespace {

/// Points of a diagram: more are closer than the pixels of a screen.
constexpr int max_step_groups = 2000;

PageParts constant_parts(const std::string& title) {
    const auto text = [](std::string_view part) { return [part](std::ostream& out) { out << part; }; };
    return {{"title", [title](std::ostream& out) { out << svg_escaped(title); }},
            {"style", text(page_style())},
            {"script", text(page_script())},
            {"three", text(three_library())},
            {"controls", text(three_controls())}};
}

void write_blobs(std::ostream& out, const Playback& playback) {
    for (const PageBlob& blob : page_blobs(playback))
        out << "<script type=\"text/plain\" id=\"" << blob.id << "\">" << blob.text << "</script>\n";
}

/// How much of a page of so many megabytes is left for frames.
std::size_t bytes_for_frames(double max_megabytes, const PageData& without_frames) {
    std::size_t taken = page_json(without_frames).size();
    for (const std::string_view part : {page_template(), page_style(), page_script(), three_library(), three_controls()})
        taken += part.size();
    const auto max = static_cast<std::size_t>(1e6 * max_megabytes);
    return max > taken ? max - taken : 0;
}

void check_page_options(const PageOptions& options) {
    if (options.max_megabytes >= min_page_megabytes && options.max_megabytes <= largest_page_megabytes) return;
    throw SceneError("--most-megabytes " + number_text(options.max_megabytes) + ": must be " + number_text(min_page_megabytes) +
                     " ... " + number_text(largest_page_megabytes) + " MB");
}

PageData read_page_data(const std::string& folder, const PageOptions& options) {
    PageData data;
    data.report = read_report_text(folder);
    data.records = read_frame_records(folder);
    data.steps = read_step_series(folder, max_step_groups);
    if (data.records.empty()) return data;
    const PlaybackOptions playback{.max_bytes = bytes_for_frames(options.max_megabytes, data),
                                   .distances = options.distances,
                                   .worst_frame = worst_frame_of_report(data.report, static_cast<int>(data.records.size()))};
    data.playback = read_playback(folder, data.records, cast_of_report(data.report, data.records.front()), playback);
    return data;
}

}  // namespace

void check_pages(const std::string& asked) {
    if (!three_library().empty()) return;
    throw SceneError(asked +
                     ": this build writes no pages, as three.js r111 (Debian's package libjs-three) was not found when it "
                     "was configured");
}

PageSummary write_run_page(const std::string& folder, const std::string& file, const PageOptions& options) {
    check_pages(file);
    check_page_options(options);
    const PageData data = read_page_data(folder, options);
    PageParts parts = constant_parts(title_of_report(data.report));
    parts["data"] = [&](std::ostream& out) { out << json_for_script(page_json(data)); };
    parts["blobs"] = [&](std::ostream& out) { write_blobs(out, data.playback); };
    WholeFile page(file);
    write_filled(page.out(), page_template(), parts);
    page.commit();
    std::error_code error;
    return {.bytes = static_cast<std::size_t>(std::filesystem::file_size(file, error)),
            .frames = static_cast<int>(data.records.size()),
            .shown = static_cast<int>(data.playback.choice.shown.size()),
            .every = data.playback.choice.every};
}

std::string page_summary_text(const std::string& file, const PageSummary& page) {
    std::string text = file + ": ";
    if (page.shown == 0)
        text += "no frames";
    else if (page.shown == page.frames)
        text += counted(page.frames, "frame");
    else
        text += std::to_string(page.shown) + " of " + counted(page.frames, "frame") + ", one in " + std::to_string(page.every);
    return text + ", " + short_number(1e-6 * static_cast<double>(page.bytes)) + " MB";
}

}  // namespace percale::scenes
