#include <algorithm>
#include <cstdio>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/skip.h"

namespace percale::test::symbols_test {

// The binary interface of libpercale.so: what it shows to those that load it.
namespace {

using Names = std::set<std::string>;

std::string text_of(const std::string& path) {
    std::ifstream file(path);
    REQUIRE(file.good());
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

Names stored_symbols() {
    std::istringstream lines(text_of(PERCALE_SYMBOL_LIST));
    Names names;
    for (std::string line; std::getline(lines, line);) names.insert(line);
    return names;
}

/// The functions that percale.h declares, comments left out.
Names declared_functions() {
    const std::string code = std::regex_replace(text_of(PERCALE_C_HEADER), std::regex(R"(/\*[^*]*\*+(?:[^/*][^*]*\*+)*/)"), "");
    const std::regex declaration(R"(\b(percale_\w+)\()");
    Names names;
    for (std::sregex_iterator found(code.begin(), code.end(), declaration), end; found != end; ++found) names.insert((*found)[1]);
    return names;
}

#ifdef PERCALE_SHARED_LIBRARY
Names exported_symbols() {
    std::FILE* listing = popen("nm -D --defined-only '" PERCALE_SHARED_LIBRARY "'", "r");
    REQUIRE(listing != nullptr);
    Names names;
    char address[64], kind[8], name[512];
    while (std::fscanf(listing, "%63s %7s %511s", address, kind, name) == 3) names.insert(name);
    CHECK(pclose(listing) == 0);
    return names;
}
#endif

}  // namespace

TEST_CASE("The list of symbols holds the functions that percale.h declares") {
    CHECK(stored_symbols().size() > 90);
    CHECK(stored_symbols() == declared_functions());
}

TEST_CASE("libpercale.so shows the symbols of the list and no others") {
#ifdef PERCALE_SHARED_LIBRARY
    CHECK(exported_symbols() == stored_symbols());
#else
    skip("this build has no libpercale.so");
#endif
}

}  // namespace percale::test::symbols_test
