#pragma once

#include <array>
#include <span>
#include <vector>

#include "cloth_model.h"

namespace percale {

/// Springs between pairs of vertices whose rest length goes from the distance that the vertices had to 0, at a steady rate, and
/// stays 0: a stiff spring without length is the weld.
struct Seam {
    int first_spring = 0;
    std::vector<double> length;  // m, of each spring when closing began
    double from = 0.0;           // s
    double over = 0.0;           // s, how long closing takes

    bool closes_after(double time) const { return time < from + over; }
};

/// Appends the springs of a seam between vertices of the system; closing begins at the time seam.from. finish_model has to
/// follow.
void append_seam(std::span<const std::array<int, 2>> pairs, double stiffness, const Vectors& positions, Seam& seam,
                 ClothModel& model);

/// Sets the rest lengths that the springs of a seam have at a time, s, in the list of those of all springs, m.
void set_seam_lengths(const Seam& seam, double time, std::vector<double>& rest_length);

/// Energy of a seam's springs with the rest lengths that they have at a time, s, J.
double seam_energy(const Seam& seam, double time, const SpringNetwork& network, const Vectors& positions);

}  // namespace percale
