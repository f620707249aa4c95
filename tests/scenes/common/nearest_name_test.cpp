#include "scenes/common/nearest_name.h"

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "tests/support/catch.h"

namespace percale::scenes::test::nearest_name_test {
namespace {

// The definition itself, without a table.
int slow_distance(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
    const std::string a1 = a.substr(1), b1 = b.substr(1);
    int least = std::min({slow_distance(a1, b) + 1, slow_distance(a, b1) + 1, slow_distance(a1, b1) + (a[0] == b[0] ? 0 : 1)});
    if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
        least = std::min(least, slow_distance(a.substr(2), b.substr(2)) + 1);
    return least;
}

std::string random_word(std::mt19937& random) {
    std::string word(random() % 6, 'a');
    for (char& letter : word) letter = static_cast<char>('a' + random() % 3);
    return word;
}

}  // namespace

TEST_CASE("the edit distance counts insertions, deletions, replacements and swaps") {
    CHECK(edit_distance("fabric", "fabric") == 0);
    CHECK(edit_distance("fabrc", "fabric") == 1);
    CHECK(edit_distance("fabriic", "fabric") == 1);
    CHECK(edit_distance("fabrik", "fabric") == 1);
    CHECK(edit_distance("farbic", "fabric") == 1);
    CHECK(edit_distance("", "fabric") == 6);
    CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("upper and lower case do not count") { CHECK(edit_distance("Time_Step", "time_step") == 0); }

TEST_CASE("the edit distance equals the recursive definition and is symmetric on random words") {
    std::mt19937 random(11);
    for (int i = 0; i < 300; ++i) {
        const std::string a = random_word(random), b = random_word(random);
        CAPTURE(a, b);
        REQUIRE(edit_distance(a, b) == slow_distance(a, b));
        REQUIRE(edit_distance(a, b) == edit_distance(b, a));
    }
}

TEST_CASE("the nearest name is that of the smallest distance, the first of equals") {
    const std::vector<std::string> names = {"thickness", "springs", "spring_damping", "spring"};
    CHECK(nearest_name("thicknes", names) == "thickness");
    CHECK(nearest_name("sprigns", names) == "springs");
    CHECK(nearest_name("springdamping", names) == "spring_damping");
    const std::vector<std::string> equals = {"ab", "ac"};
    CHECK(nearest_name("ad", equals) == "ab");
    CHECK(nearest_name("x", {}).empty());
}

TEST_CASE("what is no slip of a name has no nearest one") {
    const std::vector<std::string> schemes = {"symplectic_euler", "rk4", "backward_euler"};
    CHECK(nearest_name("bdf2", schemes).empty());
    CHECK(nearest_name("rk2", schemes) == "rk4");
    CHECK(nearest_name("backwrd_elr", schemes) == "backward_euler");  // 3 edits, a third of 11 letters
    CHECK(nearest_name("bckwrd_elr", schemes).empty());               // 4 edits, more than a third of 10 letters
    const std::vector<std::string> shortest = {"to"};
    CHECK(nearest_name("zz", shortest).empty());
    CHECK(nearest_name("ot", shortest) == "to");
}

TEST_CASE("a suggestion names the nearest and lists what is valid") {
    const std::vector<std::string> names = {"obj", "none"};
    CHECK(suggestion("non", names) == "; did you mean 'none'? valid: obj, none");
    CHECK(suggestion("gif", names) == "; valid: obj, none");
    CHECK(suggestion("non", {}).empty());
    CHECK(did_you_mean("non", names) == "; did you mean 'none'?");
    CHECK(did_you_mean("gif", names).empty());
}

}  // namespace percale::scenes::test::nearest_name_test
