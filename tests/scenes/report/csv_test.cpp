#include "scenes/report/csv.h"

#include <limits>

#include "tests/support/catch.h"

namespace percale::scenes::test::csv_test {

TEST_CASE("Numbers of a table read back to nine digits, and what is not finite is empty") {
    CHECK(std::stod(csv_number(1.0 / 3.0)) == Approx(1.0 / 3.0).epsilon(1e-9));
    CHECK(csv_number(std::numeric_limits<double>::infinity()).empty());
    CHECK(csv_number(std::numeric_limits<double>::quiet_NaN()).empty());
}

TEST_CASE("Text is quoted where a comma, a quote or a line end would break the line") {
    CHECK(csv_text("plain words") == "plain words");
    CHECK(csv_text("a, b") == "\"a, b\"");
    CHECK(csv_text("say \"b\"") == "\"say \"\"b\"\"\"");
    CHECK(csv_text("a\nb") == "\"a\nb\"");
}

TEST_CASE("The cells of a line are what its commas part, empty ones included") {
    CHECK(csv_cells("a,,b c,") == std::vector<std::string>{"a", "", "b c", ""});
    CHECK(csv_cells("") == std::vector<std::string>{""});
}

TEST_CASE("A column is found by its whole name, or not at all") {
    const std::vector<std::string> header = {"time", "contact_hash", "hash"};
    CHECK(csv_column(header, "hash") == 2u);
    CHECK(csv_column(header, "time") == 0u);
    CHECK_FALSE(csv_column(header, "state").has_value());
}

}  // namespace percale::scenes::test::csv_test
