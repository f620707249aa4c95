#include "remake.h"

#include <algorithm>

namespace percale {
namespace {

/// Numbers first ... last - 1.
struct NumberRange {
    int first = 0, last = 0;

    bool has(int number) const { return number >= first && number < last; }
};

NumberRange vertices_of(const ClothRange& cloth) { return {cloth.first, cloth.first + cloth.count}; }

template <class List>
void append_part(const List& from, NumberRange range, List& to) {
    to.insert(to.end(), from.begin() + range.first, from.begin() + range.last);
}

/// The mesh that a cloth was appended as.
TriangleMesh mesh_of(const ClothModel& model, const ClothRange& cloth) {
    TriangleMesh mesh;
    for (int i = 0; i < cloth.count; ++i) mesh.vertices.push_back(model.rest[cloth.index_of(i)]);
    for (Triangle t : triangles_of(model, cloth)) {
        for (int& vertex : t) vertex = cloth.user_vertex(vertex);
        mesh.triangles.push_back(t);
    }
    if (cloth.grid) {
        mesh.grid_columns = cloth.columns;
        mesh.grid_rows = cloth.count / cloth.columns;
    }
    return mesh;
}

class Remaking {
public:
    Remaking(const ClothModel& before, const std::vector<Seam>& seams, const ModelChange& change)
        : before_(before), seams_(seams), change_(change) {
        made_.vertex.assign(before.vertex_count(), -1);
    }

    /// Remakes cloths and seams in the order in which they were added, which is that of their springs.
    RemadeModel run() {
        std::size_t cloth = 0, seam = 0;
        while (cloth < before_.cloths.size() || seam < seams_.size()) {
            const int next_cloth = first_spring(before_.cloths, cloth), next_seam = first_spring(seams_, seam);
            if (next_cloth < next_seam) {
                ++cloth;
                add_cloth(static_cast<int>(cloth) - 1, std::min(first_spring(before_.cloths, cloth), next_seam));
            } else {
                ++seam;
                add_seam(static_cast<int>(seam) - 1, std::min(first_spring(seams_, seam), next_cloth));
            }
        }
        finish_model(made_.model);
        return std::move(made_);
    }

private:
    template <class Pieces>
    int first_spring(const Pieces& pieces, std::size_t number) const {
        return number < pieces.size() ? pieces[number].first_spring : before_.springs.size();
    }

    void add_cloth(int number, int last_spring) {
        const ClothRange& cloth = before_.cloths[number];
        if (number != change_.cloth) return copy_cloth(cloth, {cloth.first_spring, last_spring});
        if (change_.fabric) append_changed(cloth);
    }

    void append_changed(const ClothRange& cloth) {
        ClothModel& model = made_.model;
        const RestShape shape = cloth.shape ? *cloth.shape : RestShape{};
        append_whole_cloth(model, mesh_of(before_, cloth), *change_.fabric, cloth.name, shape);
        const ClothRange& own = model.cloths.back();
        for (int i = 0; i < cloth.count; ++i) made_.vertex[cloth.index_of(i)] = own.index_of(i);
        if (!change_.fabric->strain_limit) return;
        for (int k = own.first_spring; k < model.springs.size(); ++k) {  // finish_model assigns holds by their order
            if (model.springs.kind[k] == SpringKind::structural) model.limits.edges.push_back({.spring = k});
        }
    }

    void copy_cloth(const ClothRange& cloth, NumberRange springs) {
        ClothModel& model = made_.model;
        const NumberRange vertices = vertices_of(cloth);
        const int shift = model.vertex_count() - cloth.first, spring_shift = model.springs.size() - springs.first;
        for (int i = vertices.first; i < vertices.last; ++i) made_.vertex[i] = i + shift;
        append_part(before_.mass, vertices, model.mass);
        append_part(before_.thickness, vertices, model.thickness);
        append_part(before_.modulus, vertices, model.modulus);
        append_part(before_.length, vertices, model.length);
        append_part(before_.rest, vertices, model.rest);
        for (const Triangle& t : triangles_of(before_, cloth)) model.triangles.push_back(renumbered(t));
        ClothRange& own = model.cloths.emplace_back(cloth);
        own.first += shift;
        own.first_spring += spring_shift;
        copy_springs(springs);
        copy_hinges(vertices, spring_shift);
        for (const MembraneTriangle& triangle : before_.membrane) {
            if (!vertices.has(triangle.vertex[0])) continue;
            model.membrane.push_back(triangle);
            model.membrane.back().vertex = renumbered(triangle.vertex);
        }
        for (const LimitedEdge& edge : before_.limits.edges) {
            if (!springs.has(edge.spring)) continue;
            model.limits.edges.push_back(edge);
            model.limits.edges.back().spring += spring_shift;
        }
    }

