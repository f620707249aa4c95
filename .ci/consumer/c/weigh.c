#include <math.h>
#include <percale.h>
#include <stdio.h>

/* Prints what failed; gives whether all went well. */
static int well(percale_status status) {
    if (status != PERCALE_OK) fprintf(stderr, "weigh: %s: %s\n", percale_status_text(status), percale_last_error(NULL));
    return status == PERCALE_OK;
}

/* A towel falls on a floor and lies there; the floor carries its weight. */
static int weigh(percale_simulation* simulation, const percale_mesh* sheet, const percale_mesh* floor,
                 const percale_fabric* towel) {
    percale_cloth_settings above;
    percale_step_report report;
    int cloth = -1, obstacle = -1;
    double force[3] = {0.0, 0.0, 0.0};
    const double weight = 0.2 * 0.5 * 0.5 * 9.81;
    if (!well(percale_init_cloth_settings(&above, sizeof above)) || !well(percale_init_step_report(&report, sizeof report)))
        return 1;
    above.pose.translation[1] = 0.02;
    if (!well(percale_add_cloth(simulation, sheet, towel, &above, &cloth))) return 1;
    if (!well(percale_add_obstacle(simulation, floor, NULL, &obstacle))) return 1;
    for (int step = 0; step < 600 && !report.slept; ++step) {
        if (!well(percale_step(simulation, &report))) return 1;
    }
    if (!well(percale_force_on(simulation, obstacle, force))) return 1;
    printf("the floor carries %.4f N, the towel weighs %.4f N\n", -force[1], weight);
    return report.slept && fabs(force[1] + weight) < 1e-3 * weight ? 0 : 1;
}

int main(void) {
    percale_mesh *sheet = NULL, *floor = NULL;
    percale_fabric* towel = NULL;
    percale_simulation* simulation = NULL;
    percale_setup setup;
    int failed = 1;
    if (well(percale_init_setup(&setup, sizeof setup))) {
        setup.detector = "brute_force";
        if (well(percale_make_grid(0.5, 0.5, 9, 9, &sheet)) && well(percale_make_plane(1.0, &floor)) &&
            well(percale_create_fabric(NULL, &towel)) && well(percale_create_simulation(&setup, &simulation))) {
            failed = weigh(simulation, sheet, floor, towel);
        }
    }
    percale_destroy_simulation(simulation);
    percale_destroy_fabric(towel);
    percale_destroy_mesh(floor);
    percale_destroy_mesh(sheet);
    return failed;
}
