#include <cstddef>
#include <vector>

#include "header_as_c99.h"
#include "percale.h"
#include "tests/support/catch.h"

namespace percale::test::header_test {

TEST_CASE("A C99 compiler lays the structs of percale.h out as C++ does") {
    const std::vector<std::size_t> of_cpp{sizeof(percale_pose),
                                          sizeof(percale_stitch),
                                          sizeof(percale_contact_load),
                                          sizeof(percale_start_move),
                                          sizeof(percale_workers),
                                          sizeof(percale_setup),
                                          sizeof(percale_cloth_settings),
                                          sizeof(percale_obstacle_settings),
                                          sizeof(percale_seam_settings),
                                          sizeof(percale_scripted_changes),
                                          sizeof(percale_energy),
                                          sizeof(percale_step_report),
                                          sizeof(percale_start_fault),
                                          sizeof(percale_certificate),
                                          sizeof(percale_option),
                                          sizeof(percale_status),
                                          offsetof(percale_step_report, cpu_s),
                                          offsetof(percale_setup, wind),
                                          offsetof(percale_option, highest)};
    std::vector<std::size_t> of_c(of_cpp.size());
    REQUIRE(percale_sizes_in_c(of_c.data(), of_c.size()) == of_cpp.size());
    CHECK(of_c == of_cpp);
}

TEST_CASE("A call written in C is refused as one written in C++") { CHECK(percale_error_in_c() == 1); }

}  // namespace percale::test::header_test
