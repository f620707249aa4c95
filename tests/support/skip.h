#pragma once

#include <string>

#include "tests/support/catch.h"

namespace percale::test {

/// How often a case of this process wanted what is not there. The test program's last line says it, which ctest reads (main.cpp).
inline int skips = 0;

/// Says why the rest of a case is not run; the case returns after it.
inline void skip(const std::string& reason) {
    ++skips;
    WARN("skipped: " << reason);
}

}  // namespace percale::test
