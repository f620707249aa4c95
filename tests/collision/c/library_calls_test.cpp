#include <set>
#include <string>
#include <utility>

#include "tests/support/collision/c_objects.h"

namespace percale::test::library_calls_test {

TEST_CASE("Every status of the C interface has a text of its own, others are unknown") {
    std::set<std::string> texts;
    for (int status = PERCALE_OK; status <= PERCALE_INTERNAL_ERROR; ++status) {
        texts.insert(percale_status_text(static_cast<percale_status>(status)));
    }
    CHECK(texts.size() == static_cast<std::size_t>(PERCALE_INTERNAL_ERROR) + 1);
    CHECK(texts.count("unknown status") == 0);
    CHECK(percale_step_status_text(-1) == std::string("unknown status"));
    CHECK(percale_step_status_text(PERCALE_STEP_CANCELLED + 1) == std::string("unknown status"));
}

TEST_CASE("A status of a step has the word that C++ gives it") {
    const std::pair<int, const char*> words[] = {{PERCALE_STEP_OK, "ok"},
                                                 {PERCALE_STEP_HALVED, "halved"},
                                                 {PERCALE_STEP_NOT_CONVERGED, "not_converged"},
                                                 {PERCALE_STEP_TOLERANCE_MISSED, "tolerance_missed"},
                                                 {PERCALE_STEP_PIN_BLOCKED, "pin_blocked"},
                                                 {PERCALE_STEP_OBSTACLE_TOO_FAST, "obstacle_too_fast"},
                                                 {PERCALE_STEP_WRONG_DERIVATIVE, "wrong_derivative"},
                                                 {PERCALE_STEP_NOT_FINITE, "not_finite"},
                                                 {PERCALE_STEP_WORK_LIMIT, "work_limit"},
                                                 {PERCALE_STEP_CANCELLED, "cancelled"}};
    for (const auto& [status, word] : words) CHECK(percale_step_status_text(status) == std::string(word));
}

TEST_CASE("The version has three numbers") {
    int numbers[3], read = 0;
    const std::string version = percale_version();
    CHECK(std::sscanf(version.c_str(), "%d.%d.%d%n", &numbers[0], &numbers[1], &numbers[2], &read) == 3);
    CHECK(static_cast<std::size_t>(read) == version.size());
}

TEST_CASE("Detectors are queried by word") {
    CHECK(percale_has_detector("none") == 1);
    CHECK(percale_has_detector("brute_force") == 1);
    CHECK(percale_has_detector("Brute_Force") == 0);
    CHECK(percale_has_detector("") == 0);
    CHECK(percale_has_detector(nullptr) == 0);
}

}  // namespace percale::test::library_calls_test
