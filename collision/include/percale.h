#ifndef PERCALE_H
#define PERCALE_H

/* The C interface of Percale, C99: for hosts written in C and for those that load libpercale.so. C++ has <percale/simulation.h>.
 *
 * Errors. Calls that can fail give a percale_status, and percale_last_error gives a text. A call that does not give PERCALE_OK
 * leaves everything as it was and writes nothing to its results, unless its comment says otherwise. After
 * PERCALE_OUT_OF_MEMORY or PERCALE_INTERNAL_ERROR from a call that changes a simulation, that one may be half changed: destroy
 * it. NULL where a pointer is needed is an error, too. Nothing throws through this interface.
 *
 * Memory. Numbers belong to the caller: the library copies what it is given before a call returns, and writes results into
 * buffers whose capacity the caller states, in items. Such calls set *count to how many items there are, also where the buffer is
 * too small; a NULL buffer of capacity 0 only asks for that number. count may be NULL where a buffer is given. Views (..._view)
 * are the library's memory, valid until the next call that changes the simulation. Positions, velocities and forces are x y z in
 * a row.
 *
 * Threads. One thread at a time for each object, in any call except percale_set_cancel; different objects are independent of
 * each other. Functions without an object may be called from any thread.
 *
 * Units. m, kg, s, N, J; y is up; triangles counter-clockwise seen from outside. Numbers of cloths, obstacles and seams are 0, 1,
 * ... in the order in which they were added; numbers of removed objects are not given again. */

#include "percale/c_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Library ---- */

/* "major.minor.patch" of the library that is running. Lives as long as the library. */
const char* percale_version(void);
/* A short text of a status, or "unknown status". Lives as long as the library. */
const char* percale_status_text(percale_status status);
/* A short word of a percale_step_status, or "unknown status". Lives as long as the library. */
const char* percale_step_status_text(int status);
/* What was wrong with the last failed call on this simulation, "" before the first. NULL: the last failed call of this
 * thread, with any object. Valid until the next call that fails. */
const char* percale_last_error(const percale_simulation* simulation);
/* Whether this build has a detector: 1 for "none" and those built, else 0, also for unknown words and NULL. */
int percale_has_detector(const char* detector);

/* ---- Structs ---- */

/* Each sets all fields to their defaults and struct_size to the one given, sizeof of the struct as the caller was compiled.
 * Another size than the library knows is an error. */

percale_status percale_init_setup(percale_setup* setup, size_t struct_size);
percale_status percale_init_workers(percale_workers* workers, size_t struct_size);
percale_status percale_init_cloth_settings(percale_cloth_settings* settings, size_t struct_size);
percale_status percale_init_obstacle_settings(percale_obstacle_settings* settings, size_t struct_size);
percale_status percale_init_seam_settings(percale_seam_settings* settings, size_t struct_size);
percale_status percale_init_scripted_changes(percale_scripted_changes* changes, size_t struct_size);
percale_status percale_init_energy(percale_energy* energy, size_t struct_size);
percale_status percale_init_step_report(percale_step_report* report, size_t struct_size);
percale_status percale_init_start_fault(percale_start_fault* fault, size_t struct_size);
percale_status percale_init_certificate(percale_certificate* certificate, size_t struct_size);
percale_status percale_init_option(percale_option* option, size_t struct_size);
/* The pose that leaves everything where it is. */
percale_pose percale_identity_pose(void);

/* ---- Step settings and fabrics: options by their keys, those of [step] and [fabric] in a scene file ---- */

/* All options at their defaults. */
percale_status percale_create_step_settings(percale_step_settings** settings);
/* NULL does nothing. Simulations that were made with them keep their own copy. */
void percale_destroy_step_settings(percale_step_settings* settings);
/* A value as text: a number ("0.01"), a whole number, "true" or "false", a word, "auto" or "none" where the option takes it, or
 * two numbers with a space or comma between. Errors name the key and its range or words. Unlike in a scene file, a time_step of
 * "auto" leaves the scheme as it is. A key is also found by the name that it had in the release before. */
percale_status percale_set_step_option(percale_step_settings* settings, const char* key, const char* value);
/* The same of options that hold one number, every bit of it kept. */
percale_status percale_set_step_number(percale_step_settings* settings, const char* key, double value);
/* The value as percale_set_step_option takes it, with as many digits as keep every bit. capacity and count: in bytes, the closing
 * 0 included. */
percale_status percale_step_option(const percale_step_settings* settings, const char* key, char* text, size_t capacity,
                                   size_t* count);
