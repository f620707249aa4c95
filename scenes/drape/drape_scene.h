#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "format/scene.h"
#include "percale/fabric.h"

namespace percale::scenes {

/// Which garments are to be draped over which body, and how. The ending of a file says what it is.
struct DrapeOptions {
    std::vector<std::string> files;                  // garments from the inside out, then the body
    std::vector<std::string> outs;                   // one a garment
    std::string garment_unit, body_unit;             // mm, cm, dm, m, inch; "": guessed by the sizes (guessed_unit)
    std::string up;                                  // "y" or "z" of the meshes; "": guessed by the body's shape (stands_along_z)
    std::string garment_part, body_part;             // objects or groups of the meshes, taken alone; "": all
    double weld = 0.0;                               // m, vertices of meshes so near become one
    double scale = 1.0;                              // of garments
    std::array<double, 3> rotate = {0.0, 0.0, 0.0};  // degrees, of garments about x, then y, then z
    std::array<double, 3> move = {0.0, 0.0, 0.0};    // m
    // A felt with enough bending springs and damping that free hems come to rest within the limit.
    Fabric fabric{.springs = {.structural = 1000.0, .bend = 5.0}, .spring_damping = 2.0};
    std::string preset;  // "" for the felt
    double friction = 0.4;
    double seconds = 20.0;      // s, limit
    double still = 2e-4;        // m/s, what rest is
    double edge_length = 0.02;  // m, of a pattern's mesh
    double sewing_time = 1.0;   // s, of each garment
    bool weld_seams = true;     // of patterns
    bool no_self_contact = false;
    bool damps_patterns = false;  // a preset whose damping is not set otherwise

    std::span<const std::string> garments() const { return std::span(files).first(files.size() - 1); }
    const std::string& body() const { return files.back(); }
};

/// Throws SceneError for a value out of range, or outputs that do not go with the garments or cannot be written.
void check_drape(const DrapeOptions& options);

/// "mm", "cm" or "m": the unit in which a mesh of that extent is 0.1 to some 10 m large and, where `body` (m) is above 0, has the
/// size of a garment for it; "m" where several units fit.
std::string guessed_unit(double extent, double body = 0.0);

/// Whether a body with this bounding box is much taller along z than along y.
bool stands_along_z(const Vec3& extent);

/// The scene that the options describe, and what was guessed or is doubtful.
struct DrapeScene {
    Scene scene;
    std::vector<Finding> findings;
    bool z_up = false;         // of the files
    bool comes_apart = false;  // a garment has rims that look as if they were meant to be joined
};

/// Meshes where they are, garments moved as asked, y up. Throws SceneError for options that do not go together.
DrapeScene drape_scene(const DrapeOptions& options);

/// The time until which garments are sewn one after the other, without gravity, s.
double sewing_end(const Scene& scene);

/// The sewing times to try, s. The first is that of the options, and each one leaves time to settle. Straps catch at the shoulder
/// where they are sewn fast; panels cross far where they are sewn slowly, as they do not meet meanwhile.
std::vector<double> sewing_times(const DrapeOptions& options);

}  // namespace percale::scenes
