#include "lists/pack_measure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "tolerances.h"

namespace percale {
namespace {

/// Size of pack and cloth feature over the smallest height of their triangles or the smallest length of their edges. Above it
/// single precision gives no information and a pair is measured exactly. Larger: bounds of needles have no correct digit.
constexpr double max_sharpness = 1e4;

const PackKernels& chosen_kernels() {
    const char* wish = std::getenv("PERCALE_INSTRUCTIONS");
    const bool narrow = wish != nullptr && std::string_view(wish) == "baseline";
    const PackKernels* wide = narrow ? nullptr : avx2_pack_kernels();
    return wide ? *wide : *baseline_pack_kernels();
}

/// Whether single precision gives any information.
bool set_shape(const ContactPair& pair, std::span<const Vec3> cloth, const PlacedPack& placed, double size, PackQuery& query) {
    if (pair.kind == PairKind::edge_edge) {
        query.length = static_cast<float>((cloth[pair.cloth[1]] - cloth[pair.cloth[0]]).norm());
        query.shortest_edge = placed.shortest_edge;
        return std::min(query.length, query.shortest_edge) > query.size / static_cast<float>(max_sharpness);
    }
    double sharpness = static_cast<double>(placed.sharpness);
    if (pair.kind == PairKind::face_vertex) {
        sharpness = longest_over_area(cloth[pair.cloth[0]], cloth[pair.cloth[1]], cloth[pair.cloth[2]]);
    }
    sharpness = std::max(1.0, sharpness * size);
    query.sharpness = static_cast<float>(sharpness);
    return sharpness < max_sharpness;
}

}  // namespace

const PackKernels& pack_kernels() {
    static const PackKernels& kernels = chosen_kernels();
    return kernels;
}

PackAnswer measure(const ContactPair& pair, std::span<const Vec3> cloth, const PlacedPack& placed, const PackLimits& limits) {
    const PackKernels& kernels = pack_kernels();
    PackQuery query;
    double size = static_cast<double>(placed.radius);
    for (int k = 0; k < pair.cloth_count(); ++k) {
        const Vec3 x = cloth[pair.cloth[k]] - placed.centre;
        for (int axis = 0; axis < 3; ++axis) query.at[3 * k + axis] = static_cast<float>(x[axis]);
        size = std::max(size, x.cwiseAbs().maxCoeff());
    }
    query.size = tolerances::rounded_up * static_cast<float>(size);
    query.near = tolerances::rounded_up * static_cast<float>(limits.near);
    query.thickness = tolerances::rounded_up * static_cast<float>(limits.thickness);
    query.all = placed.all;
    PackAnswer answer{.distance_bound = tolerances::no_bound,
                      .travel_to_contact = tolerances::no_bound,
                      .near = query.all,
                      .contact = query.all};
    if (!set_shape(pair, cloth, placed, size, query)) return answer;
    const PackKernels::Function kernel = pair.kind == PairKind::vertex_face ? kernels.vertex_face
                                         : pair.kind == PairKind::edge_edge ? kernels.edge_edge
                                                                            : kernels.face_vertex;
    kernel(placed.lanes, query, answer);
    return answer;
}

}  // namespace percale
