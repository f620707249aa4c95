#include "export/junit.h"

#include <algorithm>

#include "common/text.h"

namespace percale::scenes {

int CheckedScene::passed() const {
    return static_cast<int>(
        std::count_if(expectations.begin(), expectations.end(), [](const ExpectationResult& result) { return result.passed; }));
}

int CheckedScene::failed() const {
    return static_cast<int>(expectations.size()) - passed() + (error.empty() ? 0 : 1) + (reason.empty() ? 0 : 1);
}

namespace {

/// XML 1.0 text: the five reserved characters as entities; control characters, which XML cannot hold at all, as question marks.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        const bool control = static_cast<unsigned char>(letter) < 0x20 && letter != '\n' && letter != '\t';
        switch (letter) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&apos;";
                break;
            default:
                result += control ? '?' : letter;
        }
    }
    return result;
}

/// `outcome`: "" for passed, else the element's name, failure or error.
std::string case_element(const std::string& scene, const std::string& name, const std::string& outcome, const std::string& text) {
    const std::string open = "    <testcase classname=\"" + escaped(scene) + "\" name=\"" + escaped(name) + "\"";
    if (outcome.empty()) return open + "/>\n";
    return open + "><" + outcome + " message=\"" + escaped(text) + "\"/></testcase>\n";
}

std::string suite_element(const CheckedScene& scene) {
    const int errors = scene.error.empty() ? 0 : 1;
    std::string text = "  <testsuite name=\"" + escaped(scene.file) + "\" tests=\"" +
                       std::to_string(scene.expectations.size() + 1) + "\" failures=\"" +
                       std::to_string(scene.failed() - errors) + "\" errors=\"" + std::to_string(errors) + "\" time=\"" +
                       number_text(scene.wall_s) + "\">\n";
    const std::string outcome = errors > 0 ? "error" : scene.reason.empty() ? "" : "failure";
    text += case_element(scene.file, "run", outcome, errors > 0 ? scene.error : scene.reason);
    for (const ExpectationResult& result : scene.expectations)
        text += case_element(scene.file, result.expectation.measure + when_text(result.expectation),
                             result.passed ? "" : "failure", result.text);
    return text + "  </testsuite>\n";
}

}  // namespace

std::string junit_text(std::span<const CheckedScene> scenes) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
    for (const CheckedScene& scene : scenes) text += suite_element(scene);
    return text + "</testsuites>\n";
}

}  // namespace percale::scenes
