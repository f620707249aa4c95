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

TEST_CASE("A table has a line a row, and a line of values their texts, in quotes where they need them") {
    CHECK(csv_table({{"name", "count, all"}, {"pear", "3"}}) == "name,\"count, all\"\npear,3\n");
    CHECK(csv_table({}).empty());
    CHECK(csv_line("a, b", std::string("c"), 0.25, 12, 13L, true, false) == "\"a, b\",c,0.25,12,13,yes,no\n");
    CHECK(csv_line(std::numeric_limits<double>::infinity(), "", 1) == ",,1\n");
}

TEST_CASE("Columns of an aligned table begin at one place, those in the middle end at one") {
    const TableCells cells = {{"a", "bb", "figures", "end"}, {"long", "b", "1", "x"}, {"c", "b", "1234567", "yy"}};
    CHECK(aligned_table(cells, 2, true) ==
          "a     bb  figures  end\n"
          "long  b         1  x\n"
          "c     b   1234567  yy\n");
    CHECK(aligned_table(cells, 1) ==
          "a     bb  figures  end\n"
          "long   b        1    x\n"
          "c      b  1234567   yy\n");
}

TEST_CASE("A column is found by its whole name, or not at all") {
    const std::vector<std::string> header = {"time", "contact_hash", "hash"};
    CHECK(csv_column(header, "hash") == 2u);
    CHECK(csv_column(header, "time") == 0u);
    CHECK_FALSE(csv_column(header, "state").has_value());
}

}  // namespace percale::scenes::test::csv_test
