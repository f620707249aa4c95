#include "scenes/doctor/finding.h"

#include "tests/support/catch.h"

using namespace percale;
using namespace percale::scenes;

TEST_CASE("a refusal takes the place in the file off the front of the message") {
    const Finding finding = refusal("refused", "a.toml:3:5: gravity: too large", "a.toml", "make it smaller");
    CHECK(finding.severity == Severity::error);
    CHECK(finding.kind == "refused");
    CHECK(finding.place == "a.toml:3:5");
    CHECK(finding.what == "gravity: too large");
    CHECK(finding.fix == "make it smaller");
}

TEST_CASE("a message without the file in front is told of the whole file") {
    for (const char* message : {"no such thing", "b.toml:3:5: other", "a.toml:3"}) {
        const Finding finding = refusal("start", message, "a.toml", "");
        CHECK(finding.place == "a.toml");
        CHECK(finding.what == message);
    }
}

TEST_CASE("severities and uses of a mesh have words of their own") {
    CHECK(std::string(severity_word(Severity::note)) == "note");
    CHECK(std::string(severity_word(Severity::warning)) == "warning");
    CHECK(std::string(severity_word(Severity::error)) == "error");
    CHECK(std::string(role_word(MeshRole::cloth)) == "cloth");
    CHECK(std::string(role_word(MeshRole::obstacle)) == "obstacle");
}