/* How many options there are; their numbers are 0, 1, ... */
size_t percale_step_option_count(void);
/* What an option is: key, unit, range, words. option: a struct that percale_init_option prepared. */
percale_status percale_describe_step_option(size_t number, percale_option* option);
/* The word of that number of an option of words; NULL where there is none. Lives as long as the library. */
const char* percale_step_option_word(size_t number, int word);

/* preset: NULL for all defaults, or a name of percale_fabric_preset_name: moduli along warp and weft. */
percale_status percale_create_fabric(const char* preset, percale_fabric** fabric);
/* NULL does nothing. Cloth that was made of it keeps its own copy. */
void percale_destroy_fabric(percale_fabric* fabric);
/* As percale_set_step_option. Options that exclude each other are refused by percale_add_cloth. */
percale_status percale_set_fabric_option(percale_fabric* fabric, const char* key, const char* value);
/* As percale_set_step_number. */
percale_status percale_set_fabric_number(percale_fabric* fabric, const char* key, double value);
/* As percale_step_option. */
percale_status percale_fabric_option(const percale_fabric* fabric, const char* key, char* text, size_t capacity, size_t* count);
/* How many options there are; their numbers are 0, 1, ... */
size_t percale_fabric_option_count(void);
/* As percale_describe_step_option. */
percale_status percale_describe_fabric_option(size_t number, percale_option* option);
/* As percale_step_option_word. */
const char* percale_fabric_option_word(size_t number, int word);
/* The same for meshes without a direction of warp: shear_stiffness is kept, stretch_stiffness becomes the matching value. */
percale_status percale_make_fabric_isotropic(percale_fabric* fabric);
/* How many presets there are; their numbers are 0, 1, ... */
size_t percale_fabric_preset_count(void);
/* NULL where there is no preset of that number. Lives as long as the library. */
const char* percale_fabric_preset_name(size_t number);
/* Where the numbers of that preset come from; likewise. */
const char* percale_fabric_preset_source(size_t number);

/* ---- Meshes ---- */

/* vertices: m, three numbers each; triangles: three indices each. Requirements of cloth and obstacles are checked when the mesh
 * is added; an index out of range is an error here. */
percale_status percale_create_mesh(const double* vertices, size_t vertex_count, const int* triangles, size_t triangle_count,
                                   percale_mesh** mesh);
/* Flat grid in y = 0, centred, vertex (column c, row r) at index r * columns + c. width, depth: m, > 0; columns, rows: >= 2. */
percale_status percale_make_grid(double width, double depth, int columns, int rows, percale_mesh** mesh);
/* Icosahedron divided level times, 0 ... 8; radius: m, > 0. */
percale_status percale_make_sphere(double radius, int level, percale_mesh** mesh);
/* Axis-parallel, centred; edge lengths x y z: m, > 0. */
percale_status percale_make_box(const double* size, percale_mesh** mesh);
/* Closed, about the y axis, centred; radius, height: m, > 0; segments: >= 3 around. */
percale_status percale_make_cylinder(double radius, double height, int segments, percale_mesh** mesh);
/* About the y axis; height: m, >= 0, between the centres of its half spheres; segments: >= 4 around, a multiple of 4. */
percale_status percale_make_capsule(double radius, double height, int segments, percale_mesh** mesh);
/* Horizontal square at y = 0, normals up; half_size: m, > 0. */
percale_status percale_make_plane(double half_size, percale_mesh** mesh);
void percale_destroy_mesh(percale_mesh* mesh); /* NULL does nothing */
/* Views that live as long as the mesh; NULL on an error. count: of vertices, or of triangles; may be NULL. */
const double* percale_mesh_vertices_view(const percale_mesh* mesh, size_t* count);
const int* percale_mesh_triangles_view(const percale_mesh* mesh, size_t* count);

/* Exact check of a cloth against an obstacle that shares no code with the solver, both in world coordinates. distance_limit: m,
 * >= 0, up to which the smallest distance is searched for; INFINITY: all. */
percale_status percale_certify(const percale_mesh* cloth, const percale_mesh* obstacle, double distance_limit,
                               percale_certificate* certificate);
/* Exact count of the triangle pairs of a cloth, all its pieces in one mesh, that cross, and of those that only touch. */
percale_status percale_certify_cloth(const percale_mesh* cloth, size_t* crossing_pairs, size_t* touching_pairs);
/* Strain along warp, along weft, and shear (rad) of every triangle, three numbers each; capacity: of triangles, as many as the
 * mesh has. settings: as given to percale_add_cloth, its pose's scale is applied; NULL: all defaults. positions: m, of all
 * vertices of the mesh. */
