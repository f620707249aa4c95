#pragma once

#include <memory>
#include <vector>

#include "percale/mesh.h"

namespace percale::test {

/// Bullet's treatment of the elastic forces; damping is implicit in both.
enum class BulletForces { implicit, explicit_ };

/// The hanging sheet of n x n vertices in Bullet's deformable world: the masses, springs, damping and pins of bench_fabric()'s
/// sheet, Bullet's own solver with its default settings, deactivation off.
class BulletSheet {
public:
    /// time_step in s, > 0.
    BulletSheet(int n, double time_step, BulletForces forces);
    ~BulletSheet();

    void step();
    /// Largest (l - l0)/l0 of a structural spring; infinite if a position is not finite.
    double largest_strain() const;
    /// Height of the lowest vertex, m.
    double lowest() const;
    /// Positions of all vertices, m, row by row.
    std::vector<Vec3> positions() const;

private:
    struct World;
    std::unique_ptr<World> world_;
};

}  // namespace percale::test
