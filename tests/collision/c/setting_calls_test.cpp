#include <string>

#include "percale/fabric_presets.h"
#include "percale/options.h"
#include "tests/support/collision/c_objects.h"

namespace percale::test::setting_calls_test {
namespace {

std::string step_text(const percale_step_settings* settings, const char* key) {
    std::size_t size = 0;
    well(percale_step_option(settings, key, nullptr, 0, &size));
    std::string text(size, '?');
    well(percale_step_option(settings, key, text.data(), size, nullptr));
    text.pop_back();
    return text;
}

std::string fabric_text(const percale_fabric* fabric, const char* key) {
    char text[64];
    well(percale_fabric_option(fabric, key, text, sizeof text, nullptr));
    return text;
}

}  // namespace

TEST_CASE("Step options are set and read by key through C") {
    const CSettings settings = c_settings({});
    CHECK(step_text(settings.get(), "scheme") == "backward_euler");
    CHECK(step_text(settings.get(), "newton_tolerance") == "auto");
    well(percale_set_step_option(settings.get(), "scheme", "tr_bdf2"));
    well(percale_set_step_number(settings.get(), "time_step", 1.0 / 3.0));
    CHECK(step_text(settings.get(), "scheme") == "tr_bdf2");
    CHECK(std::stod(step_text(settings.get(), "time_step")) == 1.0 / 3.0);
}

TEST_CASE("Wrong options name key and allowed values, and change nothing") {
    const CSettings settings = c_settings({{"time_step", "0.25"}});
    const auto wrong = [&](const char* key, const char* value, const char* part) {
        fails(percale_set_step_option(settings.get(), key, value), PERCALE_INVALID_ARGUMENT, "percale_set_step_option", part);
    };
    wrong("time_step", "2", "1e-07 ... 1");
    wrong("time_step", "0.1 ", "time_step");
    wrong("scheme", "euler", "backward_euler");
    wrong("skip", "yes", "false, true");
    wrong("step", "1", "time_step");
    wrong(nullptr, "1", "key: is NULL");
    wrong("skip", nullptr, "value: is NULL");
    fails(percale_set_step_option(nullptr, "skip", "true"), PERCALE_INVALID_ARGUMENT, "percale_set_step_option", "NULL");
    fails(percale_set_step_number(settings.get(), "time_step", -1.0), PERCALE_INVALID_ARGUMENT, "percale_set_step_number", "-1");
    char text[3];
    fails(percale_step_option(settings.get(), "time_step", text, sizeof text, nullptr), PERCALE_BUFFER_TOO_SMALL,
          "percale_step_option", "5");
    CHECK(step_text(settings.get(), "time_step") == "0.25");
    fails(percale_create_step_settings(nullptr), PERCALE_INVALID_ARGUMENT, "percale_create_step_settings", "NULL");
    percale_destroy_step_settings(nullptr);
}

TEST_CASE("A fabric's options and presets go through C") {
    const CFabric fabric = c_fabric({{"stretch_stiffness", "2000 1500"}, {"bend_stiffness", "2e-5"}, {"self_contact", "true"}});
    CHECK(fabric_text(fabric.get(), "stretch_stiffness") == "2000 1500");
    CHECK(fabric_text(fabric.get(), "bend_stiffness") == "2e-05");
    CHECK(fabric_text(fabric.get(), "self_contact") == "true");
    well(percale_set_fabric_option(fabric.get(), "stretch_stiffness", "none"));
    CHECK(fabric_text(fabric.get(), "stretch_stiffness") == "none");
    well(percale_set_fabric_number(fabric.get(), "thickness", 0.004));
    CHECK(fabric_text(fabric.get(), "thickness") == "0.004");

    REQUIRE(percale_fabric_preset_count() == percale::fabric_presets().size());
    for (std::size_t i = 0; i < percale_fabric_preset_count(); ++i) {
        const percale::FabricPreset& preset = percale::fabric_presets()[i];
        CHECK(percale_fabric_preset_name(i) == preset.name);
        CHECK(percale_fabric_preset_source(i) == preset.source);
        const CFabric made = c_fabric({}, percale_fabric_preset_name(i));
        CHECK(std::stod(fabric_text(made.get(), "area_density")) == preset.fabric.area_density);
        well(percale_make_fabric_isotropic(made.get()));
        const percale::Fabric isotropic = percale::isotropic(preset.fabric);
        if (isotropic.stretch_stiffness) {
            CHECK(std::stod(fabric_text(made.get(), "stretch_stiffness")) == (*isotropic.stretch_stiffness)[0]);
        }
    }
    CHECK(percale_fabric_preset_name(percale_fabric_preset_count()) == nullptr);
    CHECK(percale_fabric_preset_source(percale_fabric_preset_count()) == nullptr);
}

TEST_CASE("Wrong fabrics are refused") {
    percale_fabric* made = nullptr;
    fails(percale_create_fabric("cottn", &made), PERCALE_INVALID_ARGUMENT, "percale_create_fabric", "cottn");
    CHECK(made == nullptr);
    fails(percale_create_fabric(nullptr, nullptr), PERCALE_INVALID_ARGUMENT, "percale_create_fabric", "NULL");
    const CFabric fabric = c_fabric();
    fails(percale_set_fabric_option(fabric.get(), "thickness", "0"), PERCALE_INVALID_ARGUMENT, "percale_set_fabric_option",
          "1e-06 ... 1");
    fails(percale_set_fabric_number(fabric.get(), "stretch_stiffness", 1.0), PERCALE_INVALID_ARGUMENT,
          "percale_set_fabric_number", "stretch_stiffness");
    fails(percale_make_fabric_isotropic(nullptr), PERCALE_INVALID_ARGUMENT, "percale_make_fabric_isotropic", "NULL");
    percale_destroy_fabric(nullptr);
}

TEST_CASE("C describes options as the table of options does") {
    REQUIRE(percale_step_option_count() == percale::step_options().size());
    REQUIRE(percale_fabric_option_count() == percale::fabric_options().size());
    auto reported = c_struct(percale_init_option);
    for (std::size_t i = 0; i < percale_fabric_option_count(); ++i) {
        const auto& option = percale::fabric_options()[i];
        well(percale_describe_fabric_option(i, &reported));
        CHECK(reported.key == option.key);
        CHECK(reported.unit == option.unit);
        CHECK(reported.sentence == option.sentence);
        CHECK(reported.lowest == option.lowest);
        CHECK(reported.highest == option.highest);
        CHECK((percale_fabric_option_word(i, 0) != nullptr) == (reported.numbers == 0));
        CHECK(percale_fabric_option_word(i, reported.word_count) == nullptr);
    }
    for (std::size_t i = 0; i < percale_step_option_count(); ++i) {
        well(percale_describe_step_option(i, &reported));
        CHECK(reported.key == percale::step_options()[i].key);
        if (reported.key == std::string("scheme")) {
            CHECK(reported.word_count == 10);
            CHECK(percale_step_option_word(i, 0) == std::string("forward_euler"));
        }
        if (reported.key == std::string("threads"))
            CHECK((reported.integer == 1 && reported.takes_auto == 1 && reported.numbers == 1));
    }
    const auto before = reported;
    fails(percale_describe_step_option(999, &reported), PERCALE_INVALID_ARGUMENT, "percale_describe_step_option", "999");
    CHECK(reported.key == before.key);
    reported.struct_size = 1;
    fails(percale_describe_step_option(0, &reported), PERCALE_INVALID_ARGUMENT, "percale_describe_step_option", "struct_size");
    CHECK(percale_step_option_word(999, 0) == nullptr);
    CHECK(percale_fabric_option_word(0, -1) == nullptr);
}

}  // namespace percale::test::setting_calls_test
