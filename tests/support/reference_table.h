#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace percale::test {

/// The rows of numbers of data/reference/`name` without the head line.
inline std::vector<std::vector<double>> reference_table(const std::string& name) {
    std::ifstream file(std::string(PERCALE_DATA_DIR) + "/reference/" + name);
    CAPTURE(name);
    REQUIRE(file.good());
    std::vector<std::vector<double>> rows;
    std::string line, cell;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        rows.emplace_back();
        while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
    }
    REQUIRE_FALSE(rows.empty());
    return rows;
}

}  // namespace percale::test