percale_status percale_triangle_strains(const percale_mesh* mesh, const percale_cloth_settings* settings, const double* positions,
                                        size_t vertex_count, double* strains, size_t capacity);

/* ---- Simulation: what is in it ---- */

/* PERCALE_NOT_BUILT for a detector that this build lacks. */
percale_status percale_create_simulation(const percale_setup* setup, percale_simulation** simulation);
void percale_destroy_simulation(percale_simulation* simulation); /* NULL does nothing */
/* Cloth starts as the mesh at its pose, which is its rest shape, too, unless the settings hold another. settings: NULL for all
 * defaults. Mesh and fabric are copied. *cloth: its number. */
percale_status percale_add_cloth(percale_simulation* simulation, const percale_mesh* mesh, const percale_fabric* fabric,
                                 const percale_cloth_settings* settings, int* cloth);
/* Needs a detector. settings: NULL for all defaults. *obstacle: its number. */
percale_status percale_add_obstacle(percale_simulation* simulation, const percale_mesh* mesh,
                                    const percale_obstacle_settings* settings, int* obstacle);
/* Sews vertices of the first cloth to points of the second, which may be the same. settings: NULL for all defaults. *seam: its
 * number. */
percale_status percale_add_seam(percale_simulation* simulation, const int cloths[2], const percale_stitch* stitches, size_t count,
                                const percale_seam_settings* settings, int* seam);
/* Contact of two cloths with self_contact, or of one with itself: contact 0 or not 0; thickness: m, 1e-6 ... 1, below which they
 * are in contact, NULL: the mean of theirs. */
percale_status percale_set_pair(percale_simulation* simulation, int first, int second, int contact, const double* thickness);
/* Layer in which a cloth with self_contact is worn, from the inside out, -1000 ... 1000. */
percale_status percale_set_layer(percale_simulation* simulation, int cloth, int layer);
/* Takes a cloth out, with its seams, pairs and layer. All other numbers stay valid; its own, and those of its seams, are errors
 * from then on. The rest keeps its state and wakes up. States saved before are refused. */
percale_status percale_remove_cloth(percale_simulation* simulation, int cloth);
/* The same for an obstacle; cloth wakes up only if it was in contact with it. */
percale_status percale_remove_obstacle(percale_simulation* simulation, int obstacle);
/* Another fabric, copied, for a cloth whose mesh, rest shape, positions, velocities and pins stay. Contacts are dropped where
 * thickness, friction, self_contact or the order of the springs changes, or a strain limit comes or goes: the next step then
 * checks the start as percale_prepare does. Costs as much as adding a cloth. States saved before are refused. */
percale_status percale_set_fabric(percale_simulation* simulation, int cloth, const percale_fabric* fabric);
/* Coulomb coefficient of an obstacle against cloth from the next step on, 0 ... 10. */
percale_status percale_set_friction(percale_simulation* simulation, int obstacle, double friction);
/* Share of its normal speed with which cloth that hits the obstacle leaves, from the next step on, 0 ... 1. */
percale_status percale_set_restitution(percale_simulation* simulation, int obstacle, double restitution);

/* ---- Simulation: what moves ---- */

/* Holds a vertex where it is; its velocity becomes 0. A pinned vertex may be pinned again. */
percale_status percale_pin(percale_simulation* simulation, int cloth, int vertex);
/* Releases a pinned vertex; it is an error if the vertex is not pinned. */
percale_status percale_unpin(percale_simulation* simulation, int cloth, int vertex);
/* target: m, where a pinned vertex is at the end of the next step; it then stays there. */
percale_status percale_move_pin(percale_simulation* simulation, int cloth, int vertex, const double* target);
/* Where an obstacle is at the end of the next step; it then stays there. Its scale must not change. Beyond 64 times 20
 * thicknesses in a step beside cloth the step fails: what jumps is teleported. */
percale_status percale_move_obstacle(percale_simulation* simulation, int obstacle, const percale_pose* end);
/* m, where all vertices of a deforming obstacle are at the end of the next step, in the axes of its mesh; they then stay there.
 */