    void copy_springs(NumberRange range) {
        const SpringNetwork& from = before_.springs;
        SpringNetwork& to = made_.model.springs;
        for (int k = range.first; k < range.last; ++k) {
            const int one = made_.vertex[from.first[k]], other = made_.vertex[from.second[k]];
            const bool sorted = from.kind[k] == SpringKind::seam;  // another order of vertices may exchange its ends
            to.first.push_back(sorted ? std::min(one, other) : one);
            to.second.push_back(sorted ? std::max(one, other) : other);
        }
        append_part(from.rest_length, range, to.rest_length);
        append_part(from.stiffness, range, to.stiffness);
        append_part(from.damping, range, to.damping);
        append_part(from.kind, range, to.kind);
    }

    void copy_hinges(NumberRange vertices, int spring_shift) {
        Hinges& to = made_.model.hinges;
        for (const Hinge& hinge : before_.hinges.all) {
            if (!vertices.has(hinge.vertex[0])) continue;
            Hinge& own = to.all.emplace_back(hinge);
            for (int& vertex : own.vertex) vertex = vertex < 0 ? -1 : made_.vertex[vertex];
            for (int& pair : own.pair) pair = pair < 0 ? -1 : pair + spring_shift;
            if (hinge.rest_angle != 0.0) to.curved.push_back(static_cast<int>(to.all.size()) - 1);
        }
    }

    void add_seam(int number, int last_spring) {
        const Seam& seam = seams_[number];
        const Stitch& stitch = seam.stitches.front();  // all stitches join the same two cloths
        if (made_.vertex[stitch.vertex] < 0 || made_.vertex[stitch.from] < 0) return;
        ClothModel& model = made_.model;
        const NumberRange springs{seam.first_spring, last_spring};
        const int spring_shift = model.springs.size() - springs.first;
        copy_springs(springs);
        Seam& own = made_.seams.emplace_back(seam);
        made_.seam_before.push_back(number);
        own.first_spring += spring_shift;
        for (Stitch& each : own.stitches) each = renumbered(each);
        for (const SewnPoint& point : before_.sewn_points) {
            if (!springs.has(point.spring)) continue;
            SewnPoint& copy = model.sewn_points.emplace_back(point);
            copy.stitch = renumbered(point.stitch);
            copy.spring += spring_shift;
            copy.pair += spring_shift;
        }
        if (seam.first_weld < 0) return;
        own.first_weld = static_cast<int>(model.welds.size());
        append_part(before_.welds, {seam.first_weld, seam.first_weld + static_cast<int>(seam.length.size())}, model.welds);
        for (std::size_t k = own.first_weld; k < model.welds.size(); ++k)
            model.welds[k].stitch = renumbered(model.welds[k].stitch);
    }

    Triangle renumbered(const Triangle& t) const { return {made_.vertex[t[0]], made_.vertex[t[1]], made_.vertex[t[2]]}; }
    Stitch renumbered(const Stitch& stitch) const {
        return {made_.vertex[stitch.vertex], made_.vertex[stitch.from], made_.vertex[stitch.to], stitch.share};
    }

    const ClothModel& before_;
    const std::vector<Seam>& seams_;
    ModelChange change_;
    RemadeModel made_;
};

}  // namespace

RemadeModel remake(const ClothModel& before, const std::vector<Seam>& seams, const ModelChange& change) {
    return Remaking(before, seams, change).run();
}

}  // namespace percale
