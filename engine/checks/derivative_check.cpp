#include "derivative_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace percale {
namespace {

/// Fraction of the vertex's own value, and of the largest of all.
constexpr double derivative_accuracy = 1e-4, derivative_floor_accuracy = 1e-5;

/// Fraction that rounding leaves of sums of forces and of energies.
constexpr double derivative_rounding = 1e-12;

/// Chunks of vertices whose energy slope is compared by itself. Fewer: a wrong force hides among more right ones.
constexpr int derivative_chunks = 16;

/// A value between -1 and 1, the same for the same number (splitmix64; Steele, Lea and Flood, OOPSLA 2014).
double spread(std::uint64_t number) {
    std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

/// A range of vertices.
struct Range {
    int first, last;
};

double largest(const Vec3Arrays& v, int count) {
    return std::sqrt(largest_term(0, count, [&](int i) { return square_at(v, i); }));
}

std::string text_of(const Vec3& v) {
    std::ostringstream text;
    text << "(" << v.x() << ", " << v.y() << ", " << v.z() << ")";
    return text.str();
}

/// One term at one state.
class TermCheck {
public:
    TermCheck(const CheckedTerm& term, const CheckedState& state)
        : term_(term), state_(state), forces_(forces_at(state.positions)) {}

    std::optional<WrongDerivative> run() const {
        std::optional<WrongDerivative> wrong;
        if (term_.internal) wrong = check_reaction();
        if (!wrong && term_.energy) wrong = check_energy();
        if (!wrong && term_.multiply) wrong = check_matrix();
        return wrong;
    }

private:
    Vec3Arrays zeros() const {
        Vec3Arrays v;
        v.resize(state_.count);
        return v;
    }

    Vec3Arrays forces_at(const Vec3Arrays& positions) const {
        Vec3Arrays forces = zeros();
        term_.add_forces(positions, forces);
        return forces;
    }

    Vec3Arrays direction(Range range) const {
        Vec3Arrays d = zeros();
        for (int i = range.first; i < range.last; ++i) {
            const std::uint64_t number = 3 * static_cast<std::uint64_t>(i);
            d.set(i, {spread(number), spread(number + 1), spread(number + 2)});
        }
        return d;
    }

    Vec3Arrays moved(double factor, const Vec3Arrays& along) const {
        Vec3Arrays positions = state_.positions;
        add_scaled(positions, factor * state_.difference_step, along);
        return positions;
    }

    std::optional<WrongDerivative> check_reaction() const {
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        double size = 0.0, arm = 0.0;
        for (int i = 0; i < state_.count; ++i) {
            sum += forces_.at(i);
            moment += state_.positions.at(i).cross(forces_.at(i));
            size += forces_.at(i).norm();
            arm = std::max(arm, state_.positions.at(i).norm());
        }
        if (sum.norm() > derivative_rounding * size)
            return WrongDerivative{term_.name, "internal forces add up to " + text_of(sum) + " N"};
        if (moment.norm() > derivative_rounding * size * arm) {
            return WrongDerivative{term_.name, "internal forces have the moment " + text_of(moment) + " N m"};
        }
        return {};
    }

    std::optional<WrongDerivative> check_energy() const {
        const int grain = (state_.count + derivative_chunks - 1) / derivative_chunks;
        for (int first = 0; first < state_.count; first += grain) {
            const Range range{first, std::min(first + grain, state_.count)};
            if (slope_fits(range)) continue;
            return wrong_slope(range);
        }
        return {};
    }

    struct Slopes {
        double forces, energy, tolerance;  // N
    };

    Slopes slopes(Range range) const {
        Vec3Arrays d = direction(range);
        // At a kink of the force a difference of the energy is not its slope.
        for (int i = range.first; i < range.last; ++i) {
            if (term_.kinks && !is_exact(i)) d.set(i, Vec3::Zero());
        }
        const double ahead = term_.energy(moved(1.0, d)), behind = term_.energy(moved(-1.0, d));
        double by_forces = 0.0, size = 0.0;
        for (int i = range.first; i < range.last; ++i) {
            by_forces -= forces_.at(i).dot(d.at(i));
            size += forces_.at(i).norm();
        }
        // The rounding of the difference, and the error by a third derivative.
        const double bend = std::abs(ahead - 2.0 * term_.energy(state_.positions) + behind);
        const double noise = (1e-3 * derivative_rounding * (std::abs(ahead) + std::abs(behind)) + derivative_accuracy * bend) /
                             state_.difference_step;
        return {by_forces, (ahead - behind) / (2.0 * state_.difference_step),
                derivative_accuracy * size + derivative_floor_accuracy * largest_force() + noise};
    }

    double largest_force() const { return largest(forces_, state_.count); }

    bool slope_fits(Range range) const {
        const Slopes s = slopes(range);
        return std::abs(s.forces - s.energy) <= s.tolerance;
    }

    /// Halves the range as long as one half has the misfit, too.
    WrongDerivative wrong_slope(Range range) const {
        while (range.last - range.first > 1) {
            const int middle = (range.first + range.last) / 2;
            if (!slope_fits({range.first, middle})) {
                range.last = middle;
            } else if (!slope_fits({middle, range.last})) {
                range.first = middle;
            } else {
                break;
            }
        }
        const Slopes s = slopes(range);
        std::ostringstream text;
        text << "the energy rises by " << s.energy << " N, minus the force says " << s.forces << " N";
        return {term_.name, text.str(), range.first, range.first};
    }

    /// -dt^2 J d by differences, and from the matrix.
    struct Products {
        Vec3Arrays differences, matrix;

        double mismatch(int i) const { return std::sqrt(square_between(differences, matrix, i)); }
    };

    Products products(Range range) const {
        const Vec3Arrays d = direction(range);
        Products result{forces_at(moved(-1.0, d)), zeros()};
        add_scaled(result.differences, -1.0, forces_at(moved(1.0, d)));
        const double scale = state_.dt * state_.dt / (2.0 * state_.difference_step);
        for (auto* axis : {&result.differences.x, &result.differences.y, &result.differences.z}) {
            for (double& value : *axis) value *= scale;
        }
        term_.multiply(d, result.matrix);
        return result;
    }

    std::optional<WrongDerivative> check_matrix() const {
        const Range all{0, state_.count};
        const Products p = products(all);
        const double floor =
            derivative_floor_accuracy * std::max(largest(p.matrix, state_.count), largest(p.differences, state_.count));
        double excess = 0.0, size = 0.0;
        const Vec3Arrays d = direction(all);
        for (int i = 0; i < state_.count; ++i) {
            if (term_.kinks && !is_exact(i)) continue;
            excess += d.at(i).dot(p.matrix.at(i) - p.differences.at(i));
            size += p.matrix.at(i).norm() + p.differences.at(i).norm();
            const double own = std::max(p.matrix.at(i).norm(), p.differences.at(i).norm());
            if (p.mismatch(i) <= derivative_accuracy * own + floor || !is_exact(i)) continue;
            return wrong_constraint(i);
        }
        if (excess >= -derivative_floor_accuracy * size) return {};
        std::ostringstream text;
        text << "the matrix is below the derivative by " << -excess << " kg where it should bound it";
        return WrongDerivative{term_.name, text.str()};
    }

    bool is_exact(int i) const { return !term_.exact || term_.exact(i); }

    /// The vertex whose motion the row is wrong for: the half with the larger mismatch holds it.
    WrongDerivative wrong_constraint(int i) const {
        Range range{0, state_.count};
        while (range.last - range.first > 1) {
            const int middle = (range.first + range.last) / 2;
            const double low = products({range.first, middle}).mismatch(i), high = products({middle, range.last}).mismatch(i);
            (low >= high ? range.last : range.first) = middle;
        }
        const Products p = products(range);
        return {term_.name,
                "differences give " + text_of(p.differences.at(i)) + " kg, the matrix " + text_of(p.matrix.at(i)) + " kg", i,
                range.first};
    }

    const CheckedTerm& term_;
    const CheckedState& state_;
    Vec3Arrays forces_;
};

}  // namespace

std::optional<WrongDerivative> find_wrong_derivative(const std::vector<CheckedTerm>& terms, const CheckedState& state) {
    for (const CheckedTerm& term : terms) {
        const std::optional<WrongDerivative> wrong = TermCheck(term, state).run();
        if (wrong) return wrong;
    }
    return {};
}

}  // namespace percale
