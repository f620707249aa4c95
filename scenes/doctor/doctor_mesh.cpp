#include "doctor/doctor_mesh.h"

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "garment/meeting_warnings.h"
#include "meshes/near_vertices.h"
#include "percale/certify.h"
#include "percale/cleaning.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// Elements that a finding names.
constexpr std::size_t shown_elements = 4;

/// Times the mesh's size: farther from the origin rounding spoils its shape.
constexpr double farthest_extents = 1e4;

/// Pairs of triangles in a search for crossings: found; tested, for each triangle and at least. Fewer: it is left unknown whether
/// a mesh crosses itself. More: seconds.
constexpr long max_crossings = 1000, crossing_tests_per_triangle = 100, min_crossing_tests = 1000000;

/// Longest edge over the shortest.
constexpr double max_edge_ratio = 1e3;

/// Thickness over the median edge, that is advised where it is above 1.
constexpr double advised_thickness = 0.5;

/// Thickness over the distance from the origin: with less, gaps of a thousandth of it drown in rounding.
constexpr double min_thickness_of_place = 1e-5;

/// Size of a cloth over an obstacle's, or the reverse: from the first on they look like metres and centimetres, from the second
/// like metres and millimetres.
constexpr double centimetre_ratio = 50.0, millimetre_ratio = 500.0;

// From where on doctor warns. Smaller or larger: warnings of what is right, or none of what is wrong.

/// m. Meshes of bodies and garments are 0.1 to some 10 m large; up to this they look like a unit too much.
constexpr double tiny_extent = 2e-3;

/// Fraction of a cloth's median edge: rims nearer than that were likely meant to be one.
constexpr double near_rim_ratio = 0.05;
/// Times the widest gap between such rims: the weld that doctor names. Less: of several corners at a place, each as far from the
/// next, some stay apart.
constexpr double beyond_widest_gap = 2.0;
/// Fraction of the triangles that a weld may remove for doctor to name it: slivers may go, the shape may not.
constexpr double dropped_by_weld = 0.01;
/// Fraction of the median edge that doctor names as the gap between vertices at one place. Any joins them.
constexpr double same_place_ratio = 1e-6;

/// m. Larger coordinates are refused, as the collision layer refuses them.
constexpr double largest_coordinate = 1e75;

/// Edge of a cloth over an obstacle's second largest side: too long to lie around it, and what is advised; and over the
/// obstacle's median edge.
constexpr double coarse_edge = 0.5, advised_edge = 0.125, coarse_edge_ratio = 10.0;

std::string element_text(int element) { return std::to_string(element); }
std::string element_text(const VertexPair& edge) { return "(" + std::to_string(edge[0]) + ", " + std::to_string(edge[1]) + ")"; }

template <class Element>
std::string first_few(const std::vector<Element>& elements) {
    std::string text;
    for (std::size_t i = 0; i < std::min(elements.size(), shown_elements); ++i)
        text += (i == 0 ? "" : ", ") + element_text(elements[i]);
    return text + (elements.size() > shown_elements ? ", ..." : "");
}

/// "1 vertex ..." or "12 vertices ..." of "vertex|vertices ...".
std::string counted_kind(long count, const std::string& what) {
    const std::size_t bar = what.find('|'), end = what.find(' ', bar);
    return std::to_string(count) + " " + (count == 1 ? what.substr(0, bar) : what.substr(bar + 1, end - bar - 1)) +
           what.substr(end);
}

void append(int element, std::vector<int>& flat) { flat.push_back(element); }
void append(const VertexPair& edge, std::vector<int>& flat) { flat.insert(flat.end(), edge.begin(), edge.end()); }

/// Collects what is found about one mesh.
class Findings {
public:
    explicit Findings(const ExaminedMesh& mesh) : mesh_(mesh) {}

    void add(Severity severity, const std::string& kind, const std::string& what, const std::string& fix) {
        const std::string prefix = mesh_.name.empty() ? "" : mesh_.name + ": ";
        found_.push_back(
            {.severity = severity, .kind = kind, .role = mesh_.role, .place = mesh_.place, .what = prefix + what, .fix = fix});
    }

    /// Adds a finding if there are any elements; its sentence is "12 WHAT: 3, 7, 8, 9, ..." (see counted_kind).
    template <class Element>
    void add_elements(Severity severity, const std::string& kind, const std::vector<Element>& elements, const std::string& what,
                      const std::string& fix) {
        if (elements.empty()) return;
        const auto count = static_cast<long>(elements.size());
        add(severity, kind, counted_kind(count, what) + ": " + first_few(elements), fix);
        found_.back().count = count;
        for (std::size_t i = 0; i < std::min(elements.size(), shown_elements); ++i) append(elements[i], found_.back().elements);
    }

