#ifndef PERCALE_C_TYPES_H
#define PERCALE_C_TYPES_H

/* Types of the C interface, <percale.h>. C99 and C++. Lengths in m, masses in kg, times in s; y is up. */

#include <stddef.h>
#include <stdint.h>

/* Objects of the library. Each is made by a percale_create_* or percale_make_* function and freed by its percale_destroy_*. */
typedef struct percale_simulation percale_simulation;
typedef struct percale_step_settings percale_step_settings; /* how steps are solved */
typedef struct percale_fabric percale_fabric;               /* what a cloth is made of */
typedef struct percale_mesh percale_mesh;                   /* triangles; never changes */

/* Result of a call. Numbers never change; later versions may append. */
typedef enum percale_status {
    PERCALE_OK = 0,
    PERCALE_INVALID_ARGUMENT = 1, /* the call was wrong and changed nothing */
    PERCALE_BUFFER_TOO_SMALL = 2, /* only the number of items was written */
    PERCALE_START_REFUSED = 3,    /* cloth starts where no simulation may start: percale_last_start_fault */
    PERCALE_STEP_FAILED = 4,      /* the step failed; the state is that before it, the report states why */
    PERCALE_NOT_BUILT = 5,        /* this build of the library lacks a requested part */
    PERCALE_OUT_OF_MEMORY = 6,
    PERCALE_INTERNAL_ERROR = 7 /* a fault of the library, or of the host's threads */
} percale_status;

/* How a step ended. Those up to PERCALE_STEP_TOLERANCE_MISSED are accepted. */
typedef enum percale_step_status {
    PERCALE_STEP_OK = 0,
    PERCALE_STEP_HALVED = 1,            /* accepted after the step was repeated as shorter ones */
    PERCALE_STEP_NOT_CONVERGED = 2,     /* accepted at the iteration limit; the residual measures the error */
    PERCALE_STEP_TOLERANCE_MISSED = 3,  /* adaptive: accepted at the shortest length there is */
    PERCALE_STEP_PIN_BLOCKED = 4,       /* failed: a pin cannot reach its target */
    PERCALE_STEP_OBSTACLE_TOO_FAST = 5, /* failed: the cloth could not follow a moving obstacle */
    PERCALE_STEP_WRONG_DERIVATIVE = 6,  /* failed: option check_derivatives found wrong forces */
    PERCALE_STEP_NOT_FINITE = 7,        /* failed: a state would have become infinite or NaN */
    PERCALE_STEP_WORK_LIMIT = 8,        /* failed: more Newton iterations than work_limit allows; or out_of_time */
    PERCALE_STEP_CANCELLED = 9          /* failed: percale_set_cancel */
} percale_step_status;

/* x -> translation + rotation (scale x). Never changes in size. */
typedef struct percale_pose {
    double translation[3]; /* m */
    double rotation[4];    /* unit quaternion w x y z */
    double scale;          /* > 0 */
} percale_pose;

/* Joins a vertex of the first cloth to a point between two vertices of the second: (1 - share) x_from + share x_to. A vertex is
 * joined to a vertex by from == to. Never changes in size. */
typedef struct percale_stitch {
    int vertex, from, to;
    double share; /* 0 ... 1 */
} percale_stitch;

/* Force of an obstacle on a vertex of a cloth, N. Never changes in size. */
typedef struct percale_contact_load {
    int vertex, obstacle;
    double normal[3];         /* what pushes the vertex off */
    double friction[3];       /* along the surface */
    double cloth_point[3];    /* m, world, where the force acts: the vertex, on the cloth's middle surface */
    double obstacle_point[3]; /* m, world, on the obstacle: the mean of the contact points, weighted by normal force */
} percale_contact_load;

/* How a cloth that started through, inside or touching something was moved. Never changes in size. */
typedef struct percale_start_move {
    int cloth;
    int obstacle;        /* -1: cloth */
    int vertices_moved;  /* by more than a tenth of the thickness */
    double largest_move; /* m */
} percale_start_move;

/* Structs below begin with struct_size, which percale_init_* sets together with the defaults. Later versions may append fields
 * and then take the sizes of earlier ones, too. */

