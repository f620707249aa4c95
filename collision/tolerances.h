#pragma once

#include <cstddef>

/// Every numerical constant of the layer that decides something. What is no choice stands where it is used: sizes of arrays,
/// numbers of a formula, and the error bounds of the exact predicates (certificate/exact_orientation.cpp), which are proven.
///
/// A constant of "cost alone" adds and removes no contact: it changes what is stored, asked and measured. It may still move a
/// cut, and with it the bits of a run: a pair that a bound excuses may use up all of its clearance (distance less floor), one
/// that is measured leaves `clearance_left` of it. Lengths are given as fractions of the thickness, h: the distance below which
/// cloth is in contact, usually 1 mm to 10 mm.
namespace percale::tolerances {

// ---- Shared

/// Sine of an angle. A face next to a closest point rises towards the other side if it does so by more. Rounding alone: at 0 a
/// contact above an edge of flat cloth or of a flat obstacle may belong to neither of its triangles and be lost.
constexpr double rising_sine = 1e-9;

/// Factor. More than a number loses when it is rounded to single precision (6e-8). Below 1 + 6e-8 a bound may be above what it
/// bounds, and a contact is missed.
constexpr float rounded_up = 1.000001F;

/// Fraction of a number. How far a bound in single precision is moved to be surely below, or above, the double it stands for. As
/// `rounded_up`.
constexpr double rounded_off = 1e-6;

// ---- geometry/

/// Fraction of h. The distance that a cut leaves where there was more than twice as much. 0: distances collapse to rounding,
/// where the direction of a contact is lost. Larger: cloth is stopped farther out in the zone where contact forces act.
constexpr double cut_floor = 0.2;

/// Fraction of a distance below cut_floor / cut_remainder (0.4 h) that a cut leaves. Towards 1: a vertex that is near can hardly
/// come nearer in one call. Towards 0: one call may use up what the following ones need.
constexpr double cut_remainder = 0.5;

/// Fraction of h. No cut leaves less, unless less was there. 0: distances halve until rounding decides.
constexpr double least_cut_floor = 1e-3;

/// Fraction of a distance below least_cut_floor that a cut leaves. 1: such a vertex could not move at all.
constexpr double least_cut_remainder = 0.999;

/// Times the last digit of the largest coordinate. No cut leaves less, whatever was there: a distance below is none. Smaller:
/// what was pressed together until rounding decides has crossed. Larger: cloth that is so near cannot move.
constexpr double rounding_of_coordinates = 32.0;

/// Fraction of the clearance (distance less floor) at which conservative advancement stops: a cut leaves it. Smaller: longer safe
/// moves for more advances. Larger: cuts fall short of what is safe.
constexpr double clearance_left = 0.1;

/// Advances after which a pair's safe time is the last one proven. Too few: cuts fall far short where the clearance is tiny
/// against the displacement. Never unsafe.
constexpr int most_advances = 500;

/// |ab x ac|^2 over the longest edge to the fourth. Narrower triangles get their weights from cross products. Smaller: closest
/// points on needles have no right digit. Larger: slower.
constexpr double sliver_area = 1e-6;

/// Fraction of the larger extent of two hulls. Where libccd's expanding polytope ends. At libccd's own 1e-4 m depths are wrong by
/// up to 24 mm.
constexpr double hull_depth = 1e-9;

/// libccd's iterations. Without a limit the expanding polytope may not end.
constexpr unsigned long most_hull_iterations = 1000;

/// Triangles of the cloth in a cluster. More: more features are listed anew at once. Fewer: more lists to look at. The order of
/// rows depends on it, and so do the last bits of sums over contacts.
constexpr unsigned long triangles_per_cluster = 8;

// ---- obstacle/

/// Twice the area over the square of the longest edge. Triangles with less are dropped when an obstacle is cleaned. Larger: real
/// needles vanish from the surface. Smaller: triangles without a direction are left.
constexpr double degenerate_area = 1e-14;

/// Length of the sum of two unit vectors. Two triangles continue each other below it, and cloth does not meet their edge. Larger:
/// ridges of finely meshed bodies are taken for flat, and cloth meets only their faces. Smaller: flat faces get edge contacts.
constexpr double flat_fold = 1e-9;

/// Fraction of lengths times areas. A neighbour lies clearly on one side of a triangle's plane above it, so that no exact test is
/// needed. Cost alone while it is above 1e-15.
constexpr double clear_side = 1e-9;

/// Fraction of the obstacle's diagonal. How far beyond a face its winding number is asked. Too small: rounding keeps the point on
/// the face. Too large: it lies beyond another face of a thin part, and a face is dropped or kept wrongly.
constexpr double beyond_face = 1e-9;

/// Pairs of triangles that are tested in the search for internal faces, in all and for each triangle. With more pairs the search
/// gives up and all faces stay: correct, with contacts inside the body's overlaps.
constexpr long most_internal_tests = 2000000, most_internal_tests_per_triangle = 200;

/// Triangles of the obstacle in a patch, the unit of a backend's tree. The order of rows depends on it, as on the cluster's.
constexpr unsigned long triangles_per_patch = 16;

/// Fraction of coordinates. How much a box grows that is turned back to where the tree was built. Below the rounding of two
/// rotations (1e-15) patches are missed.
constexpr double turned_box = 1e-9;

/// Twice the area over the square of the longest edge. Narrower triangles have no normal that excuses an edge. Smaller: a wrong
/// normal may excuse a real contact. Larger: cost alone.
constexpr double needle_area = 1e-4;

/// The same for the bound of a triangle's sharpness. Narrower ones are measured exactly.
constexpr double flat_triangle_area = 1e-12;

/// Of the cone of directions in which a vertex can be closest. `ray_below`: dot product of unit vectors up to which a ray is
/// below an edge; 0 loses rays to rounding, the cone gets too narrow and contacts are missed. `parallel_edges`: length of a cross
/// product below which two edges give no ray. Then, cost alone: length of the sum of rays below which there is no cone; cosine of
/// the widest cone worth a test; edges at the vertex worth the search.
constexpr double ray_below = 1e-6, parallel_edges = 1e-3, least_ray_sum = 0.5, widest_cone = 0.2;
constexpr unsigned long most_cone_edges = 16;

/// Fraction of a pack's size. What the kernels take off a distance for some thirty roundings of single precision. Smaller: bounds
/// above the distance, missed contacts. Larger: more pairs are measured exactly.
constexpr float pack_rounding = 2e-6F;

/// m^2 or m^4. Denominators of the kernels are at least this. Keeps points and needles from dividing by 0.
constexpr float least_denominator = 1e-37F;

/// m. A bound that says nothing: below any distance.
constexpr float no_bound = -1e30F;

/// Margins within which the kernels leave a decision to the exact measurement: a parameter along an edge of a triangle; an area
/// outside a triangle as a fraction of its own; a rise as a fraction of the cloth edge; a parameter along two edges, and that per
/// size over length; sin^2 between two edges; a cosine of a cone. Smaller: rounding refuses contacts. Larger: cost alone.
constexpr float unsure_parameter = 1e-2F, unsure_area = 1e-2F, unsure_rise = 1e-4F;
constexpr float unsure_crossing = 1e-4F, unsure_crossing_per_size = 4e-4F, unsure_parallel = 1e-3F, unsure_cone = 1e-3F;

// ---- lists/

/// Fraction of h, and of the displacement that a list is made for. The room around a vertex within which its list holds. Larger:
/// longer lists, made anew less often. Cost alone.
constexpr double box_skin = 0.4, box_skin_of_displacement = 0.2;

/// Fraction of h. A plane must keep a pack farther off by this much more than h to leave it out of a list. Below rounding
/// (1e-15) contacts at h are missed.
constexpr double hull_slack = 1e-6;

/// Packs in the lists, in all and for each vertex. A move with more is covered in part. Larger: more memory at once (12 bytes a
/// pack). Smaller: a long move takes more calls.
constexpr long most_packs = 500000, most_packs_per_vertex = 40;

/// Fraction of a move. Below it lists are made however many packs they hold. 0: the search might never end.
constexpr double least_covered = 1e-4;

/// Size of pack and cloth feature over the least height of their triangles or the least length of their edges. Above it single
/// precision says nothing and a pair is measured exactly. Larger: bounds of needles have no right digit.
constexpr double most_sharpness = 1e4;

/// Fraction of h. Edges take all of their stiffness from the angle on at which their ends are this much farther off than the
/// middle. 0: Newton did not end where threads lie along facets (330 iterations a step, now 8). Larger: crossings at small
/// angles get too soft.
constexpr double negligible_rise = 1e-3;

/// Stiffness of a row below which it counts as 0. Rounding alone.
constexpr double least_stiffness = 1e-12;

// ---- detector

/// Fraction of h. A vertex that has moved farther since its contacts with obstacles were last forgotten forgets them at the next
/// refresh. 0: cloth at rest trembles between two sets of contacts. Large: contacts of places that cloth has left stay until it
/// is h away.
constexpr double forgetting_displacement = 0.1;

// ---- self/

/// Fraction of h, and of the mean length of a vertex's edges: the lower is its skin. What clusters may move against each other
/// beyond a foreseen move before their list is made anew; the first also says how far one may go before lists are looked for. As
/// box_skin. Cost alone.
constexpr double self_skin = 0.5, self_skin_of_edge = 0.125;

/// Times what a step's move takes. Lists and boxes that long trial moves have left with more are made anew with the next step.
/// Small: they are made anew often. Large: they stay full of what is far. Cost alone.
constexpr double most_room = 4.0;

/// Elements for which a list may keep memory beside twice what it holds; half of them, and an eighth of what it holds, it takes
/// beforehand. Fewer: lists of cloth that hardly moves allocate. Cost alone.
constexpr std::size_t spare_elements = 8;

/// Of cloth against cloth: how many clusters and lists a thread takes at once, and how many lists are made before it is looked
/// how many pairs they have taken.
constexpr std::size_t self_clusters_a_part = 64, self_lists_a_part = 16, self_lists_a_round = 1024;

/// Fraction of the distance at rest below which two features of one cloth are in contact at the latest. Above 1: a mesh finer
/// than its thickness pushes itself apart at rest. Small: a fold closes to nearly nothing at its crease.
constexpr double contact_of_rest = 0.5;

/// The same on the way through a seam. Sides of a seam are sampled each in its own way, so that edges from places close to each
/// other cross where it is folded: at 0.5 such a fold cannot close below 60 degrees, and contact holds the seam open. 0: nothing
/// keeps its sides apart near it.
constexpr double contact_of_seam = 0.1;

/// Pairs of cloth with cloth that are looked at for one move, in all and for each vertex, and the part of them that there may be
/// lists. As most_packs.
constexpr long most_self_pairs = 4000000, most_self_pairs_per_vertex = 300, pairs_a_list = 16;

/// Sine (17 degrees). Edges that cross are in contact below h where all faces beside them fall away by as much, below h/2 where
/// they are flat, as vertices meet faces there, and not where one rises by as much; in between evenly. Smaller: cloth that bends
/// a little gains and loses such contacts, and never comes to rest. Larger: ridges are no contacts, or one contact counts twice.
constexpr double sharp_sine = 0.3;

/// Fraction of h below which every pair of the lists is in contact, a local minimum or not: near a seam the features that lie
/// closer may be no pairs, as they share a stitched point. 0: nothing holds such a pair apart until the cut stops it, and Newton
/// gets no farther (3,000 iterations a step, distances of 1e-17 m). Large: one contact counts several times.
constexpr double least_zone = 0.1;

/// A contact that began in a smaller zone passes on to one this many times as large: from least_zone to that of a local minimum.
/// 1: a zone widens with every move within a step.
constexpr double widened_zone = 3.0;

/// Sine (2 degrees). Edges at smaller angles have no contact of their own, their ends have; it grows to all of h at twice that.
/// 0: closest points jump from end to end of parallel threads.
constexpr double least_crossing_sine = 0.03;

/// Fraction of h, the thickness of the pair. Edges of which the shorter rises by more over its length have their contact at any
/// angle: the ends may be too far apart to hold them. Larger: long edges cross slowly until the cut stops them for good. Smaller:
/// closest points jump.
constexpr double least_crossing_rise = 0.2;

/// Fraction of the thickness of two features of one cloth that remains below the distance at rest: sheets of one mesh that lie
/// edge to edge, or split along a line, would have no contact there. 0: they meet in the cut alone. Large: a mesh that is this
/// much finer than its thickness pushes itself apart at rest.
constexpr double least_of_rest = 0.01;

// ---- untangle/

/// (l - l0)/l0. A route that stretches an edge by more tears: others are preferred. The engine relaxes what is stretched.
constexpr double most_stretch = 0.5;

/// Places along each axis of the box about cloth where it is looked for what it surrounds. More: untangling takes longer. Fewer:
/// a skirt may leave the body that it was put on.
constexpr int enclosure_places = 8;

/// Of the diagonal of that box: what it is grown by, so that no place is in the plane of flat cloth.
constexpr double enclosure_room = 0.01;

/// Places inside an obstacle that cloth has to surround so that it must go on to do so. Smaller: chance decides.
constexpr int least_surrounded = 4;

/// From the middle of a rim to its vertices: where an obstacle is looked for that passes through it. Fewer: legs are missed.
constexpr double fan_places[] = {0.0, 0.25, 0.5, 0.75, 0.95};

/// Roundings of the largest coordinate within which vertices of cloth are in one place at a start. 0: a tube whose rims are 6e-17
/// m apart does not end its first step. More than some hundred: gaps that a mesh means are closed.
constexpr double joined_roundings = 32.0;

/// Size of the cells in which such places are looked for, in that distance. Cost alone.
constexpr double cell_of_joined_places = 1024.0;

/// Fraction of h that moved cloth keeps from obstacles. Less than cut_floor would start the run within the floor of cuts. Towards
/// 1: narrow places have no way out.
constexpr double untangled_gap = 0.25;

/// Length lost by a move for each length along the cloth. 1: edges may double or vanish; 0.5 stretches them by 12 % at most.
/// Small: cloth far away moves, too.
constexpr double move_slope = 0.5;

/// Factor by which a route grows that was too short, and how often the last growth is halved again. Cost, and how close to the
/// shortest the route is.
constexpr double reach_growth = 1.5;
constexpr int reach_refinements = 4;

/// Cosine between two directions above which they are one route. Smaller: routes are missed. Larger: searches are repeated.
constexpr double same_direction = 0.999;

/// Times h. Pushing vertices to the nearest places of the surface is given up beyond.
constexpr double farthest_push = 8.0;

/// Where untangling gives up: patches in all; rounds of one route; obstacles in a row that cloth cannot be pushed out of at
/// once; searches for conflicts. Larger: hopeless starts take longer (seconds now). Smaller: solvable ones are refused.
constexpr int most_patches = 256, most_route_rounds = 60, most_push_failures = 64;
constexpr long most_conflict_searches = 4000;

/// Cloth through cloth. Share of the mean edge that a round moves a vertex: larger overshoots thin layers, smaller takes more
/// rounds. Length of a way back (2 is the longest where an edge stands upright) at which half of the move is made: 0 lets places
/// that pull to no side jump about.
constexpr double retreat_share = 0.05, least_retreat = 0.1;

/// Strain that edges may have while cloth comes apart, and sweeps over all edges a round that keep it. Cost, and how much the
/// engine has to relax afterwards.
constexpr double bond_slack = 0.05;
constexpr int bond_sweeps = 4;

/// Of the mean edge: what a stitch holds as near as that is one vertex while cloth comes apart. Larger: open seams are drawn
/// together at once. Smaller: cloth is taken for torn where a seam gapes a little, and crosses itself there without an end.
constexpr double closed_stitch = 0.25;

/// Of the mean edge: how far from a lower layer cloth is moved outside of it, and to which gap. Larger reach: cloth is taken for
/// that of the other side of a limb. Larger gap: cloth is stretched more.
constexpr double layer_reach = 2.0, layer_gap = 0.05;

/// Of that gap: with so much a place is left as it is, so that rounds end.
constexpr double enough_gap = 0.8;

/// Rounds in which layers are ordered. Cost, and how deep layers may lie in each other.
constexpr int most_layer_rounds = 60;

/// Of area to the power 3/2: a cloth whose normals enclose less than three times that volume is a flat sheet. A tube ten times as
/// long as wide encloses 0.1.
constexpr double least_enclosing = 0.02;

/// Rounds without fewer crossings after which what is near the last ones is smoothed, and how many rings of vertices around them
/// are. Fewer rounds: folds are ironed that would have come apart. More rings: more cloth is moved.
constexpr int idle_rounds_before_smoothing = 20, smoothed_rings = 2;

/// All cloth is searched for crossings every so many rounds, and when none are known; in the other rounds so many rings of
/// vertices around those found last. Cost alone.
constexpr int rounds_between_searches = 10, searched_rings = 3;

/// Rounds of untangling cloth from cloth, and those in a row without fewer crossings after which it is given up. Larger: hopeless
/// starts take longer (16,000 triangles: 30 ms a round). Smaller: solvable ones are refused.
constexpr int most_untangle_rounds = 600, most_idle_rounds = 100;

/// Barycentric. A ray meets a triangle up to this far beyond its rim, so that it slips through no edge between two of them.
constexpr double ray_rim = 1e-9;

/// Fraction of the obstacle's diagonal. How far beyond a meeting it is asked whether a ray is outside. As beyond_face.
constexpr double beyond_exit = 1e-9;

/// Fraction of the triangle's size. A vertex nearer to its triangle leaves along the normal: its own direction is rounding.
constexpr double on_triangle = 1e-9;

// ---- certificate/ and what uses its trees. Nothing here decides whether triangles cross: that is exact.

/// Fraction of a distance. How much a bound must exceed a distance to excuse a pair, for rounding (1e-15). 0: the smallest
/// distance may be that of the second nearest pair, in its last digits.
constexpr double bound_slack = 1e-9;

/// m. Coordinates of larger magnitude are refused. Squares of areas overflow above 1e77.
constexpr double largest_coordinate = 1e75;

/// Triangles in a leaf of a tree. Cost alone.
constexpr int leaf_size = 4;

/// A split must leave one item in this many on each side, else the items are halved by number. Keeps the depth logarithmic: with
/// a split that may leave one item alone, meshes made of ever smaller parts give trees as deep as they have triangles.
constexpr int most_uneven_split = 8;

// ---- attach/

/// Twice the area over the product of two edges: the sine between them. Flatter triangles have no normal to attach a point by.
constexpr double flat_triangle = 1e-9;

// ---- bullet/

/// Fraction of the obstacle's diagonal. How much larger than the obstacle the box is that Bullet quantises in and that asked
/// boxes are first held against.
constexpr double quantised_box = 1e-6;

/// Cosine between the directions of two rows of one cloth feature from which on a minimum of the distance takes the place of a
/// row that is none any more. Smaller: forces turn suddenly where cloth passes an edge. Larger: cloth that slides over an edge is
/// pushed twice, which sets a sheet that slides on a plane of two triangles trembling.
constexpr double replaced_direction = 0.9;

/// Of the thickness: obstacle points so near each other are one place. Smaller: rounding keeps two rows of one place apart.
/// Larger: nothing to gain, rounding is far below.
constexpr double same_place = 1e-6;

/// Vertices and clusters in a thread's part of a pass over all of them, and clusters in one of lists that are made anew. Cost
/// alone. More: threads wait for the last part. Fewer: parts cost more to hand out than to do.
constexpr unsigned vertices_a_part = 1024, clusters_a_pass = 128, clusters_a_build = 4;

/// Clusters in a thread's part: of rows (cost alone), and of cuts, within which what one cluster allows narrows the search of the
/// next. More: threads have to wait for the last part. Fewer: cuts measure pairs that an earlier cluster would have ruled out.
constexpr unsigned clusters_a_part = 8, clusters_a_cut = 32;

}  // namespace percale::tolerances
