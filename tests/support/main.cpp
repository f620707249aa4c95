#define CATCH_CONFIG_RUNNER
#include <cstdio>

#include "tests/support/skip.h"
#if __has_include(<catch2/catch_session.hpp>)
#include <catch2/catch_session.hpp>
#endif

int main(int argc, char** argv) {
    const int failed = Catch::Session().run(argc, argv);
    // Only where nothing failed: ctest counts a test with this output as not run, whatever its exit code.
    if (failed == 0 && percale::test::skips > 0) std::printf("not everything was tested: %d skipped\n", percale::test::skips);
    return failed;
}
