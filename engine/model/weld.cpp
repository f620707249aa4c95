#include "weld.h"

#include "sewn_points.h"

namespace percale {

double weld_energy(std::span<const Weld> welds, const Vec3Arrays& positions) {
    double energy = 0.0;
    for (const Weld& weld : welds) energy += weld.hold.dot(stitch_gap(weld.stitch, positions));
    return energy;
}

double tighten(std::span<Weld> welds, const Vec3Arrays& positions, double fraction, double widest) {
    double work = 0.0;
    for (Weld& weld : welds) {
        const Vec3 gap = stitch_gap(weld.stitch, positions);
        const Vec3 before = weld.hold;
        weld.hold += fraction * weld.stiffness * gap;
        const double max = weld.stiffness * widest, now = weld.hold.norm();
        if (now > max) weld.hold *= max / now;
        work += (weld.hold - before).dot(gap);
    }
    return work;
}

}  // namespace percale
