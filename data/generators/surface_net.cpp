#include "generators/surface_net.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace percale::scenes {

namespace {

/// Fraction of the lattice's spacing by which a filled node lies inside. 0: triangles without area.
constexpr double filled_depth = 0.1;

/// Sampled distances of the half x > 0. Nodes lie at x = (i - 1/2) spacing, so that the cells i = 0 are centred on the mirror
/// plane and no surface quad crosses it.
struct Lattice {
    std::array<int, 3> nodes{};
    Vec3 origin = Vec3::Zero();
    double spacing = 0.0;
    std::vector<double> distance;

    Vec3 place(const std::array<int, 3>& n) const { return origin + spacing * Vec3(n[0], n[1], n[2]); }
    std::size_t index(const std::array<int, 3>& n) const {
        return (static_cast<std::size_t>(n[2]) * nodes[1] + n[1]) * nodes[0] + n[0];
    }
    double at(const std::array<int, 3>& n) const { return distance[index(n)]; }
};

template <typename Action>
void for_each_node(const std::array<int, 3>& first, const std::array<int, 3>& end, const Action& act) {
    for (int k = first[2]; k < end[2]; ++k)
        for (int j = first[1]; j < end[1]; ++j)
            for (int i = first[0]; i < end[0]; ++i) act(std::array<int, 3>{i, j, k});
}

Lattice sample(const DistanceField& field, const Box& box, double spacing) {
    Lattice lattice;
    lattice.spacing = spacing;
    lattice.origin = {-0.5 * spacing, box.lowest[1] - spacing, box.lowest[2] - spacing};
    for (int axis = 0; axis < 3; ++axis)
        lattice.nodes[axis] = static_cast<int>(std::ceil((box.highest[axis] - lattice.origin[axis]) / spacing)) + 2;
    lattice.distance.resize(static_cast<std::size_t>(lattice.nodes[0]) * lattice.nodes[1] * lattice.nodes[2]);
    for_each_node({0, 0, 0}, lattice.nodes,
                  [&](const std::array<int, 3>& node) { lattice.distance[lattice.index(node)] = field(lattice.place(node)); });
    return lattice;
}

/// Moves the nearest of the outside nodes among `nodes` inside.
void fill_nearest(Lattice& lattice, std::span<const std::array<int, 3>> nodes) {
    const std::array<int, 3>* nearest = nullptr;
    for (const std::array<int, 3>& node : nodes)
        if (lattice.at(node) >= 0.0 && (nearest == nullptr || lattice.at(node) < lattice.at(*nearest))) nearest = &node;
    lattice.distance[lattice.index(*nearest)] = -filled_depth * lattice.spacing;
    if ((*nearest)[0] < 2) {  // its mirror image too
        const std::array<int, 3> image = {1 - (*nearest)[0], (*nearest)[1], (*nearest)[2]};
        lattice.distance[lattice.index(image)] = -filled_depth * lattice.spacing;
    }
}

/// Fills where two sheets would share an edge of the net (a face of a cell whose inside corners are opposite) or a vertex (a cell
/// with two opposite corners on one side alone). True if anything was filled.
bool fill_pinches_at(Lattice& lattice, const std::array<int, 3>& node) {
    const auto corner = [&](int axis, int u, int v, int along) {
        std::array<int, 3> n = node;
        n[(axis + 1) % 3] += u, n[(axis + 2) % 3] += v, n[axis] += along;
        return n;
    };
    const auto inside = [&](const std::array<int, 3>& n) { return lattice.at(n) < 0.0; };
    for (int axis = 0; axis < 3; ++axis) {
        const std::array<int, 3> face[] = {corner(axis, 0, 0, 0), corner(axis, 1, 0, 0), corner(axis, 1, 1, 0),
                                           corner(axis, 0, 1, 0)};
        const bool opposite = inside(face[0]) == inside(face[2]) && inside(face[1]) == inside(face[3]);
        if (!opposite || inside(face[0]) == inside(face[1])) continue;
        fill_nearest(lattice, face);
        return true;
    }
    std::vector<std::array<int, 3>> in, out;
    for (int k = 0; k < 8; ++k) {
        const std::array<int, 3> n = corner(0, k & 1, k >> 1 & 1, k >> 2);
        (inside(n) ? in : out).push_back(n);
    }
    const std::vector<std::array<int, 3>>& few = in.size() == 2 ? in : out;
    if (few.size() != 2) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (few[0][axis] == few[1][axis]) return false;
    fill_nearest(lattice, out);
    return true;
}

/// Nodes only ever move inside, so this ends.
void fill_pinches(Lattice& lattice) {
    const std::array<int, 3> cells = {lattice.nodes[0] - 1, lattice.nodes[1] - 1, lattice.nodes[2] - 1};
    bool changed = true;
    while (changed) {
        changed = false;
        for_each_node({0, 0, 0}, cells, [&](const std::array<int, 3>& node) { changed |= fill_pinches_at(lattice, node); });
    }
}

/// Mean of the points where the surface cuts a cell's edges; false if it cuts none.
bool cell_vertex(const Lattice& lattice, const std::array<int, 3>& cell, Vec3& mean) {
    Vec3 sum = Vec3::Zero();
    int cuts = 0;
    for (int edge = 0; edge < 12; ++edge) {
        const int axis = edge / 4;
        std::array<int, 3> start = cell;
        start[(axis + 1) % 3] += edge & 1;
        start[(axis + 2) % 3] += edge >> 1 & 1;
        std::array<int, 3> end = start;
        end[axis] += 1;
        const double a = lattice.at(start), b = lattice.at(end);
        if ((a < 0.0) == (b < 0.0)) continue;
        sum += lattice.place(start) + a / (a - b) * (lattice.place(end) - lattice.place(start));
        ++cuts;
    }
    if (cuts > 0) mean = sum / cuts;
    return cuts > 0;
}

void add_quad(TriangleMesh& mesh, std::array<int, 4> q, bool reversed) {
    if (reversed) std::swap(q[1], q[3]);
    const auto length = [&](int a, int b) { return (mesh.vertices[q[a]] - mesh.vertices[q[b]]).squaredNorm(); };
    const int turn = length(0, 2) <= length(1, 3) ? 0 : 1;
    mesh.triangles.push_back({q[turn], q[turn + 1], q[turn + 2]});
    mesh.triangles.push_back({q[turn], q[turn + 2], q[(turn + 3) % 4]});
}

TriangleMesh net_of(const Lattice& lattice) {
    TriangleMesh mesh;
    std::vector<int> vertex_of(lattice.distance.size(), -1);
    const std::array<int, 3> cells = {lattice.nodes[0] - 1, lattice.nodes[1] - 1, lattice.nodes[2] - 1};
    for_each_node({0, 0, 0}, cells, [&](const std::array<int, 3>& cell) {
        Vec3 vertex;
        if (!cell_vertex(lattice, cell, vertex)) return;
        if (cell[0] == 0) vertex[0] = 0.0;
        vertex_of[lattice.index(cell)] = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(vertex);
    });
    for_each_node({1, 1, 1}, cells, [&](const std::array<int, 3>& node) {
        for (int axis = 0; axis < 3; ++axis) {
            std::array<int, 3> next = node, u{}, v{};
            next[axis] += 1;
            const bool inside = lattice.at(node) < 0.0;
            if (inside == (lattice.at(next) < 0.0)) continue;
            u[(axis + 1) % 3] = 1;
            v[(axis + 2) % 3] = 1;
            const auto corner = [&](int du, int dv) {
                return vertex_of[lattice.index(
                    {node[0] - du * u[0] - dv * v[0], node[1] - du * u[1] - dv * v[1], node[2] - du * u[2] - dv * v[2]})];
            };
            add_quad(mesh, {corner(1, 1), corner(0, 1), corner(0, 0), corner(1, 0)}, !inside);
        }
    });
    return mesh;
}

}  // namespace

TriangleMesh half_surface_net(const DistanceField& field, const Box& box, double spacing) {
    Lattice lattice = sample(field, box, spacing);
    fill_pinches(lattice);
    return net_of(lattice);
}

TriangleMesh mirrored(const TriangleMesh& half) {
    TriangleMesh whole = half;
    std::vector<int> image(half.vertices.size());
    std::iota(image.begin(), image.end(), 0);
    for (std::size_t v = 0; v < half.vertices.size(); ++v) {
        const Vec3& x = half.vertices[v];
        if (x[0] == 0.0) continue;
        image[v] = static_cast<int>(whole.vertices.size());
        whole.vertices.emplace_back(-x[0], x[1], x[2]);
    }
    for (const Triangle& t : half.triangles) whole.triangles.push_back({image[t[0]], image[t[2]], image[t[1]]});
    return whole;
}

}  // namespace percale::scenes
