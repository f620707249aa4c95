#include "scenes/common/finding.h"

#include "scenes/common/finding_json.h"
#include "scenes/common/scene_file_error.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::finding_test {

TEST_CASE("a refusal is a finding at the place of its error") {
    const SceneFileError error({.file = "a.toml", .line = 3, .column = 5}, "gravity: too large");
    const Finding finding = refusal("refused", error, "a.toml", "make it smaller");
    CHECK(finding.severity == Severity::error);
    CHECK(finding.kind == "refused");
    CHECK(finding.place == "a.toml:3:5");
    CHECK(finding.what == "gravity: too large");
    CHECK(finding.fix == "make it smaller");
}

TEST_CASE("an error about the file itself does not say it twice") {
    const Finding finding = refusal("unreadable", SceneError("a.obj", "no vertices"), "a.obj", "");
    CHECK(finding.place == "a.obj");
    CHECK(finding.what == "no vertices");
}

TEST_CASE("an error that is not inside the file is reported of the whole file") {
    const SceneFileError elsewhere({.file = "b.toml", .line = 3, .column = 5}, "other");
    const SceneError plain("no such thing"), named("flag", "torn");
    for (const SceneError* error : {static_cast<const SceneError*>(&elsewhere), &plain, &named}) {
        const Finding finding = refusal("start", *error, "a.toml", "");
        CHECK(finding.place == "a.toml");
        CHECK(finding.what == error->what());
    }
}

TEST_CASE("severities and uses of a mesh have words of their own") {
    CHECK(std::string(severity_word(Severity::note)) == "note");
    CHECK(std::string(severity_word(Severity::warning)) == "warning");
    CHECK(std::string(severity_word(Severity::error)) == "error");
    CHECK(std::string(role_word(MeshRole::cloth)) == "cloth");
    CHECK(std::string(role_word(MeshRole::obstacle)) == "obstacle");
}

TEST_CASE("a finding is one line with what mends it, a warning if nothing else is said; a note has no severity there") {
    const Finding fixed{.kind = "loose", .place = "a.toml:3:1", .what = "it is loose", .fix = "pin it"};
    CHECK(finding_text(fixed) == "it is loose; pin it");
    CHECK(finding_line(fixed) == "warning: it is loose; pin it");
    CHECK(finding_line({.severity = Severity::note, .kind = "loose", .what = "it is loose"}) == "it is loose");
    CHECK(finding_texts(std::vector{fixed, Finding{.what = "torn"}}) == std::vector<std::string>{"it is loose; pin it", "torn"});
}

TEST_CASE("findings in JSON have severity, kind, place, what and fix, alone and in a list") {
    const Finding finding{.kind = "loose", .place = "a.toml:3:1", .what = "it is loose", .fix = "pin it"};
    const nlohmann::ordered_json json = finding, list = std::vector<Finding>(2, finding);
    CHECK(json.dump() == R"({"severity":"warning","kind":"loose","place":"a.toml:3:1","what":"it is loose","fix":"pin it"})");
    CHECK(list == nlohmann::ordered_json::array({json, json}));
}

}  // namespace percale::scenes::test::finding_test
