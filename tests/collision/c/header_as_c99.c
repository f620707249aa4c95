/* percale.h as a C99 compiler reads it, with every warning an error; header_test.cpp compares what it says with C++. */
#include <percale.h>

#include "header_as_c99.h"

size_t percale_sizes_in_c(size_t* sizes, size_t capacity) {
    const size_t all[] = {sizeof(percale_pose),
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
    const size_t count = sizeof all / sizeof all[0];
    for (size_t i = 0; i < count && i < capacity; ++i) sizes[i] = all[i];
    return count;
}

/* Designated initialisers and a NULL handle, as C writes them. */
int percale_error_in_c(void) {
    const percale_stitch stitch = {.vertex = 1, .from = 2, .to = 2};
    const int cloths[2] = {0, 0};
    int seam = -1;
    return percale_add_seam(NULL, cloths, &stitch, 1, NULL, &seam) == PERCALE_INVALID_ARGUMENT && seam == -1;
}
