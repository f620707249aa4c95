#include "certificate/exact_orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace percale::certificate {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr int max_terms = 96;  // 24 triple products of 4 terms each

// Coordinates are brought to this power of two before exact arithmetic: three of them multiply to < 2^990, and the last bit
// of a product of three coordinates >= 2^-305 is >= 2^-1071, so no term overflows or loses bits below 2^-1074.
constexpr int working_exponent = 330;

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

/// An exact sum of doubles: terms nonoverlapping, of increasing magnitude, none zero.
class Expansion {
public:
    /// Grow-expansion: error-free two-sum of `value` with every term from the smallest up.
    void add(double value) {
        int terms = 0;
        for (int i = 0; i < count_; ++i) {
            const double term = term_[i], sum = value + term, added = sum - value;
            const double error = (value - (sum - added)) + (term - added);
            if (error != 0.0) term_[terms++] = error;
            value = sum;
        }
        if (value != 0.0) term_[terms++] = value;
        count_ = terms;
    }

    /// a b exactly: the fused multiply-add returns the rounding error of the product.
    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }

    void add_product(double a, double b, double c) {
        const double product = a * b;
        add_product(std::fma(a, b, -product), c);
        add_product(product, c);
    }

    int sign() const { return count_ == 0 ? 0 : sign_of(term_[count_ - 1]); }

private:
    std::array<double, max_terms> term_;
    int count_ = 0;
};

struct Point2 {
    double x, y;
};

/// Exponent by which all values are shifted so that the largest comes near 2^working_exponent.
int exponent_shift(std::initializer_list<double> magnitudes) {
    const double largest = std::max(magnitudes);
    return largest == 0.0 ? 0 : working_exponent - 1 - std::ilogb(largest);
}

double largest(const Vec3& a) { return std::max({std::abs(a.x()), std::abs(a.y()), std::abs(a.z())}); }

Vec3 shifted(const Vec3& a, int exponent) {
    return {std::ldexp(a.x(), exponent), std::ldexp(a.y(), exponent), std::ldexp(a.z(), exponent)};
}

/// Whether the double a - b is the exact difference (the tail of two-diff is zero).
bool difference_is_exact(double a, double b) {
    const double difference = a - b, subtracted = a - difference;
    return (a - (difference + subtracted)) + (subtracted - b) == 0.0;
}

bool difference_is_exact(const Vec3& a, const Vec3& b) {
    return difference_is_exact(a.x(), b.x()) && difference_is_exact(a.y(), b.y()) && difference_is_exact(a.z(), b.z());
}

void add_cross(Expansion& sum, const Point2& a, const Point2& b) {
    sum.add_product(a.x, b.y);
    sum.add_product(-a.y, b.x);
}

/// a . (b x c)
void add_determinant(Expansion& sum, const Vec3& a, const Vec3& b, const Vec3& c) {
    sum.add_product(a.x(), b.y(), c.z());
    sum.add_product(-a.x(), b.z(), c.y());
    sum.add_product(a.y(), b.z(), c.x());
    sum.add_product(-a.y(), b.x(), c.z());
    sum.add_product(a.z(), b.x(), c.y());
    sum.add_product(-a.z(), b.y(), c.x());
}

int exact_orient2d(Point2 a, Point2 b, Point2 c) {
    const int shift = exponent_shift({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)});
    for (Point2* point : {&a, &b, &c}) *point = {std::ldexp(point->x, shift), std::ldexp(point->y, shift)};
    Expansion sum;  // (b - a) x (c - a) = a x b + b x c + c x a
    add_cross(sum, a, b);
    add_cross(sum, b, c);
    add_cross(sum, c, a);
    return sum.sign();
}

int exact_orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const int shift = exponent_shift({largest(a), largest(b), largest(c), largest(d)});
    for (Vec3* point : {&a, &b, &c, &d}) *point = shifted(*point, shift);
    Expansion sum;
    if (difference_is_exact(b, a) && difference_is_exact(c, a) && difference_is_exact(d, a)) {
        add_determinant(sum, b - a, c - a, d - a);
        return sum.sign();
    }
    // det(b - a, c - a, d - a) = det(b, c, d) - det(a, c, d) + det(a, b, d) - det(a, b, c)
    add_determinant(sum, b, c, d);
    add_determinant(sum, -a, c, d);
    add_determinant(sum, a, b, d);
    add_determinant(sum, -a, b, c);
    return sum.sign();
}

}  // namespace

int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double left = (b[i] - a[i]) * (c[j] - a[j]);
    const double right = (b[j] - a[j]) * (c[i] - a[i]);
    const double determinant = left - right;
    // Two rounded differences, one product and one sum each: relative error (3 + 16 u) u of |left| + |right|; the
    // constant covers underflow.
    const double permanent = std::abs(left) + std::abs(right);
    const double bound = (3.0 + 16.0 * unit_roundoff) * unit_roundoff * permanent + 1e-300;
    if (std::abs(determinant) > bound && permanent <= std::numeric_limits<double>::max()) return sign_of(determinant);
    const bool no_left = b[i] == a[i] || c[j] == a[j], no_right = b[j] == a[j] || c[i] == a[i];
    if (no_left && no_right) return 0;
    return exact_orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]});
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
    const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
    const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
    const double cx_dy = cx * dy, cy_dx = cy * dx, dx_by = dx * by, dy_bx = dy * bx, bx_cy = bx * cy, by_cx = by * cx;
    const double determinant = bz * (cx_dy - cy_dx) + cz * (dx_by - dy_bx) + dz * (bx_cy - by_cx);
    // Shewchuk's bound A: relative error (7 + 56 u) u of the permanent; the last two terms cover underflow of the products.
    const double permanent = (std::abs(cx_dy) + std::abs(cy_dx)) * std::abs(bz) +
                             (std::abs(dx_by) + std::abs(dy_bx)) * std::abs(cz) +
                             (std::abs(bx_cy) + std::abs(by_cx)) * std::abs(dz);
    const double underflow = 1e-300 * (std::abs(bz) + std::abs(cz) + std::abs(dz)) + 1e-300;
    const double bound = (7.0 + 56.0 * unit_roundoff) * unit_roundoff * permanent + underflow;
    if (std::abs(determinant) > bound && permanent <= std::numeric_limits<double>::max()) return sign_of(determinant);
    const bool flat = (bx == 0.0 && cx == 0.0 && dx == 0.0) || (by == 0.0 && cy == 0.0 && dy == 0.0) ||
                      (bz == 0.0 && cz == 0.0 && dz == 0.0);  // gradual underflow: a difference is 0 only between equals
    return flat ? 0 : exact_orient3d(a, b, c, d);
}

int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int axis = 0; axis < 3; ++axis) {
        if (orient2d(a, b, c, axis) != 0) return axis;
    }
    return -1;
}

}  // namespace percale::certificate
