#include "export/junit.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::junit_test {
namespace {

ExpectationResult expectation(const std::string& measure, bool passed) {
    ExpectationResult result;
    result.expectation.measure = measure;
    result.passed = passed;
    result.text = measure + " 0.12, expected < 0.3: " + (passed ? "passed" : "failed");
    return result;
}

CheckedScene scene(const std::string& file, std::vector<ExpectationResult> expectations) {
    CheckedScene checked;
    checked.file = file;
    checked.wall_s = 1.5;
    checked.expectations = std::move(expectations);
    return checked;
}

int occurrences(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

}  // namespace

TEST_CASE("a scene counts its expectations, an error and an unfinished run as one failure each") {
    CheckedScene checked = scene("a.toml", {expectation("x", true), expectation("y", false), expectation("z", true)});
    CHECK(checked.passed() == 2);
    CHECK(checked.failed() == 1);
    checked.reason = "a pin was blocked";
    CHECK(checked.failed() == 2);
    CheckedScene wrong;
    wrong.error = "no such file";
    CHECK(wrong.passed() == 0);
    CHECK(wrong.failed() == 1);
}

TEST_CASE("a passed scene has a case for the run and one an expectation, none of them failed") {
    const std::vector<CheckedScene> scenes = {
        scene("a.toml", {expectation("speed_at_end", true), expectation("energy_gain", true)})};
    const std::string text = junit_text(scenes);
    CHECK(occurrences(text, "<testcase ") == 3);
    CHECK(occurrences(text, "<failure ") == 0);
    CHECK(text.find("tests=\"3\" failures=\"0\" errors=\"0\" time=\"1.5\"") != std::string::npos);
}

TEST_CASE("failures and errors carry their texts") {
    CheckedScene unfinished = scene("b.toml", {expectation("speed_at_end", false)});
    unfinished.reason = "a pin was blocked";
    CheckedScene wrong;
    wrong.file = "c.toml";
    wrong.error = "c.toml:3:1: unknown key";
    const std::vector<CheckedScene> scenes = {unfinished, wrong};
    const std::string text = junit_text(scenes);
    CHECK(occurrences(text, "<testsuite ") == 2);
    CHECK(text.find("tests=\"2\" failures=\"2\" errors=\"0\"") != std::string::npos);
    CHECK(text.find("tests=\"1\" failures=\"0\" errors=\"1\"") != std::string::npos);
    CHECK(text.find("<failure message=\"a pin was blocked\"/>") != std::string::npos);
    CHECK(text.find("<failure message=\"speed_at_end 0.12, expected &lt; 0.3: failed\"/>") != std::string::npos);
    CHECK(text.find("<error message=\"c.toml:3:1: unknown key\"/>") != std::string::npos);
}

TEST_CASE("no text of ours can break the document") {
    CheckedScene checked = scene("<a> & \"b\" 'c'.toml", {});
    checked.reason = std::string("bell \a and\nnew line");
    const std::string text = junit_text(std::vector<CheckedScene>{checked});
    CHECK(text.find("name=\"&lt;a&gt; &amp; &quot;b&quot; &apos;c&apos;.toml\"") != std::string::npos);
    CHECK(text.find('\a') == std::string::npos);
    CHECK(occurrences(text, "<") == occurrences(text, ">"));
    CHECK(occurrences(text, "<testsuite ") == occurrences(text, "</testsuite>"));
}

TEST_CASE("no scenes make an empty but whole document") {
    const std::string text = junit_text({});
    CHECK(text.find("<testsuites>\n</testsuites>\n") != std::string::npos);
}

}  // namespace percale::scenes::test::junit_test
