#include "engine/kernels/kernel_table.h"

#include <Eigen/Dense>
#include <cstring>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/forces/kernel_cases.h"

namespace percale::test::kernel_table_test {
namespace {

// Products

Vec3 plain_quad_product(const KernelProblem& p, int e, const Vec3& difference) {
    const auto [a, x, y, z] = p.quad(e);
    const Vec3 w(x, y, z);
    return a * difference + w.dot(difference) * w;
}

Case multiply_case() {
    return {"multiply", 1e-12,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                const AlignedVector<double> points = packed(p.x);
                const BlockPass pass{.pattern = p.pattern(), .values = p.quads.data(), .ground = p.ground.data()};
                Result result;
                for (const Slices range : ranges) {
                    result.sum += kernels.multiply(pass, view(p.x), points.data(), p.free.data(), p.y.axes(), range);
                }
                result.add(p.y);
                return result;
            },
            [](KernelProblem p) {
                Result result;
                for_vertices(p, [&](int i) {
                    Vec3 sum = p.ground[i] * p.x.at(i);
                    for_entries(p, i, [&](int e) { sum += plain_quad_product(p, e, p.x.at(i) - p.x.at(p.other[e])); });
                    p.y.set(i, p.free[i] * sum);
                    result.sum += p.free[i] * sum.dot(p.x.at(i));
                });
                result.add(p.y);
                return result;
            }};
}

Result plain_float_product(KernelProblem& p, bool coarse, bool with_right) {
    FloatResult y(p);
    for_vertices(p, [&](int i) {
        const Vec3 own = p.float_at(p.float_x, i);
        Vec3 sum = coarse ? Vec3(p.block(i) * own) : Vec3(static_cast<double>(p.float_r[i]) * own);
        for_entries(p, i, [&](int e) {
            const Vec3 difference = own - p.float_at(p.float_x, p.other[e]);
            sum += coarse ? Vec3(p.six(e) * difference) : plain_quad_product(p, e, difference);
        });
        y.set(i, with_right ? Vec3(p.float_at(p.float_y, i) - sum) : sum);
    });
    Result result;
    result.add(y.data);
    return result;
}

Case float_product_case(bool coarse, bool with_right) {
    return {coarse ? "multiply_coarse" : "multiply_fine", 1e-6,
            [=](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                const AlignedVector<float> points = packed(p, p.float_x);
                FloatResult y(p);
                const FloatPass pass{.pattern = p.pattern(),
                                     .values = coarse ? p.sixes.data() : p.quads.data(),
                                     .ground = coarse ? p.blocks.data() : p.float_r.data(),
                                     .x = {p.float_x.data(), p.padded},
                                     .y = {y.data.data(), p.padded},
                                     .points = points.data(),
                                     .right = with_right ? p.float_y.data() : nullptr};
                for (const Slices range : ranges) (coarse ? kernels.multiply_coarse : kernels.multiply_fine)(pass, range);
                Result result;
                result.add(y.data);
                return result;
            },
            [=](KernelProblem p) { return plain_float_product(p, coarse, with_right); }};
}

Case smooth_case(bool fresh) {
    return {"smooth", 1e-6,
            [=](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                // From zero no entry of x is read.
                if (fresh) std::fill(p.float_x.begin(), p.float_x.end(), std::numeric_limits<float>::quiet_NaN());
                const SmoothPass pass{.inverse = p.blocks.data(),
                                      .r = {p.float_r.data(), p.padded},
                                      .x = {p.float_x.data(), p.padded},
                                      .factor = 0.37f,
                                      .fresh = fresh};
                for (const Slices range : ranges) kernels.smooth(pass, range);
                Result result;
                result.add(p.float_x);
                return result;
            },
            [=](KernelProblem p) {
                FloatResult x(p);
                for_vertices(p, [&](int i) {
                    const Vec3 move = kernel_alpha * p.block(i) * p.float_at(p.float_r, i);
                    x.set(i, fresh ? move : Vec3(p.float_at(p.float_x, i) + move));
                });
                Result result;
                result.add(x.data);
                return result;
            }};
}

Case transfer_case(bool add) {
    return {"transfer", 1e-6,
            [=](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                const AlignedVector<float> points = packed(p, p.float_x);
                const TransferPass pass{.pattern = p.pattern(),
                                        .weights = p.weights.data(),
                                        .points = points.data(),
                                        .y = {p.float_y.data(), p.padded},
                                        .add = add};
                for (const Slices range : ranges) kernels.transfer(pass, range);
                Result result;
                result.add(p.float_y);
                return result;
            },
            [=](KernelProblem p) {
                FloatResult y(p);
                for_vertices(p, [&](int i) {
                    Vec3 sum = add ? p.float_at(p.float_y, i) : Vec3(Vec3::Zero());
                    for_entries(p, i, [&](int e) { sum += p.weights[e] * p.float_at(p.float_x, p.other[e]); });
                    y.set(i, sum);
                });
                Result result;
                result.add(y.data);
                return result;
            }};
}

// Block diagonals

template <class List>
void set_symmetric(List& list, std::size_t padded, int i, const Eigen::Matrix3d& m) {
    constexpr int place[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
    for (std::size_t k = 0; k < 6; ++k) list[k * padded + i] = m(place[k][0], place[k][1]);
}

Eigen::Matrix3d plain_diagonal(const KernelProblem& p, int i, bool coarse) {
    Eigen::Matrix3d sum = coarse ? p.block(i) : Eigen::Matrix3d(p.ground[i] * Eigen::Matrix3d::Identity());
    for_entries(p, i, [&](int e) {
        if (coarse) {
            sum += p.six(e);
            return;
        }
        const auto [a, x, y, z] = p.quad(e);
        const Vec3 w(x, y, z);
        sum += a * Eigen::Matrix3d::Identity() + w * w.transpose();
    });
    return sum;
}

Case diagonal_case(bool coarse) {
    return {coarse ? "coarse_diagonal" : "fine_diagonal", 1e-6,
            [=](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                AlignedVector<double> diagonal(6 * p.padded);
                AlignedVector<float> inverse(6 * p.padded);
                const DiagonalPass pass{.pattern = p.pattern(),
                                        .values = coarse ? p.sixes.data() : p.quads.data(),
                                        .ground = coarse ? nullptr : p.ground.data(),
                                        .blocks = coarse ? p.blocks.data() : nullptr,
                                        .diagonal = coarse ? nullptr : diagonal.data(),
                                        .inverse = inverse.data(),
                                        .padded = p.padded};
                for (const Slices range : ranges) (coarse ? kernels.coarse_diagonal : kernels.fine_diagonal)(pass, range);
                Result result;
                result.add(inverse);
                result.add(diagonal);
                return result;
            },
            [=](KernelProblem p) {
                std::vector<double> diagonal(6 * p.padded), inverse(6 * p.padded);
                for_vertices(p, [&](int i) {
                    const Eigen::Matrix3d sum = plain_diagonal(p, i, coarse);
                    set_symmetric(inverse, p.padded, i, sum.inverse());
                    if (!coarse) set_symmetric(diagonal, p.padded, i, sum);
                });
                Result result;
                result.add(inverse);
                result.add(diagonal);
                return result;
            }};
}

std::vector<Case> all_cases() {
    std::vector<Case> cases = {start_case(),      pack_case(),     dot_case(),       advance_case(),      jacobi_case(),
                               conversion_case(), multiply_case(), float_dot_case(), float_advance_case()};
    for (const bool first : {false, true}) {
        cases.push_back(smooth_case(first));
        cases.push_back(transfer_case(first));
        cases.push_back(diagonal_case(first));
        for (const bool second : {false, true}) {
            cases.push_back(spring_case(first, second));
            cases.push_back(float_product_case(first, second));
        }
    }
    return cases;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// Largest difference relative to the largest number expected.
double difference(const std::vector<double>& a, const std::vector<double>& expected) {
    double largest = 1e-300, error = a.size() == expected.size() ? 0.0 : 1e300;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        largest = std::max(largest, std::abs(expected[k]));
        error = std::max(error, std::abs(a[k] - expected[k]));
    }
    return error / largest;
}

/// One to three slices at a time.
Ranges pieces(int slices) {
    Ranges ranges;
    for (int first = 0, size = 1; first < slices; first += size, size = size % 3 + 1) {
        ranges.push_back({first, std::min(first + size, slices)});
    }
    return ranges;
}

/// A random symmetric positive definite matrix, rows padded with zeros to `stride`.
AlignedVector<double> definite_matrix(Random& random, int size, int stride) {
    Eigen::MatrixXd root(size, size);
    for (double& value : root.reshaped()) value = random.number(-1.0, 1.0);
    const Eigen::MatrixXd matrix = root * root.transpose() + 0.1 * size * Eigen::MatrixXd::Identity(size, size);
    AlignedVector<double> padded(static_cast<std::size_t>(size) * stride, 0.0);
    for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) padded[static_cast<std::size_t>(i) * stride + j] = matrix(i, j);
    }
    return padded;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

RowMajor whole_constraints(const AlignedVector<double>& matrix, int size, int stride) {
    return Eigen::Map<const RowMajor>(matrix.data(), size, stride);
}

int padded_stride(int size) { return (size + slice_lanes - 1) / slice_lanes * slice_lanes; }

}  // namespace