    std::vector<Finding> take() { return std::move(found_); }

private:
    const ExaminedMesh& mesh_;
    std::vector<Finding> found_;
};

/// The unit that a mesh seems to have, m.
double likely_unit(const ExaminedMesh& mesh) {
    const double extent = mesh.facts.extent();
    if (!mesh.from_file || !(extent >= centimetre_extent)) return 1.0;
    return extent < millimetre_extent ? 0.01 : 0.001;
}

/// "unit = "cm"", for a unit other than m.
std::string unit_text(double unit) { return std::string("unit = \"") + (unit == 0.01 ? "cm" : "mm") + "\""; }

void find_size(const ExaminedMesh& mesh, Findings& found) {
    const double extent = mesh.facts.extent();
    const std::string size = "it is " + short_number(extent) + " m large";
    if (const double unit = likely_unit(mesh); unit != 1.0) {
        found.add(Severity::warning, "size", size + ", which looks like another unit than m",
                  "say " + unit_text(unit) + " beside its mesh, which makes it " + short_number(extent * unit) +
                      " m, if it is not meant so");
    }
    if (mesh.from_file && extent <= tiny_extent) {
        found.add(Severity::warning, "size", size + ", which looks like a unit too much or a pose.scale too small",
                  "leave out its unit (m), or enlarge it by pose.scale = " + short_number(extent > 0.0 ? 1.0 / extent : 1.0) +
                      ", which makes it 1 m, if it is not meant so");
    }
    if (mesh.facts.farthest() <= farthest_extents * extent) return;
    const Vec3 back = -0.5 * (mesh.facts.lowest + mesh.facts.highest);
    found.add(Severity::warning, "far_from_origin",
              size + ", but " + short_number(mesh.facts.farthest()) +
                  " m away from the origin: rounding there, in single precision where the file format has that, spoils its shape",
              "move it to the origin by pose.translation = [" + short_number(back.x()) + ", " + short_number(back.y()) + ", " +
                  short_number(back.z()) + "], or in the mesh itself");
}

/// Whether a coordinate is so large that the exact tests of orientation overflow; adds the finding.
bool is_beyond_tests(const ExaminedMesh& mesh, Findings& found) {
    if (mesh.facts.farthest() <= largest_coordinate) return false;
    found.add(Severity::error, "size", "its coordinates reach " + short_number(mesh.facts.farthest()) + " m, 1e75 m at most",
              "scale the mesh down, to m");
    return true;
}

CrossingSearch search_crossings(const TriangleMesh& mesh) {
    return find_crossings(mesh, max_crossings,
                          std::max(min_crossing_tests, crossing_tests_per_triangle * static_cast<long>(mesh.triangles.size())));
}

/// The mesh without the triangles that a run leaves out of cloth; the others keep their numbers.
JoinedMesh without_repeated(const TriangleMesh& mesh) {
    const std::vector<int> repeated = repeated_triangles(mesh.triangles);
    JoinedMesh kept{.mesh = {.vertices = mesh.vertices, .triangles = {}}, .number = {}};
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
        if (std::ranges::binary_search(repeated, t)) continue;
        kept.mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(t)]);
        kept.number.push_back(t);
    }
    return kept;
}

/// `joined`: the mesh as its role sees it.
void find_self_crossing(const JoinedMesh& joined, Severity severity, const std::string& fix, Findings& found) {
    const CrossingSearch search = search_crossings(joined.mesh);
    std::vector<VertexPair> pairs;
    for (const IntersectingPair& pair : search.pairs) pairs.push_back({joined.number[pair.first], joined.number[pair.second]});
    const std::string more = search.complete ? "" : ", at least,";
    found.add_elements(severity, "self_crossing", pairs, "pair|pairs of its triangles" + more + " cross each other", fix);
    if (search.complete || !pairs.empty()) return;
    found.add(Severity::note, "crossings_unknown", "too many of its triangles lie side by side to test every pair for crossings",
              "mesh it with triangles of more even size, such as a grid in place of a fan");
}

