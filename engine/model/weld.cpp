#include "weld.h"

#include "sewn_points.h"

namespace percale {

double weld_energy(std::span<const Weld> welds, const Vectors& positions) {
    double energy = 0.0;
    for (const Weld& weld : welds) energy += weld.hold.dot(stitch_gap(weld.stitch, positions));
    return energy;
}

double tighten(std::span<Weld> welds, const Vectors& positions, double share, double widest) {
    double work = 0.0;
    for (Weld& weld : welds) {
        const Vec3 gap = stitch_gap(weld.stitch, positions);
        const Vec3 before = weld.hold;
        weld.hold += share * weld.stiffness * gap;
        const double most = weld.stiffness * widest, now = weld.hold.norm();
        if (now > most) weld.hold *= most / now;
        work += (weld.hold - before).dot(gap);
    }
    return work;
}

}  // namespace percale
