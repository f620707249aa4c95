#pragma once

#include <cstddef>

/// Every numerical constant of the layer that affects a decision. Values that are not chosen stand where they are used: sizes of
/// arrays, numbers of a formula, and the error bounds of the exact predicates (certificate/exact_orientation.cpp), which are
/// proven.
///
/// A constant marked "cost alone" adds and removes no contact: it changes what is stored, queried and measured. It may still
/// change a clamp, and with it the bits of a run: a pair that a bound excludes may use up all of its clearance (distance less
/// floor), a measured pair keeps `clearance_left` of it. Lengths are given as fractions of the thickness, h: the distance below
/// which cloth is in contact, usually 1 mm to 10 mm.
namespace percale::tolerances {

// ---- Shared

/// Sine of an angle. A face next to a closest point rises towards the other side if it does so by more. It covers rounding alone:
/// at 0 a contact above an edge of flat cloth or of a flat obstacle may belong to neither of its triangles and be lost.
constexpr double rising_sine = 1e-9;

/// Factor. It exceeds what a number loses when it is rounded to single precision (6e-8). Below 1 + 6e-8 a bound may be above what
/// it bounds, and a contact is missed.
constexpr float rounded_up = 1.000001F;

/// Fraction of a number. A bound in single precision is moved this far to be surely below, or above, the double that it stands
/// for. See `rounded_up`.
constexpr double rounded_off = 1e-6;

// ---- geometry/

/// Fraction of h. The distance that a clamp leaves where there was more than twice as much. 0: distances collapse to rounding,
/// where the direction of a contact is lost. Larger: cloth is stopped farther out within the activation distance.
constexpr double clamp_floor = 0.2;

/// Fraction of a distance below clamp_floor / clamp_remainder (0.4 h) that a clamp leaves. Towards 1: a vertex that is near can
/// hardly come nearer in one call. Towards 0: one call may use up what the following ones need.
constexpr double clamp_remainder = 0.5;

/// Fraction of h. No clamp leaves less, unless less was there. 0: distances halve until rounding decides.
constexpr double min_clamp_floor = 1e-3;

/// Fraction of a distance below min_clamp_floor that a clamp leaves. 1: such a vertex could not move at all.
constexpr double min_clamp_remainder = 0.999;

/// Times the last digit of the largest coordinate. No clamp leaves less, whatever was there: a smaller distance means nothing.
/// Smaller: features pressed together until rounding decides have crossed. Larger: cloth that is so near cannot move.
constexpr double rounding_of_coordinates = 32.0;

/// Fraction of the clearance (distance less floor) at which conservative advancement stops: a clamp leaves it. Smaller: longer
/// safe moves for more advances. Larger: clamps fall short of what is safe.
constexpr double clearance_left = 0.1;

/// Number of advances after which a pair's time-of-impact lower bound is the last one proven. Too few: clamps fall far short
/// where the clearance is tiny against the displacement. No value is unsafe.
constexpr int max_advances = 500;

/// |ab x ac|^2 over the longest edge to the fourth. Narrower triangles get their weights from cross products. Smaller: closest
/// points on needles have no correct digit. Larger: slower.
constexpr double sliver_area = 1e-6;

/// Fraction of the larger extent of two hulls. libccd's expanding polytope ends there. At libccd's own tolerance, 1e-4 m, depths
/// are wrong by up to 24 mm.
constexpr double hull_depth = 1e-9;

/// Maximum number of libccd's iterations. Without a limit the expanding polytope may not end.
constexpr unsigned long max_hull_iterations = 1000;

/// Triangles of the cloth in a cluster. More: more features are listed again at once. Fewer: more lists to search. The order of
/// the constraints depends on it, and so do the last bits of sums over contacts.
constexpr unsigned long triangles_per_cluster = 8;

// ---- obstacle/

/// Twice the area over the square of the longest edge. Triangles with less are dropped when an obstacle is cleaned. Larger: real
/// needles vanish from the surface. Smaller: triangles without a direction remain.
constexpr double degenerate_area = 1e-14;

/// Length of the sum of two unit vectors. Two triangles continue each other below it, and cloth does not meet their edge. Larger:
/// ridges of finely meshed bodies are taken for flat, and cloth meets only their faces. Smaller: flat faces get edge contacts.
constexpr double flat_fold = 1e-9;

/// Fraction of lengths times areas. A neighbour lies clearly on one side of a triangle's plane above it, so that no exact test is
/// needed. Cost alone while it is above 1e-15.
constexpr double clear_side = 1e-9;

/// Fraction of the obstacle's diagonal. The winding number beyond a face is computed this far from it. Too small: rounding keeps
/// the point on the face. Too large: it lies beyond another face of a thin part, and a face is dropped or kept wrongly.
constexpr double beyond_face = 1e-9;

/// Maximum number of pairs of triangles that the search for internal faces tests, in all and for each triangle. With more pairs
/// the search gives up and all faces stay: correct, with contacts inside the body's overlaps.
constexpr long max_internal_tests = 2000000, max_internal_tests_per_triangle = 200;

/// Triangles of the obstacle in a patch, the unit of a backend's tree. The order of the constraints depends on it, as on the
/// cluster's.
constexpr unsigned long triangles_per_patch = 16;

/// Fraction of coordinates. A box that is turned back to where the tree was built grows by this much. Below the rounding of two
/// rotations (1e-15) patches are missed.
constexpr double turned_box = 1e-9;

/// Twice the area over the square of the longest edge. Narrower triangles have no normal that excludes contacts of an edge.
/// Smaller: a wrong normal may exclude a real contact. Larger: cost alone.
constexpr double needle_area = 1e-4;

/// The same for the bound of a triangle's sharpness. Narrower ones are measured exactly.
constexpr double flat_triangle_area = 1e-12;

/// Constants of the cone of directions in which a vertex can be closest. `ray_below`: dot product of unit vectors up to which a
/// ray is below an edge; 0 loses rays to rounding, the cone gets too narrow and contacts are missed. `parallel_edges`: length of
/// a cross product below which two edges give no ray. The others affect cost alone: length of the sum of rays below which there
/// is no cone; cosine of the widest cone worth a test; edges at the vertex worth the search.
constexpr double ray_below = 1e-6, parallel_edges = 1e-3, min_ray_sum = 0.5, widest_cone = 0.2;
constexpr unsigned long max_cone_edges = 16;

/// Fraction of a pack's size. The kernels subtract it from a distance for some thirty roundings of single precision. Smaller:
/// bounds exceed the distance, and contacts are missed. Larger: more pairs are measured exactly.
constexpr float pack_rounding = 2e-6F;

/// m^2 or m^4. Denominators of the kernels are at least this, so that points and needles cause no division by 0.
constexpr float min_denominator = 1e-37F;

/// m. A bound without information: it is below any distance.
constexpr float no_bound = -1e30F;

/// Margins within which the kernels leave a decision to the exact measurement: a parameter along an edge of a triangle; an area
/// outside a triangle as a fraction of its own; a rise as a fraction of the cloth edge; a parameter along two edges, and that per
/// size over length; sin^2 between two edges; a cosine of a cone. Smaller: rounding refuses contacts. Larger: cost alone.
constexpr float unsure_parameter = 1e-2F, unsure_area = 1e-2F, unsure_rise = 1e-4F;
constexpr float unsure_crossing = 1e-4F, unsure_crossing_per_size = 4e-4F, unsure_parallel = 1e-3F, unsure_cone = 1e-3F;

// ---- lists/

/// Fraction of h, and of the displacement that a list is made for. Margin around a vertex within which its list is valid. Larger:
/// longer lists, which are rebuilt less often. Cost alone.
constexpr double box_skin = 0.4, box_skin_of_displacement = 0.2;

/// Fraction of h. A pack is left out of a list if a plane keeps it farther away than h by this much. Below rounding (1e-15)
/// contacts at h are missed.
constexpr double hull_slack = 1e-6;

/// Maximum number of packs in the lists, in all and for each vertex. A move that needs more is covered in part. Larger: more
/// memory at once (12 bytes a pack). Smaller: a long move takes more calls.
constexpr long max_packs = 500000, max_packs_per_vertex = 40;

/// Fraction of a move. Below it lists are made however many packs they hold. 0: the search might never end.
constexpr double min_covered_fraction = 1e-4;

/// Size of pack and cloth feature over the smallest height of their triangles or the smallest length of their edges. Above it
/// single precision gives no information and a pair is measured exactly. Larger: bounds of needles have no correct digit.
constexpr double max_sharpness = 1e4;

/// Fraction of h. The edge-edge mollifier reaches 1 at the angle at which the ends of the edges are this much farther away than
/// the middle. 0: Newton did not end where threads lie along facets (330 iterations a step instead of 8). Larger: crossings at
/// small angles get too soft.
constexpr double negligible_rise = 1e-3;

/// A mollifier below it counts as 0. It covers rounding alone.
constexpr double min_mollifier = 1e-12;

// ---- detector

/// Fraction of h. The next update of the candidates drops the persistent contacts with obstacles of a vertex that has moved
/// farther than this since they were last dropped. 0: cloth at rest trembles between two sets of contacts. Large: contacts of
/// places that cloth has left stay until it is h away.
constexpr double persistence_displacement = 0.1;

// ---- self/

/// Fraction of h, and of the mean length of a vertex's edges: the lower is its skin. Two clusters may move against each other by
/// it beyond a predicted move before their list is rebuilt; the first also bounds how far one may go before lists are searched
/// for. See box_skin. Cost alone.
constexpr double self_skin = 0.5, self_skin_of_edge = 0.125;

/// Times the room that a step's move takes. The next step rebuilds lists and boxes that long trial moves have left with more.
/// Small: they are rebuilt often. Large: they keep features that are far away. Cost alone.
constexpr double max_room_ratio = 4.0;

/// A list may keep memory for this many elements beside twice what it holds; it reserves half of them, and an eighth of what it
/// holds. Fewer: lists of cloth that hardly moves allocate. Cost alone.
constexpr std::size_t spare_elements = 8;

/// Cloth against cloth: how many clusters and lists a thread takes at once, and after how many lists the pairs considered are
/// counted.
constexpr std::size_t self_clusters_a_part = 64, self_lists_a_part = 16, self_lists_a_round = 1024;

/// Fraction of the distance at rest below which two features of one cloth are in contact at the latest. Above 1: a mesh finer
/// than its thickness pushes itself apart at rest. Small: a fold closes to nearly nothing at its crease.
constexpr double rest_activation_ratio = 0.5;

/// The same fraction on the path through a seam. Each side of a seam is sampled in its own way, so that edges from places close
/// to each other lie across each other where it is folded: at 0.5 such a fold cannot close below 60 degrees, and contact holds
/// the seam open. 0: nothing keeps its sides apart near it.
constexpr double seam_activation_ratio = 0.1;

/// Maximum number of pairs of cloth with cloth that are considered for one move, in all and for each vertex; there may be one
/// list for each `pairs_per_list` of them. See max_packs.
constexpr long max_self_pairs = 4000000, max_self_pairs_per_vertex = 300, pairs_per_list = 16;

/// Sine (17 degrees). Edges whose closest points are interior are in contact below h where all faces beside them fall away by as
/// much, below h/2 where they are flat, as vertices meet faces there, and not where one rises by as much; in between the ratio is
/// linear. Smaller: cloth that bends a little gains and loses such contacts, and never comes to rest. Larger: ridges are no
/// contacts, or one contact counts twice.
constexpr double sharp_sine = 0.3;

/// Fraction of h below which every pair of the lists is in contact, a local minimum or not: near a seam the features that lie
/// closer may be no pairs, as they share a stitched point. 0: nothing holds such a pair apart until the clamp stops it, and
/// Newton makes no progress (3,000 iterations a step, distances of 1e-17 m). Large: one contact counts several times.
constexpr double min_activation_ratio = 0.1;

/// Within a step a contact takes a new activation distance only if it is more than this many times the one that it began with:
/// from min_activation_ratio to that of a local minimum. 1: it grows with every move within a step.
constexpr double widened_activation_ratio = 3.0;

/// Sine (2 degrees). Edges at smaller angles have no contact of their own, but their ends have; the activation distance grows to
/// all of h at twice the sine. 0: closest points jump from end to end of parallel threads.
constexpr double min_crossing_sine = 0.03;

/// Fraction of h, the thickness of the pair. Two edges of which the shorter rises by more over its length have a contact at any
/// angle: the ends may be too far apart to hold them. Larger: long edges approach slowly until the clamp stops them for good.
/// Smaller: closest points jump.
constexpr double min_crossing_rise = 0.2;

/// Minimum activation ratio of two features of one cloth, whatever their distance at rest: sheets of one mesh that lie edge to
/// edge, or split along a line, would have no contact there. 0: only the clamp keeps them apart. Large: a mesh that is this much
/// finer than its thickness pushes itself apart at rest.
constexpr double min_rest_activation_ratio = 0.01;

// ---- untangle/

/// (l - l0)/l0. A route that stretches an edge by more tears: others are preferred. The engine relaxes what is stretched.
constexpr double max_stretch = 0.5;

/// Number of sample points along each axis of the box about cloth, by which it is found what the cloth surrounds. More:
/// untangling takes longer. Fewer: a skirt may leave the body that it was put on.
constexpr int enclosure_places = 8;

/// Fraction of the diagonal of that box by which it grows, so that no sample point is in the plane of flat cloth.
constexpr double enclosure_room = 0.01;

/// Cloth that surrounds at least this many sample points inside an obstacle must still surround it afterwards. Smaller: chance
/// decides.
constexpr int min_surrounded = 4;

/// Sample points from the middle of a rim to its vertices that test whether an obstacle passes through it. Fewer: legs are
/// missed.
constexpr double fan_places[] = {0.0, 0.25, 0.5, 0.75, 0.95};

/// Roundings of the largest coordinate within which vertices of cloth are in one place at a start. 0: a tube whose rims are 6e-17
/// m apart does not end its first step. More than some hundred: intended gaps of a mesh are closed.
constexpr double joined_roundings = 32.0;

/// Size of the cells in which such places are searched for, in units of that distance. Cost alone.
constexpr double cell_of_joined_places = 1024.0;

/// Fraction of h that moved cloth keeps from obstacles. Less than clamp_floor would start the run within the floor of clamps.
/// Towards 1: narrow places have no exit.
constexpr double untangled_gap = 0.25;

/// Length lost by a move for each length along the cloth. 1: edges may double or vanish; 0.5 stretches them by at most 12 %.
/// Small: cloth far away moves, too.
constexpr double move_slope = 0.5;

/// Factor by which a route that was too short grows, and how often the last growth is bisected. They affect cost, and how close
/// the route is to the shortest.
constexpr double reach_growth = 1.5;
constexpr int reach_refinements = 4;

/// Cosine between two directions above which they are one route. Smaller: routes are missed. Larger: searches are repeated.
constexpr double same_direction = 0.999;

/// Times h. Vertices that are farther away are not pushed to the nearest places of the surface.
constexpr double farthest_push = 8.0;

/// Limits at which untangling gives up: patches in all; rounds of one route; successive obstacles that cloth cannot be pushed out
/// of at once; searches for conflicts. Larger: hopeless starts take longer (seconds now). Smaller: solvable ones are refused.
constexpr int max_patches = 256, max_route_rounds = 60, max_push_failures = 64;
constexpr long max_conflict_searches = 4000;

/// Cloth through cloth. Fraction of the mean edge by which a round moves a vertex: a larger one overshoots thin layers, a smaller
/// one takes more rounds. Length of a retreat vector (2 is the longest where an edge stands upright) at which half of the move is
/// made: at 0 vertices whose retreat vectors nearly vanish jump about.
constexpr double retreat_ratio = 0.05, min_retreat = 0.1;

/// Strain that edges may have while cloth comes apart, and the number of sweeps over all edges in a round that enforce it. They
/// affect cost, and how much the engine has to relax afterwards.
constexpr double bond_slack = 0.05;
constexpr int bond_sweeps = 4;

/// Fraction of the mean edge. Vertices that a stitch holds nearer than this are one vertex while cloth comes apart. Larger: open
/// seams are drawn together at once. Smaller: cloth is taken for torn where a seam gapes a little, and crosses itself there
/// endlessly.
constexpr double closed_stitch = 0.25;

/// Fractions of the mean edge: the distance from a lower layer within which cloth is moved outside of it, and the gap to which it
/// is moved. Larger reach: cloth is taken for that of the other side of a limb. Larger gap: cloth is stretched more.
constexpr double layer_reach = 2.0, layer_gap = 0.05;

/// Fraction of that gap. A place with this gap is left as it is, so that the rounds end.
constexpr double enough_gap = 0.8;

/// Maximum number of rounds in which layers are ordered. It affects cost, and how deep layers may lie in each other.
constexpr int max_layer_rounds = 60;

/// Fraction of area to the power 3/2. A cloth whose normals enclose less than three times that volume is a flat sheet. A tube ten
/// times as long as wide encloses 0.1.
constexpr double min_enclosing = 0.02;

/// Number of rounds without fewer crossings after which cloth near the last ones is smoothed, and the number of rings of vertices
/// around them that are smoothed. Fewer rounds: folds are ironed that would have come apart. More rings: more cloth is moved.
constexpr int idle_rounds_before_smoothing = 20, smoothed_rings = 2;

/// All cloth is searched for crossings every `rounds_between_searches` rounds, and when none are known; the other rounds search
/// `searched_rings` rings of vertices around those found last. Cost alone.
constexpr int rounds_between_searches = 10, searched_rings = 3;

/// Maximum number of rounds of untangling cloth from cloth, and of successive rounds without fewer crossings. Larger: hopeless
/// starts take longer (16,000 triangles: 30 ms a round). Smaller: solvable ones are refused.
constexpr int max_untangle_rounds = 600, max_idle_rounds = 100;

/// Barycentric. A ray meets a triangle up to this far beyond its rim, so that it does not slip through an edge between two of
/// them.
constexpr double ray_rim = 1e-9;

/// Fraction of the obstacle's diagonal. Distance beyond an intersection at which it is tested whether a ray is outside. See
/// beyond_face.
constexpr double beyond_exit = 1e-9;

/// Fraction of the triangle's size. A vertex nearer to its triangle leaves along the normal, because its own direction is
/// rounding.
constexpr double on_triangle = 1e-9;

// ---- certificate/ and the users of its trees. Nothing here decides whether triangles cross: that test is exact.

/// Fraction of a distance. A bound must exceed a distance by this much to exclude a pair, because of rounding (1e-15). 0: the
/// smallest distance may be that of the second nearest pair, in its last digits.
constexpr double bound_slack = 1e-9;

/// m. Coordinates of larger magnitude are refused. Squares of areas overflow above 1e77.
constexpr double largest_coordinate = 1e75;

/// Triangles in a leaf of a tree. Cost alone.
constexpr int leaf_size = 4;

/// A split must leave one item in this many on each side, else the items are halved by number. Keeps the depth logarithmic: with
/// a split that may leave one item alone, meshes made of ever smaller parts give trees as deep as they have triangles.
constexpr int max_uneven_split = 8;

// ---- attach/

/// Twice the area over the product of two edges: the sine between them. Points are not attached to flatter triangles, which have
/// no normal.
constexpr double flat_triangle = 1e-9;

// ---- bullet/

/// Fraction of the obstacle's diagonal. The box in which Bullet quantises, and against which queried boxes are tested first, is
/// larger than the obstacle by this much.
constexpr double quantised_box = 1e-6;

/// Cosine between the directions of two constraints of one cloth feature above which a local minimum of the distance replaces a
/// constraint that is a minimum no longer. Smaller: forces turn suddenly where cloth passes an edge. Larger: cloth that slides
/// over an edge is pushed twice, which sets a sheet that slides on a plane of two triangles trembling.
constexpr double replaced_direction = 0.9;

/// Fraction of the thickness. Obstacle points nearer to each other are one place. Smaller: rounding keeps two constraints at one
/// place apart. Larger: there is nothing to gain, because rounding is far below.
constexpr double same_place = 1e-6;

/// Vertices and clusters in a chunk of a pass over all of them, and clusters in a chunk of lists to rebuild. Cost alone. More:
/// threads wait for the last chunk. Fewer: chunks cost more to hand out than to do.
constexpr unsigned vertices_a_part = 1024, clusters_a_pass = 128, clusters_a_build = 4;

/// Clusters in a chunk of the search for contacts (cost alone), and in a chunk of a clamp, within which the limit of one cluster
/// narrows the search of the next. More: threads wait for the last chunk. Fewer: clamps measure pairs that an earlier cluster
/// would have excluded.
constexpr unsigned clusters_a_part = 8, clusters_per_clamp = 32;

}  // namespace percale::tolerances
