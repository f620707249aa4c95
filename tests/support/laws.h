#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "tests/support/catch.h"

// Laws with the measured figure. Each prints a line "law: NAME = MEASURED (LIMIT)"; where the environment variable PERCALE_LAWS
// names a file, a row of a table is appended to it.
namespace percale::test {

inline void report_law(const std::string& name, const std::string& measured, const std::string& limit) {
    std::printf("law: %s = %s (%s)\n", name.c_str(), measured.c_str(), limit.c_str());
    const char* path = std::getenv("PERCALE_LAWS");
    if (!path) return;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "a"), std::fclose);
    if (file) std::fprintf(file.get(), "| %s | %s | %s |\n", name.c_str(), measured.c_str(), limit.c_str());
}

inline std::string figure(double value, int digits = 2) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

/// A deviation from a law, which must be at most `limit`.
inline void check_law(const std::string& name, double deviation, double limit) {
    report_law(name, figure(deviation), figure(limit));
    CAPTURE(name);
    CHECK(deviation <= limit);
}

/// A figure that the law puts between two bounds.
inline void check_law_between(const std::string& name, double value, double lowest, double highest) {
    report_law(name, figure(value, 3), figure(lowest, 3) + " to " + figure(highest, 3));
    CAPTURE(name);
    CHECK((value >= lowest && value <= highest));
}

}  // namespace percale::test
