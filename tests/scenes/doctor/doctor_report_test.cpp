#include "doctor/doctor_report.h"

#include <nlohmann/json.hpp>

#include "tests/support/catch.h"

namespace percale::scenes::test::doctor_report_test {
namespace {

Diagnosis sick() {
    return {
        .file = "body.obj",
        .findings = {{.severity = Severity::error,
                      .kind = "flat_triangles",
                      .role = MeshRole::cloth,
                      .place = "body.obj",
                      .what = "2 triangles without area: 3, 8",
                      .fix = "delete them",
                      .count = 2,
                      .elements = {3, 8}},
                     {.severity = Severity::note, .kind = "parts", .place = "a.toml:3:1", .what = "two parts", .fix = "sew"}}};
}

}  // namespace

TEST_CASE("a diagnosis as text has place, severity, use, cause and fix of every finding, and the sums") {
    CHECK(diagnosis_text(sick()) ==
          "body.obj: error: as cloth: 2 triangles without area: 3, 8\n"
          "    fix: delete them\n"
          "a.toml:3:1: note: two parts\n"
          "    fix: sew\n"
          "body.obj: 1 error, 0 warnings, 1 note\n");
    CHECK(diagnosis_text({.file = "well.obj", .findings = {}}) == "well.obj: nothing found\n");
}

TEST_CASE("a diagnosis in one line has the sums and the worst") {
    CHECK(diagnosis_line(sick()) == "body.obj: 1 error, 0 warnings, 1 note; as cloth: 2 triangles without area: 3, 8\n");
    CHECK(diagnosis_line({.file = "well.obj", .findings = {}}) == "well.obj: nothing found\n");
}

TEST_CASE("diagnoses as JSON say the same") {
    const std::vector<Diagnosis> all = {sick(), {.file = "well.obj", .findings = {}}};
    const auto json = nlohmann::json::parse(diagnoses_json(all)).at("files");
    REQUIRE(json.size() == 2);
    CHECK(json[0].at("file") == "body.obj");
    CHECK(json[0].at("errors") == 1);
    CHECK(json[0].at("warnings") == 0);
    CHECK(json[0].at("notes") == 1);
    const auto& first = json[0].at("findings").at(0);
    CHECK(first.at("severity") == "error");
    CHECK(first.at("kind") == "flat_triangles");
    CHECK(first.at("as") == "cloth");
    CHECK(first.at("count") == 2);
    CHECK(first.at("elements") == nlohmann::json::array({3, 8}));
    CHECK(json[0].at("findings").at(1).at("as").is_null());
    CHECK(json[1].at("findings").empty());
}

}  // namespace percale::scenes::test::doctor_report_test
