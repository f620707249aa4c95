#pragma once

#include <string>

#include "tests/support/catch.h"

namespace percale::test {

/// Cases of this process that wanted what is not there. The test program's last line says how many, which ctest reads (main.cpp).
inline int skipped_cases = 0;

/// Says why the rest of a case is not run; the case returns after it.
inline void skip(const std::string& reason) {
    ++skipped_cases;
    WARN("skipped: " << reason);
}

}  // namespace percale::test
