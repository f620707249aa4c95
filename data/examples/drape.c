/* A sheet falls on a ball: the C interface of Percale from the first call to the last. Prints the height of the sheet's middle
 * and of its lowest vertex, what the ball carries, and what the independent check says. Exit code 1 with a text where a call
 * fails, a step was taken unsolved, or something crosses. */
#include <math.h>
#include <percale.h>
#include <stdio.h>

/* Everything that is made, so that it is freed in one place, whatever happened. */
typedef struct made_objects {
    percale_mesh *sheet, *ball;
    percale_fabric* cotton;
    percale_simulation* simulation;
} made_objects;

static percale_status make_scene(made_objects* made) {
    percale_setup setup;
    percale_obstacle_settings ball_settings;
    percale_cloth_settings sheet_settings;
    percale_status status = PERCALE_OK;
    int number;
    /* Each call is made only where all before it went well. */
    if (!status) status = percale_init_setup(&setup, sizeof setup);
    if (!status) status = percale_init_obstacle_settings(&ball_settings, sizeof ball_settings);
    if (!status) status = percale_init_cloth_settings(&sheet_settings, sizeof sheet_settings);
    if (!status) status = percale_make_grid(1.0, 1.0, 21, 21, &made->sheet);
    if (!status) status = percale_make_sphere(0.3, 3, &made->ball);
    if (!status) status = percale_create_fabric(NULL, &made->cotton);
    if (!status) status = percale_set_fabric_option(made->cotton, "area_density", "0.15");
    if (!status) status = percale_set_fabric_number(made->cotton, "thickness", 0.01);
    if (!status) status = percale_set_fabric_number(made->cotton, "springs.shear", 500.0);
    if (!status) status = percale_set_fabric_number(made->cotton, "springs.bend", 10.0);
    if (status) return status;
    setup.detector = percale_has_detector("fcl") ? "fcl" : "brute_force";
    ball_settings.name = "ball";
    ball_settings.friction = 0.4;
    sheet_settings.pose.translation[1] = 0.35;
    status = percale_create_simulation(&setup, &made->simulation);
    if (!status) status = percale_add_cloth(made->simulation, made->sheet, made->cotton, &sheet_settings, &number);
    if (!status) status = percale_add_obstacle(made->simulation, made->ball, &ball_settings, &number);
    return status;
}

static percale_status settle(percale_simulation* simulation, int steps, int* unsolved) {
    percale_step_report report;
    percale_status status = percale_init_step_report(&report, sizeof report);
    for (int i = 0; i < steps && status == PERCALE_OK; ++i) {
        status = percale_step(simulation, &report);
        *unsolved += report.status == PERCALE_STEP_NOT_CONVERGED || report.status == PERCALE_STEP_TOLERANCE_MISSED;
    }
    return status;
}

static percale_status tell(const percale_simulation* simulation) {
    size_t count;
    double force[3];
    const double* positions = percale_positions_view(simulation, 0, &count);
    const percale_status status = percale_force_on(simulation, 0, force);
    if (positions == NULL) return PERCALE_INVALID_ARGUMENT;
    double lowest = positions[1];
    for (size_t i = 0; i < count; ++i) lowest = positions[3 * i + 1] < lowest ? positions[3 * i + 1] : lowest;
    if (status == PERCALE_OK) {
        printf("middle at %.3f m, lowest vertex at %.3f m, the ball carries %.3f N\n", positions[3 * (count / 2) + 1], lowest,
               -force[1]);
    }
    return status;
}

/* Whether the sheet, where it is now, crosses the ball, which has not moved. */
static percale_status check(const made_objects* made, int* crosses) {
    percale_certificate found;
    percale_mesh* now = NULL;
    size_t vertices, triangles;
    const double* positions = percale_positions_view(made->simulation, 0, &vertices);
    const int* corners = percale_mesh_triangles_view(made->sheet, &triangles);
    percale_status status = percale_create_mesh(positions, vertices, corners, triangles, &now);
    if (!status) status = percale_init_certificate(&found, sizeof found);
    if (!status) status = percale_certify(now, made->ball, INFINITY, &found);
    percale_destroy_mesh(now);
    if (status) return status;
    *crosses = found.intersecting_pairs > 0 || found.vertices_inside > 0;
    printf("certificate: %llu intersecting pairs, %d vertices inside, %.2f mm apart\n",
           (unsigned long long)found.intersecting_pairs, found.vertices_inside, 1e3 * found.smallest_distance);
    return PERCALE_OK;
}

int main(void) {
    made_objects made = {NULL, NULL, NULL, NULL};
    int unsolved = 0, crosses = 0;
    percale_status status = make_scene(&made);
    if (status == PERCALE_OK) status = settle(made.simulation, 240, &unsolved);
    if (status == PERCALE_OK) status = tell(made.simulation);
    if (status == PERCALE_OK) status = check(&made, &crosses);
    if (unsolved > 0) fprintf(stderr, "drape: %d steps were taken unsolved\n", unsolved);
    if (crosses) fprintf(stderr, "drape: the sheet crosses the ball\n");
    if (status != PERCALE_OK) fprintf(stderr, "drape: %s: %s\n", percale_status_text(status), percale_last_error(NULL));
    percale_destroy_simulation(made.simulation);
    percale_destroy_fabric(made.cotton);
    percale_destroy_mesh(made.ball);
    percale_destroy_mesh(made.sheet);
    return status == PERCALE_OK && unsolved == 0 && !crosses ? 0 : 1;
}
