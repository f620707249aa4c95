#include <cstring>
#include <utility>

#include "engine/forces/springs.h"
#include "engine/linear/block_matrix.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

// Springs of a grid lie in bands; they must agree with the same network in slices.

namespace percale::test::spring_bands_test {
namespace {

constexpr double dt = 1.0 / 60.0;

struct Shape {
    int columns, rows;
    double width, depth;  // m
};
/// Few and many columns, square and oblong cells, one and several chunks of either layout.
constexpr Shape some_shapes[] = {{2, 9, 1.0, 8.0},   {2, 40, 0.1, 1.0},  {3, 3, 1.0, 1.0},
                                 {3, 50, 0.3, 7.0},  {17, 33, 1.0, 1.0}, {65, 40, 1.0, 0.62},
                                 {33, 17, 2.0, 0.5}, {65, 70, 1.0, 1.0}, {5, 900, 0.1, 9.0}};

/// A sheet in some state, its springs laid out in one way.
struct Sheet {
    ClothModel model;
    Adjacency adjacency;
    Vec3Arrays start, positions, velocities;

    Sheet(const Shape& shape, const Fabric& fabric, SpringLayout layout)
        : model(cloth_model(make_grid(shape.width, shape.depth, shape.columns, shape.rows), fabric)),
          adjacency(make_adjacency(model.springs, model.vertex_count(), layout)) {
        Random random(static_cast<unsigned>(shape.columns + shape.rows));
        const double reach = 0.4 * std::min(shape.width / (shape.columns - 1), shape.depth / (shape.rows - 1));
        std::vector<Vec3> before = model.rest, now = model.rest, speed;
        for (Vec3& x : before) x += random.point(0.2 * reach);
        for (Vec3& x : now) x += random.point(reach);
        for (int i = 0; i < model.vertex_count(); ++i) speed.push_back(random.point(0.3));
        now[1] = now[0];
        start = to_vec3_arrays(before);
        positions = to_vec3_arrays(now);
        velocities = to_vec3_arrays(speed);
    }
};

struct Evaluated {
    double energy = 0.0;
    Vec3Arrays forces;
    SpringTerms terms;
};

Evaluated evaluate(const Compute& run, const Sheet& sheet, DampingForm form) {
    StepSprings springs;
    set_step_springs(run, {sheet.adjacency, sheet.start, form, dt}, springs);
    Evaluated result;
    result.forces.resize(sheet.model.vertex_count());
    result.energy = evaluate_springs(run, springs, {sheet.positions, sheet.velocities, dt}, true, result.forces, result.terms);
    return result;
}

std::vector<Fabric> some_fabrics() {
    std::vector<Fabric> fabrics(4, sheet_fabric());
    fabrics[1].spring_damping = 0.0;
    fabrics[2].springs.shear = 0.0;
    fabrics[3].springs.bend = 0.0;
    return fabrics;
}

double norm(const Vec3Arrays& x) { return std::sqrt(dot(compute, x, x)); }

double distance(const Vec3Arrays& a, const Vec3Arrays& b) {
    Vec3Arrays difference = a;
    add_scaled(difference, -1.0, b);
    return norm(difference);
}

/// work(bands, slices, form) for every shape, fabric and form of damping.
template <class Work>
void for_sheets(Work work) {
    for (const Shape& shape : some_shapes) {
        for (const Fabric& fabric : some_fabrics()) {
            const Sheet bands(shape, fabric, SpringLayout::best), slices(shape, fabric, SpringLayout::slices);
            for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
                CAPTURE(shape.columns, shape.rows, static_cast<int>(form), bands.adjacency.bands.count);
                work(bands, slices, form);
            }
        }
    }
}

void check_blocks(const Sheet& bands, const Evaluated& in_bands, const Sheet& slices, const Evaluated& in_slices) {
    double error = 0.0;
    for (int k = 0; k < bands.model.springs.size(); ++k) {
        const SpringBlock a = spring_block(bands.adjacency, in_bands.terms, k);
        const SpringBlock b = spring_block(slices.adjacency, in_slices.terms, k);
        const Eigen::Matrix3d first = a.a * Eigen::Matrix3d::Identity() + a.w * a.w.transpose();
        const Eigen::Matrix3d second = b.a * Eigen::Matrix3d::Identity() + b.w * b.w.transpose();
        error = std::max(error, (first - second).norm() / second.norm());
    }
    CHECK(error <= 1e-6);
}

struct Product {
    BlockMatrix matrix;
    double square = 0.0;
    Vec3Arrays y;
};

/// The product with some vertices prescribed, whose entries of x are not 0.
Product product(const Compute& run, const Sheet& sheet, const Evaluated& evaluated, const Vec3Arrays& x) {
    Product result;
    set_pattern(run, sheet.adjacency, sheet.model.mass, result.matrix);
    for (int i = 0; i < sheet.model.vertex_count(); i += 7) result.matrix.free[i] = 0.0;
    fill_matrix(evaluated.terms, {}, no_blocks, result.matrix);
    AlignedVector<double> points;
    result.y.resize(sheet.model.vertex_count());
    result.square = multiply(result.matrix, x, points, result.y);
    return result;
}

Vec3Arrays random_vector(unsigned seed, int count) {
    Random random(seed);
    return to_vec3_arrays(random_points(random, count, 1.0));
}

/// The product by a loop over the springs, with the blocks of the evaluation.
Vec3Arrays plain_product(const Sheet& sheet, const Evaluated& evaluated, const Vec3Arrays& x) {
    Vec3Arrays y = x;
    for (int i = 0; i < sheet.model.vertex_count(); ++i) y.set(i, sheet.model.mass[i] * x.at(i));
    for (int k = 0; k < sheet.model.springs.size(); ++k) {
        const int i = sheet.model.springs.first[k], j = sheet.model.springs.second[k];
        const SpringBlock block = spring_block(sheet.adjacency, evaluated.terms, k);
        const Vec3 difference = x.at(i) - x.at(j), part = block.a * difference + block.w.dot(difference) * block.w;
        y.add(i, part);
        y.add(j, -part);
    }
    for (int i = 0; i < sheet.model.vertex_count(); i += 7) y.set(i, Vec3::Zero());
    return y;
}

template <class List>
bool same_numbers(const List& a, const List& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

std::vector<Compute> other_sets() {
    std::vector<Compute> list;
    for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
        if (kernels_for(set)) list.push_back({kernels_for(set)});
    }
    return list;
}

}  // namespace

