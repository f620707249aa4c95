#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/mesh_fields.h"
#include "picture/shown.h"

namespace percale::scenes {

/// What cloth can be coloured by.
struct PictureField {
    std::string word;                     // strain, strain_warp, strain_weft, strain_shear, pressure, distance
    std::vector<std::string> properties;  // of vertices in PLY files; the largest of them at each vertex is shown
    std::string unit;                     // that is shown
    double factor = 1.0;                  // shown = factor times what the file says
    std::string output_word;              // of output.fields in a scene
};

/// Throws SceneError, with the nearest name, for a word that is none.
const PictureField& picture_field(const std::string& word);
/// "strain, strain_warp, ...".
std::vector<std::string> picture_field_words();

/// The values at vertices, in the unit shown, from the properties of a file; empty if it lacks one of them.
std::vector<double> values_of_file(const PictureField& field, const MeshFields& properties);

/// The distance of each vertex of a cloth from the nearest body, in the unit shown; with a minus inside a closed one, infinity
/// without bodies.
std::vector<double> distances_to_bodies(const PictureField& field, const TriangleMesh& cloth, std::span<const ShownShape> shapes);

/// The values that colours are given for. Those below and above have the colour of the nearest one.
struct FieldRange {
    double low = 0.0, high = 1.0;  // low < high
    double step = 0.25;            // between the numbers at the bar
    bool some_below = false, some_above = false;

    bool diverging() const { return low < 0.0 && high > 0.0; }
    double share(double value) const;
};

/// Gathers the finite values of all that is shown with one bar.
class FieldSpread {
public:
    void add(const ShownFrame& frame);
    /// From the smallest value to the one that 99.5 % do not exceed, widened to round numbers; about 0 alike on both sides where
    /// values have both signs. Throws SceneError if there is no finite value.
    FieldRange range() const;
    /// A range that is asked for. Throws SceneError unless both are finite and low < high.
    FieldRange range(double low, double high) const;

private:
    std::vector<double> values_;
};

}  // namespace percale::scenes
