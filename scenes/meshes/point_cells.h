#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

/// Numbers of points, sorted into cubes of a size: two points that are no farther apart lie in the same cube or in neighbouring
/// ones.
class PointCells {
public:
    explicit PointCells(double size) : size_(size * (1.0 + 1e-9)) {}  // so that rounding misses no pair that is just so far apart

    void add(int number, const Vec3& x) { cells_[cell_of(x)].push_back(number); }

    /// Calls look(number) for the points in the cube of x and in those around it, until one answers true; whether one did.
    template <class Look>
    bool any_around(const Vec3& x, Look look) const {
        const Cell own = cell_of(x);
        for (int k = 0; k < 27; ++k) {
            const auto cell = cells_.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
            if (cell == cells_.end()) continue;
            for (const int number : cell->second)
                if (look(number)) return true;
        }
        return false;
    }

private:
    using Cell = std::array<double, 3>;  // whole numbers
    Cell cell_of(const Vec3& x) const {
        return {std::floor(x.x() / size_), std::floor(x.y() / size_), std::floor(x.z() / size_)};
    }

    double size_;
    std::map<Cell, std::vector<int>> cells_;
};

}  // namespace percale::scenes
