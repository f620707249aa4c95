#include "scenes/pattern/edge_stations.h"

#include <algorithm>

#include "scenes/pattern/pattern_parts.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::edge_stations_test {
namespace {

/// Two edges of 10 and 20 cm against one of 30.4 cm, and against two of 11 and 19.2.
const std::string yoke =
    "unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [10, 0], [30, 0], [30, 20], [0, 20]]\n"
    "[[panel]]\nname = \"b\"\npoints = [[0, 0], [30.4, 0], [30.4, -20], [11.2, -20], [0.2, -20]]\nat = [0, -1, 0]\n";

Pattern sewn(const std::string& second) {
    return parse_pattern_toml(yoke + "[[seam]]\nsides = [[\"a.0\", \"a.1\"], " + second + "]\n", "t");
}

double share_at(const EdgeStations& stations, const EdgeStations::Place& place) {
    return stations.shares[place.panel][place.edge][place.station];
}

}  // namespace

TEST_CASE("edges run from 0 to 1 in steps about as long as asked") {
    const Pattern pattern = parse_pattern_toml(skirt_text, "t");
    const EdgeStations stations = divide_edges(pattern, 0.02);
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        for (std::size_t e = 0; e < 4; ++e) {
            const std::vector<double>& shares = stations.shares[p][e];
            CHECK(shares.front() == 0.0);
            CHECK(shares.back() == 1.0);
            CHECK(std::is_sorted(shares.begin(), shares.end()));
            const double length = edge_length(pattern.panels[p], pattern.panels[p].edges[e]);
            CHECK(length / static_cast<double>(shares.size() - 1) == Approx(0.02).epsilon(0.1));
        }
    }
    CHECK(stations.sewn[0].size() == stations.shares[0][1].size());
}

TEST_CASE("both sides of a seam have as many stations, a corner of one side gives the other one") {
    const EdgeStations stations = divide_edges(sewn("[\"b.0\"]"), 0.02);
    const auto& pairs = stations.sewn[0];
    CHECK(stations.shares[0][0].size() + stations.shares[0][1].size() - 1 == stations.shares[1][0].size());
    CHECK(pairs.size() == stations.shares[1][0].size());
    const auto corner = std::ranges::find_if(pairs, [&](const auto& pair) { return pair[0].edge == 1 && pair[0].station == 0; });
    REQUIRE(corner != pairs.end());
    CHECK(share_at(stations, (*corner)[1]) == Approx(1.0 / 3.0).epsilon(1e-9));
    for (const auto& [first, second] : pairs) CHECK(share_at(stations, first) >= 0.0);
}

TEST_CASE("a side that is longer by a tenth has vertices between the stitches, the other none") {
    const auto sewn_to = [](double length) {
        const std::string sides =
            "unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [30, 0], [30, 20], [0, 20]]\n"
            "[[panel]]\nname = \"b\"\npoints = [[0, 0], [" +
            std::to_string(length) + ", 0], [0, -20]]\n";
        return divide_edges(parse_pattern_toml(sides + "[[seam]]\nsides = [[\"a.0\"], [\"b.0\"]]\ngather = true\n", "t"), 0.02);
    };
    for (const double length : {20.0, 32.0, 34.0, 60.0, 100.0}) {
        CAPTURE(length);
        const EdgeStations stations = sewn_to(length);
        const auto& pairs = stations.sewn[0];
        std::array<std::size_t, 2> edges = {stations.shares[0][0].size() - 1, stations.shares[1][0].size() - 1};
        const std::size_t stitches = pairs.size() - 1;
        const int longer = length > 30.0 ? 1 : 0;
        CHECK(edges[1 - longer] == stitches);
        CHECK((edges[longer] > stitches) == (length < 27.0 || length > 33.0));
        CHECK(edges[longer] % stitches == 0);
        for (const auto& [first, second] : pairs) CHECK(share_at(stations, first) == Approx(share_at(stations, second)));
        // No edge is far from what was asked for.
        CHECK(std::max(0.3, 0.01 * length) / static_cast<double>(edges[longer]) == Approx(0.02).epsilon(0.45));
    }
}

TEST_CASE("in a gather with a corner and an edge that runs backwards stitches join equal fractions") {
    std::string wide = yoke;
    wide.replace(wide.find("[30.4, 0]"), 9, "[45.0, 0]");
    const EdgeStations stations =
        divide_edges(parse_pattern_toml(wide + "[[seam]]\nsides = [[\"a.0\", \"a.1\"], [\"b.0-\"]]\ngather = true\n", "t"), 0.02);
    const auto& pairs = stations.sewn[0];
    CHECK(pairs.size() == stations.shares[0][0].size() + stations.shares[0][1].size() - 1);
    CHECK(stations.shares[1][0].size() == 2 * (pairs.size() - 1) + 1);
    for (const auto& [first, second] : pairs) {
        const double share = share_at(stations, first), along = first.edge == 0 ? share / 3.0 : (1.0 + 2.0 * share) / 3.0;
        CHECK(1.0 - share_at(stations, second) == Approx(along).margin(1e-9));
    }
}

TEST_CASE("corners that nearly face each other are sewn to each other") {
    const EdgeStations stations = divide_edges(sewn("[\"b.3-\", \"b.2-\"]"), 0.05);
    const auto& pairs = stations.sewn[0];
    const auto corner = std::ranges::find_if(pairs, [&](const auto& pair) { return pair[0].edge == 1 && pair[0].station == 0; });
    REQUIRE(corner != pairs.end());
    const EdgeStations::Place other = (*corner)[1];
    CHECK(other.edge == 2);
    CHECK(share_at(stations, other) == 1.0);
    CHECK(share_at(stations, pairs.front()[1]) == 1.0);
    CHECK(share_at(stations, pairs.back()[1]) == 0.0);
}

TEST_CASE("an edge in two seams, and edges far shorter than asked, are refused") {
    const std::string twice =
        yoke + "[[seam]]\nsides = [[\"a.0\"], [\"b.3\"]]\n[[seam]]\nname = \"two\"\nsides = [[\"a.0\"], [\"b.1\"]]\n";
    CHECK(error_of([&] {
              divide_edges(parse_pattern_toml(twice, "t"), 0.02);
          }).find("seam 'two': edge 0 of panel 'a' is in another seam, too") != std::string::npos);
}

}  // namespace percale::scenes::test::edge_stations_test
