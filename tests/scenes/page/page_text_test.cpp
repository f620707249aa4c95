#include "scenes/page/page_text.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/support/catch.h"

namespace percale::scenes::test::page_text_test {

namespace {

std::string filled(const std::string& text, const std::map<std::string, std::string>& words) {
    PageParts parts;
    for (const auto& [name, word] : words) parts[name] = [word = word](std::ostream& out) { out << word; };
    std::ostringstream out;
    write_filled(out, text, parts);
    return out.str();
}

}  // namespace

TEST_CASE("JSON in a script neither ends it nor opens another, and means the same") {
    const nlohmann::json json = {{"name", "</script><script>alert(1)</script><!--"}, {"value", 1}};
    const std::string safe = json_for_script(json.dump());
    CHECK(safe.find('<') == std::string::npos);
    CHECK(nlohmann::json::parse(safe) == json);
}

TEST_CASE("A template has its parts in their places, and what they hold is not read as places") {
    CHECK(filled("a {{x}} b {{y}}{{x}}", {{"x", "1"}, {"y", "{{x}}"}}) == "a 1 b {{x}}1");
    CHECK(filled("no place { or }", {}) == "no place { or }");
}

TEST_CASE("A place without a part and a part without a place are errors of the program") {
    CHECK_THROWS_AS(filled("{{x}}", {}), std::logic_error);
    CHECK_THROWS_AS(filled("", {{"x", ""}}), std::logic_error);
    CHECK_THROWS_AS(filled("{{x", {{"x", ""}}), std::logic_error);
}

}  // namespace percale::scenes::test::page_text_test
