#pragma once

#include <algorithm>
#include <array>
#include <optional>

namespace percale {

/// Spring constants in N/m of each spring, whatever its length.
struct SpringConstants {
    double structural = 1000.0;  // along rows and columns of a grid; every edge of a free mesh
    double shear = 0.0;          // both diagonals of every grid cell; must be 0 on a free mesh
    double bend = 0.0;           // two apart along rows and columns; across each inner edge of a free mesh
};

/// The model of a membrane with given moduli.
enum class Membrane {
    triangle_springs,  // biquadratic springs in triangles: exact, warp and weft may differ
    van_gelder,        // plain springs on edges: isotropic, 1.2 times too stiff on grids
};

constexpr double default_friction = 0.3;  // Coulomb coefficient of cloth on obstacles and on cloth

/// The material of a cloth: raw springs, or moduli if stretch_stiffness is set. options.h has the range and a sentence for every
/// field.
struct Fabric {
    double area_density = 0.2;           // kg/m^2
    double thickness = 0.005;            // m, gap kept from obstacles, measured from the middle surface
    bool self_contact = false;           // it meets itself and all other cloth with self_contact
    double friction = default_friction;  // Coulomb coefficient against such cloth
    SpringConstants springs = {};        // N/m; unused with stretch_stiffness
    double spring_damping = 0.1;         // N s/m of each spring, along the spring only; unused with damping_time

    std::optional<double> damping_time = {};                      // s, damping of each spring over its stiffness
    std::optional<std::array<double, 2>> stretch_stiffness = {};  // N/m, warp and weft
    std::optional<double> shear_stiffness = {};                   // N/m; unset: that of isotropic cloth
    double poisson_ratio = 0.0;                                   // sqrt(nu_12 nu_21)
    Membrane membrane = Membrane::triangle_springs;
    std::optional<double> strain_limit = {};    // of structural springs, (l - l0)/l0; unset: none
    std::optional<double> bend_stiffness = {};  // N m
    double drag_normal = 1.2;                   // C_n, against air that meets the surface; of both sides together
    double drag_tangential = 0.05;              // C_t, against air that passes along it

    std::optional<double> pressure = {};    // Pa, inside a closed cloth above that outside
    std::optional<double> gas_volume = {};  // m^3, of the gas sealed in a closed cloth, at the pressure of the air

    bool has_moduli() const { return stretch_stiffness.has_value(); }
    /// N/m, the larger one of warp and weft; of raw springs that of the structural ones.
    double modulus() const {
        return has_moduli() ? std::max(stretch_stiffness->front(), stretch_stiffness->back()) : springs.structural;
    }
};

}  // namespace percale
