#include "scenes/format/overrides.h"

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::overrides_test {
namespace {

TomlNode changed(const std::string& key, const std::string& value, const std::string& text = small_scene()) {
    TomlNode document = parse_toml(text, "t");
    apply_override(document, {key, value});
    return document;
}

std::string fault(const std::string& key, const std::string& value = "1") {
    return error_of([&] { changed(key, value); });
}

}  // namespace

TEST_CASE("an override replaces a value") {
    const TomlNode document = changed("fabric.sheet.springs.bend", "2.5");
    CHECK(document.find("fabric")->find("sheet")->find("springs")->find("bend")->number == 2.5);
    CHECK(document.find("fabric")->find("sheet")->find("springs")->find("shear")->number == 500.0);
}

TEST_CASE("an override makes the tables that it needs") {
    const TomlNode document = changed("step.detector", "brute_force");
    REQUIRE(document.find("step") != nullptr);
    CHECK(document.find("step")->kind == TomlKind::table);
    CHECK(document.find("step")->find("detector")->text == "brute_force");
}

TEST_CASE("what an override puts in has the override as its place") {
    const TomlNode document = changed("step.detector", "brute_force");
    CHECK(document.find("step")->key_place.file == "--set step.detector");
    CHECK(document.find("step")->find("detector")->key_place.file == "--set step.detector");
    CHECK(document.find("step")->find("detector")->place.file == "--set step.detector");
}

TEST_CASE("an item of a list is reached by its name or its number") {
    for (const char* key : {"cloth.flag.pin", "cloth.0.pin"}) {
        const TomlNode document = changed(key, "[0, 4]");
        const TomlNode& cloth = document.find("cloth")->items.at(0);
        REQUIRE(cloth.find("pin") != nullptr);
        CHECK(cloth.find("pin")->items.size() == 2);
        CHECK(cloth.find("name")->text == "flag");
    }
    const TomlNode document = changed("gravity.1", "-1.62", "gravity = [0, -9.81, 0]\n");
    CHECK(document.find("gravity")->items.at(1).number == -1.62);
    CHECK(document.find("gravity")->items.at(0).number == 0.0);
}

TEST_CASE("of two items the named one is changed") {
    const std::string text = "[[cloth]]\nname = \"a\"\n[[cloth]]\nname = \"b\"\n";
    const TomlNode document = changed("cloth.b.fabric", "felt", text);
    CHECK(document.find("cloth")->items.at(0).find("fabric") == nullptr);
    CHECK(document.find("cloth")->items.at(1).find("fabric")->text == "felt");
}

TEST_CASE("later overrides win") {
    TomlNode document = parse_toml(small_scene(), "t");
    apply_override(document, {"duration", "1"});
    apply_override(document, {"duration", "2"});
    CHECK(document.find("duration")->integer == 2);
    CHECK(document.entries.size() == 3);
}

TEST_CASE("an item that is not there is an error with the nearest name") {
    CHECK(fault("cloth.flga.pin") == "--set cloth.flga.pin: cloth has no item 'flga'; did you mean 'flag'? valid: flag");
    CHECK(fault("cloth.1.pin") == "--set cloth.1.pin: cloth has no item '1'; allowed: 0 ... 0");
    CHECK(fault("cloth.-1.pin") == "--set cloth.-1.pin: cloth has no item '-1'; allowed: 0 ... 0");
    CHECK(error_of([] { changed("gravity.y", "1", "gravity = [0, -9.81, 0]\n"); }) ==
          "--set gravity.y: gravity has no item 'y'; allowed: 0 ... 2");
    CHECK(error_of([] { changed("cloth.0", "1", "cloth = []\n"); }) == "--set cloth.0: cloth has no item '0'; it is empty");
}

TEST_CASE("a fabric that is not there is an error with the nearest name") {
    CHECK(fault("fabric.shet.thickness") == "--set fabric.shet.thickness: no fabric 'shet'; did you mean 'sheet'? valid: sheet");
    CHECK(fault("fabric.silk", "{ thickness = 1 }").starts_with("--set fabric.silk: no fabric 'silk'"));
}

TEST_CASE("nothing can be set inside a number or a text") {
    CHECK(fault("cloth.0.name.x") == "--set cloth.0.name.x: nothing to set inside the text \"flag\" ('x')");
}

TEST_CASE("a key with an empty part is no key") {
    for (const char* key : {"", ".", "step.", ".step", "step..detector"}) {
        CAPTURE(key);
        CHECK(fault(key).find("is not a dotted key of a scene file") != std::string::npos);
    }
}

TEST_CASE("an option that stands for a key is named as it was typed") {
    TomlNode document = parse_toml(small_scene(), "t");
    CHECK(error_of([&] { apply_override(document, {"output.fps", "", "--fps"}); }) == "--fps: the value is empty");
}

TEST_CASE("a bad value is reported with the key") { CHECK(fault("duration", "").starts_with("--set duration: ")); }

}  // namespace percale::scenes::test::overrides_test
