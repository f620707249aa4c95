#pragma once

#include <string>

#include "tests/support/catch.h"

namespace percale::test {

/// How often a case of this process lacked a requirement. The test program's last line reports it, which ctest reads (main.cpp).
inline int skips = 0;

/// Reports why the rest of a case is not run; the case returns after it.
inline void skip(const std::string& reason) {
    ++skips;
    WARN("skipped: " << reason);
}

}  // namespace percale::test