namespace {

constexpr int some_sizes[] = {1, 2, 6, 67};  // slices

void check_near(const Result& result, const Result& expected, double tolerance) {
    REQUIRE(result.arrays.size() == expected.arrays.size());
    for (std::size_t k = 0; k < expected.arrays.size(); ++k) {
        CHECK(difference(result.arrays[k], expected.arrays[k]) <= tolerance);
    }
    CHECK(result.sum == Approx(expected.sum).epsilon(1e-12).margin(1e-11));
}

void check_same_arrays(const Result& result, const Result& expected) {
    REQUIRE(result.arrays.size() == expected.arrays.size());
    for (std::size_t k = 0; k < expected.arrays.size(); ++k) CHECK(same_bits(result.arrays[k], expected.arrays[k]));
}

}  // namespace

TEST_CASE("Every kernel computes what plain loops compute") {
    for (const Case& one : all_cases()) {
        for (const int slices : some_sizes) {
            const KernelProblem problem(static_cast<unsigned>(slices), slices);
            const Result expected = one.plain(problem);
            for (const Kernels* kernels : available()) {
                const Result result = one.run(*kernels, problem, {{0, slices}});
                CAPTURE(one.name, slices, instruction_set_name(kernels->set));
                check_near(result, expected, one.tolerance);
            }
        }
    }
}