percale_status percale_deform_obstacle(percale_simulation* simulation, int obstacle, const double* end, size_t vertex_count);
percale_status percale_set_gravity(percale_simulation* simulation, const double* gravity); /* m/s^2, -1e4 ... 1e4 */
/* Velocity of the air, m/s, -1e3 ... 1e3; before the first call there is no air unless percale_setup has some. */
percale_status percale_set_wind(percale_simulation* simulation, const double* velocity);
percale_status percale_set_time_step(percale_simulation* simulation, double time_step); /* s, 1e-7 ... 1 */
percale_status percale_set_work_limit(percale_simulation* simulation, int iterations);  /* 0 (none) ... 50000 a step */
/* Wall time of a step, s, 1e-6 ... 1e6; 0: none. A step that has used it up is accepted as it is, and reports out_of_time;
   where pins and obstacles have not arrived after some 20 iterations more it fails (PERCALE_STEP_WORK_LIMIT). */
percale_status percale_set_time_limit(percale_simulation* simulation, double seconds);
/* While wish is not 0 a step ends within a few iterations and fails (PERCALE_STEP_CANCELLED), nothing moves, and a start
 * with initial penetration is refused. For hosts that have to stop: any thread may call it, and a signal handler, while another
 * thread is in a call of this simulation. */
percale_status percale_set_cancel(percale_simulation* simulation, int wish);
/* m, and m/s, -1e9 ... 1e9, of all vertices of a cloth. For starts that are not at rest. */
percale_status percale_set_positions(percale_simulation* simulation, int cloth, const double* positions, size_t vertex_count);
percale_status percale_set_velocities(percale_simulation* simulation, int cloth, const double* velocities, size_t vertex_count);
/* Puts a cloth back to where it was added, at rest; its contacts are dropped. Pins stay, where it was added, and so do time,
 * seams, fabric and layers. The next step checks the start as percale_prepare does. */
percale_status percale_reset(percale_simulation* simulation, int cloth);
/* Moves cloths and obstacles together by a rigid motion of the world (scale 1), in no time. counts: of cloths, of obstacles; a
 * list of none may be NULL. keep_velocities: 0 clears them, else they turn along. */
percale_status percale_teleport(percale_simulation* simulation, const int* cloths, const int* obstacles, const size_t counts[2],
                                const percale_pose* motion, int keep_velocities);

/* ---- Simulation: steps ---- */

/* Checks the scene as a whole; the first step calls it, and the first after a change that needs it. Cloth that starts through,
 * inside or touching something is moved out (option `start`), or PERCALE_START_REFUSED. */
percale_status percale_prepare(percale_simulation* simulation);
/* The moves of the last percale_prepare that found something to check. */
percale_status percale_start_repair(const percale_simulation* simulation, percale_start_move* moves, size_t capacity,
                                    size_t* count);
/* What was wrong with the start that was last refused; all -1 or 0 before one was. */
percale_status percale_last_start_fault(const percale_simulation* simulation, percale_start_fault* fault);
/* Advances by the time step. report: NULL, or a struct that percale_init_step_report prepared; with PERCALE_STEP_FAILED it is
 * filled, too. A step that fails leaves the state as it was and keeps the targets of pins and obstacles. Gives what
 * percale_prepare gives, before anything moves. */
percale_status percale_step(percale_simulation* simulation, percale_step_report* report);
/* One sentence with figures on the last step that was made or failed; "" before one was, NULL on an error. Valid until the next
 * step. */
const char* percale_explanation(const percale_simulation* simulation);
/* The plan of the coming steps, what it leaves out and why, and what will go wrong, as lines of text; runs nothing. changes:
 * what the caller will change later on; NULL: nothing. capacity and count: in bytes, the closing 0 included. */
percale_status percale_plan_text(const percale_simulation* simulation, const percale_scripted_changes* changes, char* text,
                                 size_t capacity, size_t* count);
/* Everything that the coming steps depend on, in bytes: a simulation made by the same calls that takes them by percale_restore
 * makes the same steps in every bit. Asking for the size costs as much as saving. Numbers are laid out as on this machine. */
percale_status percale_save(const percale_simulation* simulation, void* bytes, size_t capacity, size_t* count);
/* Refuses bytes that are truncated, damaged, of another version or of a simulation with other contents or settings. */
percale_status percale_restore(percale_simulation* simulation, const void* bytes, size_t size);

/* ---- Simulation: what it is like now ---- */

/* s of simulated time. */
percale_status percale_time(const percale_simulation* simulation, double* time);
/* How many cloths there are, without those that were removed. */
percale_status percale_cloth_count(const percale_simulation* simulation, int* count);
/* Of one cloth. */
percale_status percale_vertex_count(const percale_simulation* simulation, int cloth, size_t* count);
/* m and m/s, three numbers a vertex; capacity and count: of vertices. */
percale_status percale_positions(const percale_simulation* simulation, int cloth, double* positions, size_t capacity,
                                 size_t* count);
