#pragma once

#include <array>
#include <span>
#include <vector>

#include "cloth_model.h"
#include "percale/stitch.h"

namespace percale {

/// Stitches whose sides keep their distance at first; then it falls to zero at a steady rate. Between two vertices that distance
/// is the rest length of a spring, whatever its direction; a point between two vertices keeps the direction (SewnPoint). A stiff
/// spring without length holds the seam.
struct Seam {
    int first_spring = 0;
    std::vector<double> length;         // m, of each stitch when it was sewn; its spring is number first_spring + k
    std::vector<Stitch> stitches = {};  // in the numbers of the system
    double from = 0.0;                  // s
    double over = 0.0;                  // s, how long closing takes
    int first_weld = -1;                // of its stitches, in their order; -1: it is not welded
    bool contact = true;                // the cloths that it joins meet before it has closed

    bool closes_after(double time) const { return time < from + over; }
};

/// Appends the springs of a seam between vertices of the system, and its welds, if seam.first_weld is the number of the first;
/// closing begins at the time seam.from. finish_model has to follow.
void append_seam(std::span<const Stitch> stitches, double stiffness, const Vec3Arrays& positions, Seam& seam, ClothModel& model);

/// Sets the rest lengths that the springs of a seam have at a time, s, in the list of those of all springs, m.
void set_seam_lengths(const Seam& seam, double time, std::vector<double>& rest_length);

/// Energy of a seam with the lengths that it has at a time, s, J.
double seam_energy(const Seam& seam, double time, const ClothModel& model, const Vec3Arrays& positions);

/// The welds of a seam; none where it is not welded.
std::span<Weld> welds_of(const Seam& seam, ClothModel& model);

}  // namespace percale