TEST_CASE("Every instruction set gives the bits of the baseline") {
    for (const Case& one : all_cases()) {
        for (const int slices : some_sizes) {
            const KernelProblem problem(100u + static_cast<unsigned>(slices), slices);
            const Result baseline = one.run(*kernels_for(InstructionSet::baseline), problem, {{0, slices}});
            for (const Kernels* kernels : available()) {
                const Result result = one.run(*kernels, problem, {{0, slices}});
                CAPTURE(one.name, slices, instruction_set_name(kernels->set));
                check_same_arrays(result, baseline);
                CHECK(same_bits({result.sum}, {baseline.sum}));
            }
        }
    }
}

TEST_CASE("Work split into ranges of slices writes the same bits") {
    constexpr int slices = 23;
    const KernelProblem problem(7, slices);
    for (const Case& one : all_cases()) {
        for (const Kernels* kernels : available()) {
            const Result whole = one.run(*kernels, problem, {{0, slices}}), split = one.run(*kernels, problem, pieces(slices));
            CAPTURE(one.name, instruction_set_name(kernels->set));
            check_same_arrays(split, whole);
            CHECK(split.sum == Approx(whole.sum).epsilon(1e-12).margin(1e-11));
        }
    }
}

TEST_CASE("A kernel changes nothing outside its range") {
    const KernelProblem problem(8, 9);
    for (const Kernels* kernels : available()) {
        Vec3Arrays forces = problem.y;
        KernelProblem part = problem;
        run_springs(*kernels, part, {{3, 5}}, false, true);
        for (int i = 0; i < 9 * slice_lanes; ++i) {
            const int slice = i / slice_lanes;
            if (slice < 3 || slice >= 5) CHECK(part.y.at(i) == forces.at(i));
        }
    }
}