percale_status percale_velocities(const percale_simulation* simulation, int cloth, double* velocities, size_t capacity,
                                  size_t* count);
/* Lumped masses, kg, one number a vertex. */
percale_status percale_masses(const percale_simulation* simulation, int cloth, double* masses, size_t capacity, size_t* count);
/* Numbers of the vertices that are pinned, ascending. */
percale_status percale_pinned_vertices(const percale_simulation* simulation, int cloth, int* vertices, size_t capacity,
                                       size_t* count);
/* Unit normals of the vertices, world, three numbers each: of the triangles around each the mean by area, on the side from which
 * they run counter-clockwise. 0 0 0 where there is none: no triangles, none with an area, or they cancel. */
percale_status percale_normals(const percale_simulation* simulation, int cloth, double* normals, size_t capacity, size_t* count);
/* keep: 0 or not 0. From now on each step first notes where the cloth is, 24 bytes a vertex, for percale_interpolate; not part of
 * saved states. */
percale_status percale_keep_previous_positions(percale_simulation* simulation, int keep);
/* Where the cloth is, m, at a fraction, 0 ... 1, of the last step, on straight lines from before it to now; an error unless
 * positions are kept. Present positions where nothing lies between: before the first step since they are kept, after a step that
 * failed, and for cloth that was placed meanwhile. */
percale_status percale_interpolate(const percale_simulation* simulation, double fraction, int cloth, double* positions,
                                   size_t capacity, size_t* count);
/* Views; NULL on an error. count: of vertices; may be NULL. */
const double* percale_positions_view(const percale_simulation* simulation, int cloth, size_t* count);
const double* percale_velocities_view(const percale_simulation* simulation, int cloth, size_t* count);
const double* percale_masses_view(const percale_simulation* simulation, int cloth, size_t* count);
/* Where an obstacle is now; its scale is that it was added with. */
percale_status percale_obstacle_pose(const percale_simulation* simulation, int obstacle, percale_pose* pose);
/* m, before its pose, the vertices of a deforming or compliant obstacle; of a rigid one none. */
percale_status percale_obstacle_shape(const percale_simulation* simulation, int obstacle, double* vertices, size_t capacity,
                                      size_t* count);
/* energy: a struct that percale_init_energy prepared. */
percale_status percale_energy_now(const percale_simulation* simulation, percale_energy* energy);
/* Of structural springs, (l - l0)/l0, now; cloth: its number, or -1 for all. */
percale_status percale_largest_strain(const percale_simulation* simulation, int cloth, double* strain);
percale_status percale_largest_speed(const percale_simulation* simulation, double* speed); /* m/s, of a vertex */
/* Forces of obstacles on the vertices of a cloth at the end of the last step that was solved, sorted by vertex and obstacle. */
percale_status percale_contact_loads(const percale_simulation* simulation, int cloth, percale_contact_load* loads,
                                     size_t capacity, size_t* count);
/* Force of all cloth on an obstacle, N, x y z. For cloth at rest that nothing else holds it is the weight. */
percale_status percale_force_on(const percale_simulation* simulation, int obstacle, double* force);
/* Torque of the same forces about a point (m, world), N m, x y z: the sum of (cloth_point - about) x force, so that body and
 * cloth keep their angular momentum. */
percale_status percale_torque_on(const percale_simulation* simulation, int obstacle, const double* about, double* torque);
/* Steps from now on sum up the impulses of contact on obstacles; 0: no longer, which costs nothing. Not part of saved states. */
percale_status percale_keep_impulses(percale_simulation* simulation, int keep);
/* Impulse of all cloth on an obstacle in the last step, impacts included, N s, x y z: a rigid body that receives it and the cloth
 * keep their momentum. Zero after a step that failed and after percale_restore. An error unless impulses are kept. */
percale_status percale_impulse_on(const percale_simulation* simulation, int obstacle, double* impulse);
/* The angular momentum of the same about a point (m, world), N m s, x y z. */
percale_status percale_angular_impulse_on(const percale_simulation* simulation, int obstacle, const double* about,
                                          double* impulse);
/* *meet: 1 where the two cloths, or the cloth with itself, meet now, else 0. */
percale_status percale_meets(const percale_simulation* simulation, int first, int second, int* meet);
/* m, how far apart the sides of each stitch are. */
percale_status percale_seam_gaps(const percale_simulation* simulation, int seam, double* gaps, size_t capacity, size_t* count);
/* A hash of every bit of positions and velocities. */
percale_status percale_state_hash(const percale_simulation* simulation, uint64_t* hash);

#ifdef __cplusplus
}
#endif

#endif
