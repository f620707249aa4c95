#include "collision/c/option_text.h"

#include <limits>

#include "tests/support/catch.h"

namespace percale::test::option_text_test {
using namespace percale::c_interface;

namespace {

/// Texts that an option takes: its ends, its words.
template <class Owner>
std::vector<std::string> texts_for(const Option<Owner>& option) {
    std::vector<std::string> texts;
    for (const std::string_view word : words_of(option)) texts.emplace_back(word);
    if (takes_auto(option)) texts.emplace_back("auto");
    if (option.optional_number || option.optional_pair) texts.emplace_back("none");
    if (texts.size() > 1 && !words_of(option).empty()) return texts;
    for (const double end : {option.lowest, option.highest}) {
        texts.push_back(option.optional_pair ? exact_text(end) + " " + exact_text(end) : exact_text(end));
    }
    return texts;
}

template <class Owner>
void check_round_trips(std::span<const Option<Owner>> options) {
    for (const Option<Owner>& option : options) {
        for (const std::string& text : texts_for(option)) {
            INFO(option.key << " = " << text);
            Owner owner;
            set_option_text(owner, option, text);
            CHECK(option_text(owner, option) == text);
        }
    }
}

template <class Owner>
void check_refusals(std::span<const Option<Owner>> options) {
    for (const Option<Owner>& option : options) {
        for (const std::string text : {"", "nonsense", "1 2 3", "nan", "1e999", "inf", "1e308", "-1e308", " 1", "1;2"}) {
            INFO(option.key << " = " << text);
            Owner owner;
            const std::string before = option_text(owner, option);
            CHECK_THROWS_WITH(set_option_text(owner, option, text), Catch::Contains(std::string(option.key)));
            CHECK(option_text(owner, option) == before);
        }
    }
}

}  // namespace

TEST_CASE("Every option takes its words and the ends of its range as text, and gives them back") {
    check_round_trips(step_options());
    check_round_trips(fabric_options());
}

TEST_CASE("Every option refuses text that is no value of it, names its key and stays as it is") {
    check_refusals(step_options());
    check_refusals(fabric_options());
}

TEST_CASE("A number that is set takes the place of auto") {
    StepSettings settings;
    const auto& option = option_of(step_options(), "time_step");
    set_option_text(settings, option, "auto");
    CHECK(settings.adaptive);
    set_option_number(settings, option, 0.005);
    CHECK(!settings.adaptive);
    CHECK(settings.time_step == 0.005);
}

TEST_CASE("Options of no number, or of whole ones, refuse other numbers") {
    StepSettings settings;
    const auto set = [&](const char* key, double value) { set_option_number(settings, option_of(step_options(), key), value); };
    CHECK_THROWS_WITH(set("scheme", 1.0), Catch::Contains("scheme"));
    CHECK_THROWS_WITH(set("skip", 1.0), Catch::Contains("skip"));
    CHECK_THROWS_WITH(set("threads", 1.5), Catch::Contains("1.5"));
    CHECK_THROWS_WITH(set("threads", 1e300), Catch::Contains("threads"));
    CHECK_THROWS_WITH(set("threads", 65.0), Catch::Contains("1 ... 64"));
    CHECK_THROWS_WITH(set("time_step", std::numeric_limits<double>::quiet_NaN()), Catch::Contains("time_step"));
    set("threads", 2.0);
    CHECK(settings.threads == 2);
}

TEST_CASE("The error of an unknown key names the existing keys") {
    CHECK_THROWS_WITH(option_of(step_options(), "timestep"), Catch::Contains("timestep") && Catch::Contains("time_step"));
    CHECK_THROWS_WITH(option_of(fabric_options(), "springs"), Catch::Contains("springs.structural"));
}

TEST_CASE("An option is found by its former key, too") {
    int former = 0;
    for (const Option<StepSettings>& option : step_options()) {
        if (option.former.empty()) continue;
        ++former;
        CHECK(&option_of(step_options(), option.former) == &option);
    }
    CHECK(former == 1);
    CHECK_THROWS_AS(option_of(step_options(), ""), SceneError);
}

TEST_CASE("Text of a number keeps every bit") {
    for (const double number : {1.0 / 3.0, 5e-324, -0.0, 1e22, std::numeric_limits<double>::max()}) {
        CHECK(number_of(exact_text(number), "number") == number);
    }
    CHECK(numbers_of("1,2.5, 3", "list") == std::vector<double>{1.0, 2.5, 3.0});
    CHECK_THROWS_WITH(numbers_of("1,", "list"), Catch::Contains("list"));
}

TEST_CASE("Words of the table of options end where C expects it") {
    const auto check_end = [](std::string_view text) { CHECK(std::string_view(text.data()) == text); };
    for (const auto& option : step_options()) {
        for (const std::string_view text : {option.key, option.unit, option.sentence}) check_end(text);
        for (const std::string_view word : words_of(option)) check_end(word);
    }
    for (const auto& option : fabric_options()) {
        for (const std::string_view text : {option.key, option.unit, option.sentence}) check_end(text);
        for (const std::string_view word : words_of(option)) check_end(word);
    }
}

}  // namespace percale::test::option_text_test
