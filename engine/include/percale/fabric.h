#pragma once

namespace percale {

/// Spring constants in N/m of each spring, whatever its length.
struct SpringConstants {
    double structural = 1000.0;  // along rows and columns of a grid; every edge of a free mesh
    double shear = 0.0;          // both diagonals of every grid cell; must be 0 on a free mesh
    double bend = 0.0;           // two apart along rows and columns; across each inner edge of a free mesh
};

/// What a cloth is made of. Ranges and sentences of every field: options.h.
struct Fabric {
    double area_density = 0.2;    // kg/m^2
    double thickness = 0.005;     // m, gap kept from obstacles, measured from the middle surface
    bool self_contact = false;    // it meets itself and all other cloth of which this is true
    double friction = 0.3;        // Coulomb coefficient against such cloth
    SpringConstants springs;      // N/m
    double spring_damping = 0.1;  // N s/m of each spring, along the spring only
};

}  // namespace percale
