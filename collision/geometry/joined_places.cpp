#include "geometry/joined_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace percale {

namespace {

/// Roundings of the largest coordinate within which vertices of cloth are in one place at a start. 0: a tube whose rims are 6e-17
/// m apart does not end its first step. More than some hundred: intended gaps of a mesh are closed.
constexpr double joined_roundings = 32.0;

/// Size of the cells in which such places are searched for, in units of that distance. Cost alone.
constexpr double cell_of_joined_places = 1024.0;

using Cell = std::array<double, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        std::size_t hash = 0;
        for (const double number : cell) hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 32;
    }
};

/// Places, stored by cells much larger than the distance that joins.
class Places {
public:
    explicit Places(double rounding) : rounding_(rounding), cell_(cell_of_joined_places * rounding) {}

    /// The first of the places within rounding of x; x becomes a place if there is none.
    Vec3 first_at(const Vec3& x) {
        // x itself and, where it is near a cell's side, the neighbours there.
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
            const auto found = places_.find(cell_of(x + rounding_ * side));
            if (found == places_.end()) continue;
            for (const Vec3& place : found->second)
                if ((place - x).cwiseAbs().maxCoeff() <= rounding_) return place;
        }
        places_[cell_of(x)].push_back(x);
        return x;
    }

private:
    Cell cell_of(const Vec3& x) const {
        return {std::floor(x.x() / cell_), std::floor(x.y() / cell_), std::floor(x.z() / cell_)};
    }

    double rounding_, cell_;
    std::unordered_map<Cell, std::vector<Vec3>, CellHash> places_;
};

}  // namespace

std::vector<Vec3> joined_places(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    std::vector<char> used(positions.size(), 0);
    double largest = 0.0;
    for (const Triangle& t : triangles) {
        for (const int v : t) {
            used[static_cast<std::size_t>(v)] = 1;
            largest = std::max(largest, positions[static_cast<std::size_t>(v)].cwiseAbs().maxCoeff());
        }
    }
    std::vector<Vec3> joined(positions.begin(), positions.end());
    if (!(largest > 0.0)) return joined;
    Places places(joined_roundings * std::numeric_limits<double>::epsilon() * largest);
    for (std::size_t v = 0; v < joined.size(); ++v)
        if (used[v] != 0) joined[v] = places.first_at(joined[v]);
    return joined;
}

}  // namespace percale