TEST_CASE("Forces, energies and blocks of springs in bands are those of springs in slices") {
    for_sheets([](const Sheet& bands, const Sheet& slices, DampingForm form) {
        const Evaluated first = evaluate(compute, bands, form), second = evaluate(compute, slices, form);
        CHECK(distance(first.forces, second.forces) <= 1e-12 * norm(second.forces));
        CHECK(first.energy == Approx(second.energy).epsilon(1e-12));
        check_blocks(bands, first, slices, second);
    });
}

TEST_CASE("Most of the shapes lie in bands") {
    int banded = 0;
    for (const Shape& shape : some_shapes) banded += Sheet(shape, sheet_fabric(), SpringLayout::best).adjacency.bands.count > 0;
    CHECK(banded >= 5);
}

TEST_CASE("Products and block diagonals of springs in bands are those of their blocks") {
    for_sheets([](const Sheet& bands, const Sheet& slices, DampingForm form) {
        const Evaluated first = evaluate(compute, bands, form), second = evaluate(compute, slices, form);
        const Vec3Arrays x = random_vector(5, bands.model.vertex_count());
        const Product in_bands = product(compute, bands, first, x), in_slices = product(compute, slices, second, x);
        const Vec3Arrays plain = plain_product(bands, first, x);
        CHECK(distance(in_bands.y, plain) <= 1e-13 * norm(plain));
        CHECK(distance(in_bands.y, in_slices.y) <= 1e-6 * norm(plain));
        CHECK(in_bands.square == Approx(dot(compute, x, plain)).epsilon(1e-12));
        for (std::size_t k = 0; k < 6; ++k) {
            for (int i = 0; i < bands.model.vertex_count(); ++i) {
                const double size =
                    in_slices.matrix.diagonal[0][i] + in_slices.matrix.diagonal[3][i] + in_slices.matrix.diagonal[5][i];
                REQUIRE(std::abs(in_bands.matrix.diagonal[k][i] - in_slices.matrix.diagonal[k][i]) <= 1e-6 * size);
            }
        }
    });
}

