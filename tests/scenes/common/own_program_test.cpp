#include "common/own_program.h"

#include <filesystem>

#include "tests/support/catch.h"

TEST_CASE("a program knows the file that it is") {
    const std::filesystem::path path = percale::scenes::own_program();
    CHECK(path.is_absolute());
    CHECK(std::filesystem::is_regular_file(path));
    CHECK((std::filesystem::status(path).permissions() & std::filesystem::perms::owner_exec) != std::filesystem::perms::none);
}
