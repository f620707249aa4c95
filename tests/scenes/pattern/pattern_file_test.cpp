#include "scenes/pattern/pattern_file.h"

#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test {

TEST_CASE("a pattern is read by the ending of its name, and checked") {
    const TestFolder folder;
    CHECK(read_pattern(folder.write("skirt.toml", skirt_text)).panels.size() == 2);
    CHECK(error_of([&] { read_pattern(folder.write("skirt.json", skirt_text)); }).find("is no JSON") != std::string::npos);
    CHECK(error_of([&] { read_pattern("skirt.dxf"); }).find(".toml (Percale's own) or .json (GarmentCode's)") !=
          std::string::npos);
    const std::string small = "unit = \"mm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [1, 0], [1, 1]]\n";
    CHECK(error_of([&] { read_pattern(folder.write("small.toml", small)); }).find("is its unit right?") != std::string::npos);
}

}  // namespace percale::scenes::test
