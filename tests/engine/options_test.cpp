#include "percale/options.h"

#include <cmath>
#include <limits>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::options_test {
namespace {

template <class Owner>
void check_descriptions(std::span<const Option<Owner>> options) {
    std::set<std::string_view> keys;
    for (const Option<Owner>& option : options) {
        CAPTURE(option.key);
        CHECK(keys.insert(option.key).second);
        CHECK(option.sentence.size() > 10);
        CHECK(option.sentence.back() == '.');
        const int fields = (option.number != nullptr) + (option.integer != nullptr) + (option.number_or_auto != nullptr) +
                           (option.flag != nullptr) + (option.optional_number != nullptr) + (option.optional_pair != nullptr) +
                           (option.get_choice != nullptr);
        CHECK(fields == 1);
        CHECK((option.get_choice != nullptr) == (option.set_choice != nullptr));
        CHECK((option.get_choice != nullptr) == !option.choices.empty());
        CHECK(option.lowest <= option.highest);
    }
}

/// An owner in which any single field may be set.
template <class Owner>
Owner owner_for(const Option<Owner>&) {
    return {};
}
template <>
Fabric owner_for(const Option<Fabric>& option) {
    Fabric fabric;
    if (option.key == "shear_stiffness" || option.key == "poisson_ratio") fabric.stretch_stiffness = {100.0, 100.0};
    return fabric;
}

/// The message for one field set to a value; empty if it is allowed.
template <class Owner>
std::string refusal(const Option<Owner>& option, double value) {
    Owner owner = owner_for(option);
    if (option.number) *option.number(owner) = value;
    if (option.integer) *option.integer(owner) = static_cast<int>(value);
    if (option.number_or_auto) *option.number_or_auto(owner) = value;
    if (option.optional_number) *option.optional_number(owner) = value;
    if (option.optional_pair) *option.optional_pair(owner) = {1.0, value};
    return scene_error([&] { check_options(owner, "silk"); });
}

template <class Owner>
void check_ranges(std::span<const Option<Owner>> options) {
    for (const Option<Owner>& option : options) {
        if (option.get_choice || option.flag) continue;
        CAPTURE(option.key);
        CHECK(refusal(option, option.lowest) == "");
        CHECK(refusal(option, option.highest) == "");
        const double above = option.integer ? option.highest + 1 : std::nextafter(option.highest, 1e300);
        const double below =
            option.integer ? (option.zero_is_auto ? -1 : option.lowest - 1) : std::nextafter(option.lowest, -1e300);
        for (const double bad : {above, below}) CHECK(mentions(refusal(option, bad), {"silk", std::string(option.key), "..."}));
        if (option.integer) continue;
        CHECK_FALSE(refusal(option, std::numeric_limits<double>::quiet_NaN()).empty());
        CHECK_FALSE(refusal(option, std::numeric_limits<double>::infinity()).empty());
    }
}

}  // namespace

TEST_CASE("Every option has one field, a key of its own and a sentence") {
    check_descriptions(fabric_options());
    check_descriptions(step_options());
}

namespace {

/// Another value of the field that an option names; of a number that may be automatic, another number.
void change(const Option<StepSettings>& option, StepSettings& settings) {
    if (option.number) *option.number(settings) *= 0.5;
    if (option.integer) *option.integer(settings) += 1;
    if (option.flag) *option.flag(settings) = !*option.flag(settings);
    if (option.number_or_auto) *option.number_or_auto(settings) = 1e-3;
    if (option.get_choice) {
        const auto words = static_cast<int>(option.choices.size());
        option.set_choice(settings, (option.get_choice(settings) + 1) % words);
    }
}

}  // namespace

TEST_CASE("The hash of step settings changes with every field that changes steps and with no other") {
    const std::uint64_t before = options_hash({});
    std::set<std::uint64_t> others;
    for (const Option<StepSettings>& option : step_options()) {
        CAPTURE(option.key);
        StepSettings settings;
        change(option, settings);
        const bool counts = option.changes_steps && !option.automatic;
        CHECK((options_hash(settings) != before) == counts);
        if (counts) CHECK(others.insert(options_hash(settings)).second);
        if (option.automatic) {
            *option.automatic(settings) = true;
            CHECK((options_hash(settings) != before) == option.changes_steps);
        }
    }
    CHECK(others.size() >= 10);
    StepSettings of_the_state;
    of_the_state.gravity = Vec3(0.0, 1.0, 0.0);
    of_the_state.wind = Vec3(1.0, 0.0, 0.0);
    CHECK(options_hash(of_the_state) == before);
}