/* The host's threads. Results do not depend on them. */
typedef struct percale_workers {
    uint32_t struct_size;
    int threads; /* maximum number of parts at the same time, the caller's included; 1 ... 64 */
    void* host;  /* handed to run */
    /* Calls work(data, part, slot) once for each part of 0 ... parts - 1, in any order and on any threads, and returns when all
     * are done; what they wrote is then seen by the caller. Calls at the same time have different slots of 0 ... threads - 1.
     * work does not call run, and returns. run calls no function of this library, and leaves neither by longjmp nor by an
     * exception. Simulations that share a host may call it at the same time. Required. */
    void (*run)(void* host, int parts, void (*work)(void* data, int part, int slot), void* data);
} percale_workers;

/* What a simulation begins with. */
typedef struct percale_setup {
    uint32_t struct_size;
    int has_wind;         /* 0: there is no air; default 0 */
    const char* detector; /* "fcl", "bullet", "brute_force" or "none", which takes no obstacles; default "none" */
    const percale_step_settings* settings; /* copied; NULL, the default: all defaults */
    const percale_workers* workers;        /* copied; NULL, the default: threads of its own, option threads */
    double gravity[3];                     /* m/s^2, -1e4 ... 1e4; default 0 -9.81 0 */
    double wind[3];                        /* m/s, velocity of the air, -1e3 ... 1e3; without has_wind unused */
} percale_setup;

typedef struct percale_cloth_settings {
    uint32_t struct_size;
    const char* name;              /* for messages; default "cloth" */
    percale_pose pose;             /* of the mesh at the start; default: as the mesh lies */
    const percale_mesh* rest_mesh; /* the same triangles without strain; NULL, the default: the mesh itself */
    const double* rest_corners;    /* instead of rest_mesh: m, nine numbers for each triangle; a vertex may differ by triangle */
    size_t rest_corner_triangles;  /* how many triangles rest_corners holds */
    double warp[3];                /* direction of warp where the rest shape is; 0 0 0, the default: unknown */
} percale_cloth_settings;

typedef struct percale_obstacle_settings {
    uint32_t struct_size;
    int deforming;      /* not 0: its vertices may move one by one; default 0 */
    int yields;         /* not 0: compliant, its surface gives way where cloth is pinched; it is then deforming; default 0 */
    double friction;    /* Coulomb coefficient against cloth, 0 ... 10; default 0.3 */
    double restitution; /* share of its normal speed with which cloth that hits it leaves, 0 ... 1; default 0 */
    const char* name;   /* for messages; default "obstacle" */
    percale_pose pose;  /* default: as the mesh lies */
} percale_obstacle_settings;

typedef struct percale_seam_settings {
    uint32_t struct_size;
    int contact_while_closing; /* not 0: the cloths meet before it has closed; default 1 */
    int weld;                  /* not 0: no gap is left at rest; backward_euler and tr_bdf2; default 0 */
    double after;              /* s from now until closing begins, 0 ... 1e6; default 0 */
    double over;               /* s, how long closing takes, 0 ... 1e6; default 1 */
    double stiffness;          /* N/m of each stitch, 1e-3 ... 1e9; default 1000 */
    const char* name;          /* for messages; default "seam" */
} percale_seam_settings;

/* What the caller will change later on, for percale_plan_text; not 0: it will. */
typedef struct percale_scripted_changes {
    uint32_t struct_size;
    int obstacles, pins, gravity, wind;
} percale_scripted_changes;

/* Energies, J. Of percale_energy_now the entries after `contact` are 0. */
typedef struct percale_energy {
    uint32_t struct_size;
    double kinetic, gravity;
    double elastic; /* springs, hinges, membranes and the gas in closed cloth */
    double contact; /* of contact and of the springs of sticking friction */
    double work;    /* of pins and obstacles on the cloth during the step */
    double dissipated_material, dissipated_friction, dissipated_contact;
    double dissipated_integrator; /* by the scheme; negative: gained */
    double residual_work;         /* given by forces that the solver left unbalanced */
    double imbalance;
} percale_energy;

