#include "scenes/page/run_page.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "scenes/page/page_parts.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/page/written_run.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/skip.h"

namespace percale::scenes::test::run_page_test {

namespace {

/// Whether this build has pages; a test without them says so.
bool has_pages() {
    if (!three_library().empty()) return true;
    percale::test::skip("this build has no three.js (libjs-three)");
    return false;
}

int times_in(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
    return count;
}

nlohmann::json data_of(const std::string& page) {
    const std::string opening = "<script type=\"application/json\" id=\"data\">";
    const std::size_t start = page.find(opening) + opening.size();
    return nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::string refused_page(const TestFolder& folder, const PageOptions& options = {}) {
    const std::string message = message_of([&] { write_run_page(folder.path("run"), folder.path("page.html"), options); });
    CHECK_FALSE(folder.holds("page.html"));
    CHECK_FALSE(folder.holds("page.html.part"));
    return message;
}

}  // namespace

TEST_CASE("The page of a run is one file that asks for nothing and holds report, steps and frames") {
    if (!has_pages()) return;
    const TestFolder folder;
    write_run(folder.path("run"), sheet_on_box());
    const PageSummary summary = write_run_page(folder.path("run"), folder.path("run/report.html"));
    const std::string page = folder.read("run/report.html");
    CHECK(summary.bytes == page.size());
    CHECK(summary.frames == 7);
    CHECK(summary.shown == 7);
    CHECK(page.starts_with(page_mark));
    CHECK(page.find("<title>sheet on a box</title>") != std::string::npos);
    for (const char* outside : {" src=", "<link rel=\"stylesheet", "@import", "url(http"})
        CHECK(page.find(outside) == std::string::npos);
    CHECK(page.find("Content-Security-Policy\" content=\"default-src 'none'") != std::string::npos);
    CHECK(page.find("three.js authors") != std::string::npos);
    CHECK(page.find("{{") == std::string::npos);
    const nlohmann::json data = data_of(page);
    CHECK(data["report"]["status"] == "finished");
    CHECK(data["steps"]["steps"] == 12);
    CHECK(data["frames"].size() == 7);
    REQUIRE(data["meshes"].size() == 2);
    for (const auto& mesh : data["meshes"])
        CHECK(page.find("id=\"" + mesh["positions"].get<std::string>() + "\">") != std::string::npos);
}

TEST_CASE("What a scene calls itself and its cloth is text in the page, whatever it holds") {
    if (!has_pages()) return;
    const TestFolder folder;
    std::string scene = sheet_on_box();
    scene.replace(scene.find("title = \"sheet on a box\""), 24, "title = \"</title><script>alert(1)</script>\"");
    write_run(folder.path("run"), scene, {{"output.frames", "\"none\""}});
    // Scenes may not name cloth like this, but reports are files that anybody may have written.
    std::string report = folder.read("run/report.json");
    report.replace(report.find("\"name\": \"sheet\""), 15, "\"name\": \"<script>x\"");
    folder.write("run/report.json", report);
    write_run_page(folder.path("run"), folder.path("page.html"));
    const std::string page = folder.read("page.html");
    CHECK(page.find("<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt;</title>") != std::string::npos);
    CHECK(page.find("<script>alert") == std::string::npos);
    CHECK(page.find("<script>x") == std::string::npos);
    CHECK(times_in(page, "<script") == times_in(page, "</script>"));
    CHECK(data_of(page)["report"]["settings"]["cloth"][0]["name"] == "<script>x");
    CHECK(data_of(page)["meshes"].empty());
}

TEST_CASE("A page keeps to its size by leaving frames out, and says so", "[slow]") {
    if (!has_pages()) return;
    const TestFolder folder;
    write_run(folder.path("run"), sheet_on_box(),
              {{"output.fps", "240"}, {"cloth.sheet.grid.vertices", "[40, 40]"}, {"step.time_step", "0.004166666666666667"}});
    const PageSummary all = write_run_page(folder.path("run"), folder.path("all.html"));
    CHECK(all.every == 1);
    CHECK(all.bytes > 2'000'000);
    const PageSummary some = write_run_page(folder.path("run"), folder.path("some.html"), {.max_megabytes = 2.0});
    CHECK(some.bytes <= 2'000'000);
    CHECK(some.every > 1);
    CHECK(some.shown < all.shown);
    CHECK(data_of(folder.read("some.html"))["every"] == some.every);
    CHECK(page_summary_text("p.html", some).find("p.html: " + std::to_string(some.shown) + " of 49 frames, one in ") == 0);
}

TEST_CASE("A folder that is no run, or a broken one, leaves no page and one message that names the file") {
    if (!has_pages()) return;
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("run"));
    CHECK(refused_page(folder).find("run/report.json: cannot be read") != std::string::npos);
    folder.write("run/report.json", "{\"frames\": [");
    CHECK(refused_page(folder).find("run/report.json: is not the report of a run: it is no JSON") != std::string::npos);
    for (const char* other : {"[]", "{}", "{\"frames\": [{}]}", "3", "{\"frames\": 1}"}) {
        folder.write("run/report.json", other);
        INFO(other);
        CHECK(refused_page(folder).find("run/report.json: is not the report of a run") != std::string::npos);
    }
    std::filesystem::remove_all(folder.path("run"));
    write_run(folder.path("run"), sheet_on_box());
    std::filesystem::remove(folder.path("run/frames/sheet_00003.obj"));
    CHECK(refused_page(folder).find("run/frames/sheet_00003.obj: is missing") != std::string::npos);
    std::filesystem::remove(folder.path("run/steps.csv"));
    CHECK(refused_page(folder).find("run/steps.csv: cannot be read") != std::string::npos);
    CHECK(refused_page(folder, {.max_megabytes = 1.0}) == "--most-megabytes 1: must be 2 ... 500 MB");
}

TEST_CASE("A page that cannot be written is one message and no file") {
    if (!has_pages()) return;
    const TestFolder folder;
    write_run(folder.path("run"), sheet_on_box(), {{"output.frames", "\"none\""}});
    const std::string message = message_of([&] { write_run_page(folder.path("run"), folder.path("absent/page.html")); });
    CHECK(message.find("absent/page.html: cannot be written") != std::string::npos);
}

TEST_CASE("The template of pages begins with the mark by which a later run knows its page") {
    CHECK(page_template().starts_with(page_mark));
    CHECK(page_script().find("</script") == std::string::npos);
    CHECK(page_style().find("</style") == std::string::npos);
}

TEST_CASE("A build without three.js says so, and one with it has the revision the page was made for") {
    const std::string message = message_of([] { check_pages("percale report"); });
    if (three_library().empty()) {
        CHECK(message.find("percale report: this build writes no pages, as three.js r111") == 0);
    } else {
        CHECK(message.empty());
        CHECK(three_library().find("REVISION=\"111\"") != std::string::npos);
        CHECK(three_controls().find("OrbitControls") != std::string::npos);
        CHECK(three_library().find("</script") == std::string::npos);
    }
}

}  // namespace percale::scenes::test::run_page_test