/// Adds elements that a run leaves out of cloth, and faults for which cloth is refused.
void find_refused_cloth(const MeshFacts& facts, Findings& found) {
    found.add_elements(
        Severity::note, "unused_vertices", facts.unused_vertices, "vertex|vertices of no triangle, left out",
        "nothing has to be done, unless a scene names vertices by number; deleting them from the mesh makes it smaller");
    found.add_elements(Severity::note, "repeated_triangles", facts.repeated_triangles,
                       "triangle|triangles with the corners of an earlier one, left out",
                       "nothing has to be done; deleting them from the mesh makes it smaller");
    found.add_elements(Severity::error, "flat_triangles", facts.flat_triangles, "triangle|triangles without area",
                       "delete them, or merge their corners in the mesh");
    found.add_elements(Severity::error, "crowded_edges", facts.crowded_edges,
                       "edge|edges of three triangles or more (non-manifold)",
                       "split the mesh along them, and sew the parts together with a [[seam]]");
}

/// A number above 0, rounded up to one digit.
double rounded_up(double value) {
    const double digit = std::pow(10.0, std::floor(std::log10(value)));
    return std::ceil(value / digit) * digit;
}

/// The weld that joins rims so far apart, with "; or " behind it; "" where it would remove many triangles, or is too long.
std::string weld_text(const ExaminedMesh& mesh, const TriangleMesh& surface, double widest) {
    const double weld = rounded_up(beyond_widest_gap * widest), unit = likely_unit(mesh);
    const double dropped = weld_near(surface, weld).dropped_triangles;
    const double said = weld * unit / mesh.scale;
    if (dropped > dropped_by_weld * static_cast<double>(surface.triangles.size()) || said > max_weld) return "";
    const std::string with = unit == 1.0 ? "" : " with " + unit_text(unit);
    return "weld = " + short_number(said) + with + " beside its mesh (m; --weld of percale drape) joins them; or ";
}

/// `surface`: the mesh as its role sees it; `more`: what else mends the rims.
void find_near_rims(const ExaminedMesh& mesh, const TriangleMesh& surface, const MeshFacts& facts, const std::string& open,
                    const std::string& more, Findings& found) {
    const double near = near_rim_ratio * facts.median_edge;
    if (!(near > 0.0)) return;
    const NearRims rims = near_rims(surface, facts, near);
    if (rims.vertices.empty()) return;
    found.add_elements(
        Severity::warning, "near_rims", rims.vertices,
        "vertex|vertices of a rim less than " + short_number(near) + " m beside another one, not joined to it: " + open,
        weld_text(mesh, surface, rims.widest) + "merge vertices by distance in the mesh" + more);
}

void find_cloth_shape(const ExaminedMesh& cloth, const Fabric& fabric, Findings& found) {
    const MeshFacts& facts = cloth.facts;
    const bool bends = fabric.springs.bend > 0.0 && !fabric.has_moduli();
    found.add_elements(bends ? Severity::error : Severity::warning, "folded_flat", facts.folded_flat,
                       "pair|pairs of vertices opposite an edge at the same place, where a bending spring has no length",
                       "unfold the mesh there, or set springs.bend = 0");
    const bool welds = cloth.from_file && !cloth.sewn && facts.median_edge > 0.0;
    const std::string join = (welds ? weld_text(cloth, cloth.mesh, same_place_ratio * facts.median_edge) : "") +
                             "merge vertices by distance in the mesh, or sew them (a [[seam]], lines \"stitch\" in the OBJ file)";
    found.add_elements(Severity::warning, "repeated_places", facts.repeated_places,
                       "vertex|vertices at the place of an earlier one, not joined to it: the cloth comes apart there", join);
    if (!cloth.sewn) find_near_rims(cloth, cloth.mesh, facts, "the cloth is open there", ", or sew them (a [[seam]])", found);
    found.add_elements(Severity::warning, "pinched_vertices", facts.pinched_vertices,
                       "vertex|vertices by which alone pieces hang together (non-manifold)",
                       "split the mesh at them, or join the pieces by an edge");
    found.add_elements(Severity::note, "contrary_edges", facts.contrary_edges,
                       "edge|edges whose two triangles are wound against each other",
                       "make normals consistent in the mesh; forces do not need it, but viewers show one side black");
    found.add_elements(Severity::warning, "slivers", facts.slivers,
                       "triangle|triangles more than a hundred times as long as high, which make the cloth stiff and steps dear",
                       "remesh the cloth with triangles of even size");
}