TEST_CASE("Springs in bands have the bits of the baseline in every instruction set") {
    const Compute baseline{kernels_for(InstructionSet::baseline)};
    for_sheets([&](const Sheet& bands, const Sheet&, DampingForm form) {
        const Evaluated expected = evaluate(baseline, bands, form);
        const Vec3Arrays x = random_vector(6, bands.model.vertex_count());
        const Product expected_product = product(baseline, bands, expected, x);
        for (const Compute& other : other_sets()) {
            const Evaluated result = evaluate(other, bands, form);
            CHECK(result.energy == expected.energy);
            CHECK(same_bits(result.forces, expected.forces));
            CHECK(same_numbers(result.terms.values, expected.terms.values));
            const Product one = product(other, bands, result, x);
            CHECK(one.square == expected_product.square);
            CHECK(same_bits(one.y, expected_product.y));
            CHECK(same_numbers(one.matrix.inverse, expected_product.matrix.inverse));
            for (std::size_t k = 0; k < 6; ++k) {
                CHECK(std::memcmp(one.matrix.diagonal[k], expected_product.matrix.diagonal[k],
                                  one.matrix.padded() * sizeof(double)) == 0);
            }
        }
    });
}

TEST_CASE("Springs in bands exert no net force and leave padding alone") {
    for_sheets([](const Sheet& bands, const Sheet&, DampingForm form) {
        const Evaluated result = evaluate(compute, bands, form);
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < bands.model.vertex_count(); ++i) sum += result.forces.at(i);
        CHECK(sum.norm() <= 1e-12 * std::sqrt(bands.model.vertex_count()) * norm(result.forces));
        for (std::size_t i = bands.model.vertex_count(); i < result.forces.padded_size(); ++i) {
            CHECK(result.forces.at(static_cast<int>(i)) == Vec3::Zero());
        }
    });
}

TEST_CASE("Forces of springs in bands are added to earlier values, with and without a matrix") {
    const Sheet sheet({65, 70, 1.0, 1.0}, sheet_fabric(), SpringLayout::best);
    StepSprings springs;
    set_step_springs(compute, {sheet.adjacency, sheet.start, DampingForm::velocity, dt}, springs);
    const Vec3Arrays before = random_vector(7, sheet.model.vertex_count());
    Vec3Arrays with = before, without = before;
    SpringTerms terms, none;
    const SpringMotion motion{sheet.positions, sheet.velocities, dt};
    CHECK(evaluate_springs(compute, springs, motion, true, with, terms) ==
          evaluate_springs(compute, springs, motion, false, without, none));
    CHECK(same_bits(with, without));
    CHECK(none.values.empty());
    const Vec3Arrays alone = evaluate(compute, sheet, DampingForm::velocity).forces;
    add_scaled(with, -1.0, before);
    CHECK(distance(with, alone) <= 1e-13 * norm(alone));
}

TEST_CASE("Terms of another grid leave no trace, even where they take as many numbers") {
    const Sheet wide({17, 17, 1.0, 1.0}, sheet_fabric(), SpringLayout::best);
    const Sheet narrow({8, 42, 1.0, 6.0}, sheet_fabric(), SpringLayout::best);
    REQUIRE(wide.adjacency.value_count() == narrow.adjacency.value_count());
    const Evaluated fresh = evaluate(compute, wide, DampingForm::length_rate);
    Evaluated reused = evaluate(compute, narrow, DampingForm::length_rate);
    StepSprings springs;
    set_step_springs(compute, {wide.adjacency, wide.start, DampingForm::length_rate, dt}, springs);
    Vec3Arrays forces;
    forces.resize(wide.model.vertex_count());
    evaluate_springs(compute, springs, {wide.positions, wide.velocities, dt}, true, forces, reused.terms);
    const Vec3Arrays x = random_vector(8, wide.model.vertex_count());
    CHECK(same_bits(product(compute, wide, reused, x).y, product(compute, wide, fresh, x).y));
}

}  // namespace percale::test::spring_bands_test
