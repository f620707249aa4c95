#pragma once

#include <vector>

#include "engine/linear/coarsening.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {

inline SpringGraph graph_of(const ClothModel& model) {
    SpringGraph graph{.positions = model.rest, .pairs = {}, .strength = model.springs.stiffness};
    for (int k = 0; k < model.springs.size(); ++k) graph.pairs.push_back({model.springs.first[k], model.springs.second[k]});
    return graph;
}

/// A straight chain, links 0.5 ... 1.5 m long.
inline SpringGraph uneven_rope(Random& random, int count) {
    SpringGraph rope;
    const Vec3 along = random.unit();
    Vec3 place = random.point(1.0);
    for (int i = 0; i < count; ++i) {
        rope.positions.push_back(place);
        place += random.number(0.5, 1.5) * along;
        if (i == 0) continue;
        rope.pairs.push_back({i - 1, i});
        rope.strength.push_back(100.0);
    }
    return rope;
}

/// Rows of vertices 1 m apart, each shifted by half a metre against the one before.
inline SpringGraph triangular_lattice(int side) {
    SpringGraph lattice;
    const auto link = [&](int i, int j) {
        lattice.pairs.push_back({i, j});
        lattice.strength.push_back(100.0);
    };
    for (int r = 0; r < side; ++r) {
        for (int c = 0; c < side; ++c) {
            lattice.positions.emplace_back(c + 0.5 * r, 0.0, std::sqrt(0.75) * r);
            const int i = r * side + c;
            if (c > 0) link(i, i - 1);
            if (r > 0) link(i, i - side);
            if (r > 0 && c + 1 < side) link(i, i - side + 1);
        }
    }
    return lattice;
}

/// Springs between random points, several of them at the same place, stiffnesses over four decades.
inline SpringGraph random_graph(unsigned seed, int count, int links) {
    Random random(seed);
    ClothModel model = linked_masses(random_masses(random, count), random_links(random, count, links));
    model.rest = random_points(random, count, 1.0);
    for (int i = 0; i < count / 5; ++i) model.rest[random.index(count)] = model.rest[random.index(count)];
    return graph_of(model);
}

/// Sheets, a free mesh, ropes, random networks and vertices without springs.
inline std::vector<SpringGraph> some_graphs() {
    const Fabric fabric = sheet_fabric();
    Fabric free = fabric;
    free.springs.shear = 0.0;
    Random random(1);
    std::vector<SpringGraph> graphs = {graph_of(cloth_model(make_grid(1.0, 1.0, 17, 17), fabric)),
                                       graph_of(cloth_model(make_grid(1.0, 2.0, 12, 9), free)),
                                       graph_of(cloth_model(make_sphere(0.5, 2), free)),
                                       uneven_rope(random, 40),
                                       triangular_lattice(10),
                                       random_graph(2, 50, 60),
                                       random_graph(3, 50, 300)};
    graphs.push_back(uneven_rope(random, 7));
    graphs.back().positions.resize(12, Vec3(1.0, 2.0, 3.0));
    return graphs;
}

}  // namespace percale::test