/* Report of one step. Energy, strain and speed are NaN where option `measure` leaves them out. */
typedef struct percale_step_report {
    uint32_t struct_size;
    int status;                     /* percale_step_status */
    double time, dt;                /* s, at the end of the step; its length */
    double smallest_dt, largest_dt; /* s, of the parts the step was solved in */
    int parts, rejected;            /* accepted lengths; lengths rejected as too inexact */
    int newton_iterations, linear_iterations, line_search_cuts;
    const char* linear_solver; /* word of option linear_solver, in use at the end; "none" if nothing was solved */
    int halvings;              /* how often a substep was solved again as two halves */
    int dropped_not_converged, dropped_blocked, dropped_not_finite, dropped_inexact; /* why */
    double residual;                                                                 /* relative to the first of the step */
    double smallest_fraction; /* smallest collision-free step size of a move */
    int sleeping_cloths;      /* at rest */
    int slept;                /* 1: all were, the step was not solved */
    int stopped;              /* 1: kinetic damping set all velocities to 0 at its end */
    int contacts;             /* contact constraints at the end */
    double smallest_distance; /* m; infinity if nothing was near */
    double contact_stiffness; /* N/m, largest of the step */
    double largest_strain;    /* of structural springs, (l - l0)/l0 */
    double largest_speed;     /* m/s */
    int blocked_by_pin, blocked_cloth, blocked_vertex, blocking_obstacle; /* of a failed step; -1: none */
    double travel;       /* m, beside the cloth, of an obstacle or a pin that moves too far for a step */
    int pinched;         /* places where obstacles give way to cloth */
    int yielded_in_vain; /* 1, of a failed step: obstacles closed on the cloth and gave way, but not enough */
    double yielded;      /* m, farthest that an obstacle's vertex is from where it should be */
    int pinching[2];     /* obstacles between which the cloth has the smallest room; -1: none */
    int second_obstacle; /* pushes the cloth towards the blocking one; -1: none */
    int stretched_cloth,
        stretched_pins;    /* of a step that failed or did not converge: held by pins, stretched to more than twice its length */
    double stretch;        /* its largest strain */
    uint64_t contact_hash; /* of the contact constraints at the end */
    double kinetic, gravity, elastic, contact, work; /* J, as in percale_energy */
    double dissipated_material, dissipated_friction, dissipated_contact, dissipated_integrator, residual_work, imbalance;
    double refresh_s, evaluate_s, force_s, setup_s, solve_s, cut_s, measure_s; /* CPU seconds of the calling thread */
    double cpu_s;                                                              /* of all threads */
    int out_of_time;   /* 1: percale_set_time_limit ended it before it was solved */
    double time_error; /* m, estimated: what the length of the step costs in accuracy, in the mean of the worst cloth */
    double jump;       /* m, beside the cloth, of what moves so far that the step is made in 8 parts or more */
} percale_step_report;

/* What is wrong with a refused start: an obstacle that the cloth crosses, is inside of or touches, or cloth against cloth. */
typedef struct percale_start_fault {
    uint32_t struct_size;
    int obstacle;                                                /* -1: none */
    int intersecting_pairs;                                      /* of triangles that cross */
    int cloth_triangle, obstacle_triangle, other_cloth_triangle; /* one pair, cloth counted through all cloths; -1: none */
    int vertices_inside;                                         /* cloth vertices inside a watertight obstacle */
    int inside_vertex;                                           /* the deepest of them, counted through all cloths; -1: none */
} percale_start_fault;

/* What the independent check of one cloth against one obstacle found. */
typedef struct percale_certificate {
    uint32_t struct_size;
    int watertight;                                    /* 1: the obstacle is closed, so that depth has a meaning */
    uint64_t intersecting_pairs;                       /* of triangles that intersect, not merely touch */
    uint64_t touching_pairs;                           /* that share points but do not cross */
    int first_cloth_triangle, first_obstacle_triangle; /* of the first such pair that intersects; -1: none */
    int vertices_inside, deepest_vertex;               /* cloth vertices inside a watertight obstacle; -1: none */
    double deepest_penetration;                        /* m; 0 on an open obstacle */
    double smallest_distance;                          /* m, 0 where they intersect; infinity beyond the limit */
} percale_certificate;

/* One option of step settings or of a fabric, as percale_describe_* reports it; texts live as long as the library. */
typedef struct percale_option {
    uint32_t struct_size;
    int takes_auto;  /* 1: the word "auto" is a value */
    int may_be_none; /* 1: the word "none" is a value, and the default unless a preset says otherwise */
    int numbers;     /* how many numbers a value holds: 1, 2, or 0 for words */
    int integer;     /* 1: its number is whole */
    int word_count;  /* of words that are values; a flag has "false" and "true" */
    const char* key;
    const char* unit;       /* "" without one */
    const char* sentence;   /* what it does */
    double lowest, highest; /* of its numbers, both ends included; infinite where there is no limit */
} percale_option;

#endif
