#include "common/own_program.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <filesystem>

#include "percale/saved_state.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::own_program_test {
namespace {

/// Where the loaded library of mathematics lies.
std::string math_library() {
    std::string file;
    dl_iterate_phdr(
        [](dl_phdr_info* loaded, std::size_t, void* found) {
            if (std::string(loaded->dlpi_name).find("/libm.so") == std::string::npos) return 0;
            *static_cast<std::string*>(found) = loaded->dlpi_name;
            return 1;
        },
        &file);
    return file;
}

}  // namespace

TEST_CASE("a program knows the file that it is") {
    const std::filesystem::path path = percale::scenes::own_program();
    CHECK(path.is_absolute());
    CHECK(std::filesystem::is_regular_file(path));
    CHECK((std::filesystem::status(path).permissions() & std::filesystem::perms::owner_exec) != std::filesystem::perms::none);
}

TEST_CASE("the files of a program are its own and the libraries of the project that it has loaded, and no others") {
    const percale::scenes::test::TestFolder folder;
    const std::vector<std::string> before = own_files();
    REQUIRE_FALSE(before.empty());
    CHECK(before.front() == percale::scenes::own_program());
    // Where the engine is a library of its own, that is among them.
    Dl_info place{};
    REQUIRE(dladdr(reinterpret_cast<void*>(&percale::checksum), &place) != 0);
    const auto is_place = [&](const std::string& file) { return std::filesystem::equivalent(file, place.dli_fname); };
    CHECK(std::ranges::count_if(before, is_place) == 1);
    const std::string other = math_library();
    REQUIRE_FALSE(other.empty());
    CHECK(std::ranges::count(before, other) == 0);
    const std::string copy = folder.path("libpercale_test.so");
    std::filesystem::copy_file(other, copy);
    void* loaded = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE(loaded != nullptr);
    const std::vector<std::string> now = own_files();
    CHECK(now.size() == before.size() + 1);
    CHECK(now.front() == before.front());
    CHECK(std::ranges::count(now, copy) == 1);
    const auto name = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
    CHECK(std::ranges::is_sorted(now.begin() + 1, now.end(), {}, name));
    dlclose(loaded);
    CHECK(own_files() == before);
}

}  // namespace percale::scenes::test::own_program_test