void find_cloth_edges(const ExaminedMesh& cloth, const Fabric& fabric, Findings& found) {
    const MeshFacts& facts = cloth.facts;
    const std::string shortest = short_number(facts.shortest_edge), longest = short_number(facts.longest_edge);
    if (facts.shortest_edge > 0.0 && facts.longest_edge > max_edge_ratio * facts.shortest_edge)
        found.add(Severity::warning, "edge_lengths", "its edges are " + shortest + " to " + longest + " m long",
                  "remesh it with edges of about " + short_number(facts.median_edge) + " m, its median");
    if (facts.parts > 1 && !cloth.sewn)
        found.add(Severity::note, "parts", "it consists of " + std::to_string(facts.parts) + " pieces that nothing joins",
                  "sew them with a [[seam]] if they belong together");
    const std::string thickness = "thickness " + short_number(fabric.thickness) + " m is ";
    if (fabric.thickness > facts.median_edge)
        found.add(Severity::warning, "thick_for_edges",
                  thickness + "more than its median edge, " + short_number(facts.median_edge) +
                      " m: contacts of neighbours get into each other's way",
                  "set thickness = " + short_number(advised_thickness * facts.median_edge) +
                      " or below in its fabric, or take longer edges");
    else if (fabric.self_contact && fabric.thickness > facts.shortest_edge)
        found.add(Severity::note, "thick_for_edges",
                  thickness + "more than its shortest edge, " + shortest + " m: with self_contact such places keep less",
                  "set thickness = " + shortest + " or below in its fabric for an even gap");
    if (fabric.thickness < min_thickness_of_place * facts.farthest())
        found.add(Severity::warning, "thin_for_place",
                  thickness + "too little " + short_number(facts.farthest()) + " m from the origin: gaps of a thousandth of it" +
                      " drown in rounding",
                  "move the scene to the origin, or set thickness = " + short_number(min_thickness_of_place * facts.farthest()) +
                      " or above");
}

/// Adds what cleaning leaves out before the first step, which a run does not mention.
void find_cleaning(const ExaminedMesh& obstacle, Findings& found) {
    const CleaningReport report = cleaning_report(obstacle.mesh);
    const auto note = [&](const std::string& kind, long count, const std::string& what, const std::string& fix) {
        if (count > 0) found.add(Severity::note, kind, counted_kind(count, what), fix);
    };
    note("repeated_places", report.merged_vertices, "vertex|vertices at the place of others, merged with them",
         "nothing has to be done; merging them in the mesh makes it smaller");
    note("flat_triangles", report.degenerate_triangles, "triangle|triangles without area, left out",
         "nothing has to be done; deleting them from the mesh makes it smaller");
    note("repeated_triangles", report.duplicate_triangles, "triangle|triangles with the corners of others, left out",
         "nothing has to be done; deleting them from the mesh makes it smaller");
    note("unused_vertices", report.unreferenced_vertices, "vertex|vertices of no triangle, left out",
         "nothing has to be done; deleting them from the mesh makes it smaller");
    note("internal_triangles", report.internal_triangles, "triangle|triangles inside it, where parts overlap, left out",
         "nothing has to be done; uniting the parts in the mesh makes it smaller");
}

void find_obstacle_surface(const ExaminedMesh& obstacle, const TriangleMesh& mesh, const MeshFacts& surface, Findings& found) {
    const std::string open = ", so it has no inside (it holds cloth on both sides, and deepest_penetration is not measured)";
    found.add_elements(Severity::warning, "crowded_edges", surface.crowded_edges,
                       "edge|edges of three triangles or more (non-manifold)" + open,
                       "split the mesh there, or delete inner walls, if an inside is meant");
    found.add_elements(Severity::warning, "contrary_edges", surface.contrary_edges,
                       "edge|edges whose two triangles are wound against each other" + open,
                       "make normals consistent in the mesh, all outwards");
    find_near_rims(obstacle, mesh, surface, "it is open there", "", found);
    found.add_elements(Severity::note, "open_edges", surface.open_edges, "edge|edges of one triangle (open boundary)" + open,
                       "close the holes of the mesh if an inside is meant");
    found.add_elements(Severity::note, "pinched_vertices", surface.pinched_vertices,
                       "vertex|vertices at which parts of it meet in a point (non-manifold)",
                       "nothing has to be done; splitting them makes the mesh cleaner");
    found.add_elements(Severity::warning, "inverted_parts", surface.inverted_parts,
                       "part|parts turned inside out, with the lowest vertex",
                       "flip the normals in the mesh; cloth is kept outside all the same, at a higher cost");
    if (surface.parts > 1)
        found.add(Severity::note, "parts", "it consists of " + std::to_string(surface.parts) + " pieces",
                  "nothing has to be done unless it was meant to be one");
}

}  // namespace