TEST_CASE("Threads, the rule for a start, checks of derivatives and the limit of work change no step") {
    std::set<std::string_view> free;
    for (const Option<StepSettings>& option : step_options())
        if (!option.changes_steps) free.insert(option.key);
    CHECK(free == std::set<std::string_view>{"threads", "start", "check_derivatives", "work_limit"});
}

TEST_CASE("Defaults are allowed") {
    CHECK(scene_error([] { check_options(Fabric{}, "default"); }) == "");
    CHECK(scene_error([] { check_options(StepSettings{}, "default"); }) == "");
}

TEST_CASE("Both ends of every range are allowed and the next number beyond is refused by name") {
    check_ranges(fabric_options());
    check_ranges(step_options());
}

TEST_CASE("A refusal names owner, key, value, unit and range") {
    Fabric fabric;
    fabric.area_density = -0.5;
    CHECK(scene_error([&] { check_options(fabric, "silk"); }) ==
          "silk: area_density = -0.5 kg/m^2 is outside the allowed range 0.0001 ... 1000");
    StepSettings settings;
    settings.newton_iterations = 0;
    CHECK(scene_error([&] { check_options(settings, "settings"); }) ==
          "settings: newton_iterations = 0 is outside the allowed range 1 ... 1000");
}

TEST_CASE("Fields of a fabric that exclude or need each other are refused, and defaults contradict nothing") {
    const auto refused = [](const Fabric& fabric) { return scene_error([&] { check_options(fabric, "silk"); }); };
    CHECK(refused({.stretch_stiffness = {{2000.0, 1500.0}}, .shear_stiffness = 100.0, .bend_stiffness = 1e-5}) == "");
    CHECK(refused({.springs = {.structural = 0.0}, .stretch_stiffness = {{2.0, 1.0}}}) == "");
    CHECK(refused({.spring_damping = 0.0, .damping_time = 0.01}) == "");
    CHECK(
        mentions(refused({.springs = {.structural = 5.0}, .stretch_stiffness = {{2.0, 1.0}}}), {"springs", "stretch_stiffness"}));
    CHECK(mentions(refused({.springs = {.bend = 5.0}, .bend_stiffness = 1e-5}), {"silk", "springs.bend", "bend_stiffness"}));
    CHECK(mentions(refused({.spring_damping = 0.2, .damping_time = 0.01}), {"spring_damping", "damping_time"}));
    CHECK(mentions(refused({.shear_stiffness = 5.0}), {"shear_stiffness needs stretch_stiffness"}));
    CHECK(mentions(refused({.poisson_ratio = 0.2}), {"poisson_ratio needs stretch_stiffness"}));
    Fabric plain{.stretch_stiffness = {{2.0, 2.0}}, .membrane = Membrane::van_gelder};
    CHECK(refused(plain) == "");
    plain.poisson_ratio = 0.3;
    CHECK(mentions(refused(plain), {"van_gelder", "poisson_ratio"}));
    plain = {.stretch_stiffness = {{2.0, 2.0}}, .shear_stiffness = 1.0, .membrane = Membrane::van_gelder};
    CHECK(mentions(refused(plain), {"van_gelder", "shear_stiffness"}));
    plain = {.stretch_stiffness = {{2.0, 1.0}}, .membrane = Membrane::van_gelder};
    CHECK(mentions(refused(plain), {"van_gelder", "stretch_stiffness"}));
}

TEST_CASE("Gravity must be finite and at most ten thousand m/s^2 along each axis") {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double bad : {1.1e4, -1.1e4, std::numeric_limits<double>::quiet_NaN()}) {
            StepSettings settings;
            settings.gravity[axis] = bad;
            CHECK(mentions(scene_error([&] { check_options(settings, "settings"); }), {"settings", "gravity", "m/s^2"}));
        }
    }
}

TEST_CASE("Choices read and write their field, word by word") {
    for (const Option<StepSettings>& option : step_options()) {
        if (!option.get_choice) continue;
        for (int i = 0; i < static_cast<int>(option.choices.size()); ++i) {
            StepSettings settings;
            option.set_choice(settings, i);
            CHECK(option.get_choice(settings) == i);
            CHECK(scene_error([&] { check_options(settings, "settings"); }) == "");
        }
    }
}

TEST_CASE("An empty newton tolerance means automatic and is not checked") {
    StepSettings settings;
    CHECK_FALSE(settings.newton_tolerance.has_value());
    settings.newton_tolerance = 2.0;
    CHECK(mentions(scene_error([&] { check_options(settings, "settings"); }), {"newton_tolerance", "2"}));
}

}  // namespace percale::test::options_test