TEST_CASE("Galerkin sums are the sums of coefficient times block") {
    Random random(9);
    constexpr int fine = 40, coarse = 17;
    AlignedVector<float> blocks(8 * fine), coefficients;
    for (float& value : blocks) value = static_cast<float>(random.number(-1.0, 1.0));
    std::vector<int> start = {0}, pair;
    for (int e = 0; e < coarse; ++e) {
        for (int k = 0; k < e % 5; ++k) {
            pair.push_back(random.index(fine));
            coefficients.push_back(static_cast<float>(random.number(-0.2, 1.0)));
        }
        start.push_back(static_cast<int>(pair.size()));
    }
    AlignedVector<float> baseline;
    for (const Kernels* kernels : available()) {
        AlignedVector<float> sums(8 * coarse, -7.0f);
        const GalerkinPass pass{start.data(), pair.data(), coefficients.data(), blocks.data(), sums.data()};
        kernels->galerkin(pass, 0, 6);
        CHECK(sums[8 * 6] == -7.0f);
        kernels->galerkin(pass, 6, coarse);
        for (int place = 0; place < 8 * coarse; ++place) {
            if (place % 8 >= 6) continue;
            double expected = 0.0;
            for (int k = start[place / 8]; k < start[place / 8 + 1]; ++k) {
                expected += coefficients[k] * blocks[8 * pair[k] + place % 8];
            }
            CHECK(sums[place] == Approx(expected).margin(1e-6));
        }
        if (baseline.empty()) baseline = sums;
        CHECK(sums == baseline);
    }
}

TEST_CASE("The dense inverse is Eigen's, and has the same bits in every instruction set") {
    Random random(10);
    for (const int size : {1, 3, 15, 16, 17, 48, 90}) {
        const int stride = padded_stride(size);
        const AlignedVector<double> matrix = definite_matrix(random, size, stride);
        const Eigen::MatrixXd expected = whole_constraints(matrix, size, stride).leftCols(size).inverse();
        AlignedVector<double> baseline;
        for (const Kernels* kernels : available()) {
            AlignedVector<double> inverse = matrix;
            kernels->invert(inverse.data(), size, stride);
            const RowMajor rows = whole_constraints(inverse, size, stride);
            CAPTURE(size, instruction_set_name(kernels->set));
            CHECK((rows.leftCols(size) - expected).norm() <= 1e-12 * expected.norm());
            CHECK(rows.rightCols(stride - size).isZero(0.0));
            if (baseline.empty()) baseline = inverse;
            CHECK(inverse == baseline);
        }
    }
}

TEST_CASE("The dense product is Eigen's, and has the same bits in every instruction set") {
    Random random(11);
    for (const int size : {1, 3, 15, 16, 17, 48, 90}) {
        const int stride = padded_stride(size);
        const AlignedVector<double> wide = definite_matrix(random, size, stride);
        const AlignedVector<float> matrix(wide.begin(), wide.end());
        AlignedVector<float> x(stride, 0.0f), baseline;
        Eigen::VectorXd right(size);
        for (int i = 0; i < size; ++i) right[i] = x[i] = static_cast<float>(random.number(-1.0, 1.0));
        const Eigen::VectorXd expected = whole_constraints(wide, size, stride).leftCols(size) * right;
        for (const Kernels* kernels : available()) {
            AlignedVector<float> y(stride, -7.0f);
            kernels->dense_multiply(matrix.data(), size, stride, x.data(), y.data());
            for (int i = 0; i < size; ++i) CHECK(y[i] == Approx(expected[i]).margin(1e-6 * size));
            if (baseline.empty()) baseline = y;
            CHECK(y == baseline);
        }
    }
}

}  // namespace percale::test::kernel_table_test