MeshFacts facts_as(MeshRole role, const TriangleMesh& mesh) {
    if (role != MeshRole::cloth) return mesh_facts(mesh);
    const JoinedMesh kept = without_repeated(mesh);
    MeshFacts facts = mesh_facts(kept.mesh);
    for (std::vector<int>* list : {&facts.flat_triangles, &facts.slivers})
        for (int& triangle : *list) triangle = kept.number[static_cast<std::size_t>(triangle)];
    facts.repeated_triangles = repeated_triangles(mesh.triangles);
    return facts;
}

std::vector<Finding> examine_cloth(const ExaminedMesh& cloth, const Fabric& fabric) {
    Findings found(cloth);
    find_size(cloth, found);
    find_cloth_edges(cloth, fabric, found);
    if (!cloth.from_file || is_beyond_tests(cloth, found)) return found.take();
    find_refused_cloth(cloth.facts, found);
    find_cloth_shape(cloth, fabric, found);
    find_self_crossing(without_repeated(cloth.mesh), Severity::warning,
                       fabric.self_contact
                           ? "nothing has to be done if the layers come apart, which percale plan shows; else move "
                             "them apart in the mesh"
                           : "move the layers apart in the mesh, or let self_contact = true take them apart",
                       found);
    return found.take();
}

std::vector<Finding> examine_obstacle(const ExaminedMesh& obstacle) {
    Findings found(obstacle);
    find_size(obstacle, found);
    if (!obstacle.from_file || is_beyond_tests(obstacle, found)) return found.take();
    try {
        find_cleaning(obstacle, found);
    } catch (const SceneError& error) {
        found.add(Severity::error, "no_surface", error.what(), "give it triangles with an area");
        return found.take();
    }
    const JoinedMesh joined = joined_by_place(obstacle.mesh);
    const MeshFacts surface = mesh_facts(joined.mesh);
    find_obstacle_surface(obstacle, joined.mesh, surface, found);
    find_self_crossing(joined, surface.watertight() ? Severity::note : Severity::warning,
                       "unite the parts in the mesh (a Boolean union) if cloth can come between them", found);
    return found.take();
}

namespace {

bool looks_swapped(const ExaminedMesh& cloth, const ExaminedMesh& obstacle) {
    if (!cloth.from_file || !obstacle.from_file || cloth.filled || !cloth.facts.watertight()) return false;
    return !is_watertight(joined_by_place(obstacle.mesh).mesh);
}

}  // namespace

std::vector<Finding> examine_pair(const ExaminedMesh& cloth, const ExaminedMesh& obstacle) {
    Findings found(cloth);
    const double size = cloth.facts.extent(), other = obstacle.facts.extent(), ratio = std::max(size / other, other / size);
    if ((cloth.from_file || obstacle.from_file) && ratio > centimetre_ratio) {
        const bool centimetres = ratio < millimetre_ratio;
        const std::string larger = size > other ? "it" : obstacle.name, smaller = size > other ? obstacle.name : "it";
        found.add(Severity::warning, "size_ratio",
                  "it is " + short_number(size) + " m large and " + obstacle.name + " " + short_number(other) +
                      " m: they look like meshes in different units",
                  "say unit = \"" + std::string(centimetres ? "cm" : "mm") + "\" for " + larger + ", or leave out the unit of " +
                      smaller + ", if it is not meant so");
        return found.take();
    }
    if (looks_swapped(cloth, obstacle))
        found.add(Severity::warning, "swapped", swapped_text(obstacle.name),
                  "name the garment's mesh as cloth and the body's as obstacle; leave it so if the cloth is meant to be closed");
    std::array<double, 3> sides;
    for (int axis = 0; axis < 3; ++axis) sides[axis] = obstacle.facts.highest[axis] - obstacle.facts.lowest[axis];
    std::sort(sides.begin(), sides.end());
    const double edge = cloth.facts.median_edge;
    if (edge > coarse_edge * sides[1])
        found.add(Severity::warning, "coarse_cloth",
                  "its edges of " + short_number(edge) + " m are too long to lie around " + obstacle.name + ", " +
                      short_number(sides[1]) + " m across",
                  "mesh the cloth with edges of " + short_number(advised_edge * sides[1]) + " m or less");
    else if (obstacle.from_file && edge > coarse_edge_ratio * obstacle.facts.median_edge)
        found.add(Severity::note, "coarse_cloth",
                  "its edges of " + short_number(edge) + " m are more than ten times those of " + obstacle.name + ", " +
                      short_number(obstacle.facts.median_edge) + " m: detail of the obstacle will not show in the cloth",
                  "mesh the cloth more finely, or the obstacle more coarsely, which is cheaper");
    return found.take();
}

}  // namespace percale::scenes
