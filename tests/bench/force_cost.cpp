// Prints what one evaluation of all forces costs on a sheet of N x N vertices: by the plain loop over an array of spring structs
// (the machine unit U), by the engine without and with the terms of the step matrix, and for the product with that matrix. Beside
// each stands the time in which memory of the same size can be read and written at all, by a triad in the same run.
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "engine/forces/total_force.h"
#include "engine/model/cloth_model.h"
#include "engine/solve/block_matrix.h"
#include "tests/bench/bench_report.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::Vectors;
using percale::test::Figures;

template <class... Lists>
double bytes_of(const Lists&... lists) {
    return (0.0 + ... + static_cast<double>(lists.size() * sizeof(lists[0])));
}

double bytes_of_vectors(const Vectors& v) { return bytes_of(v.x, v.y, v.z); }

/// a = b + 3 c over three lists of doubles, `bytes` in all.
class Triad {
public:
    explicit Triad(double bytes)
        : a_(static_cast<std::size_t>(bytes / (3 * sizeof(double))) + 1), b_(a_.size(), 1.0), c_(a_.size(), 2.0) {}
    void run() {
        for (std::size_t i = 0; i < a_.size(); ++i) a_[i] = b_[i] + 3.0 * c_[i];
    }
    bool is_right() const { return a_.front() == 7.0 && a_.back() == 7.0; }

private:
    std::vector<double> a_, b_, c_;
};

/// The engine's side: a stretched moving sheet with everything one evaluation and one product need.
struct EngineSheet {
    percale::ClothModel model;
    Vectors positions, velocities, product;
    percale::StepSprings springs;
    percale::Forces forces;
    percale::BlockMatrix matrix;

    explicit EngineSheet(int n) {
        percale::append_cloth(model, percale::make_grid(1.0, 1.0, n, n), percale::test::bench_fabric(), "sheet");
        percale::finish_model(model);
        const percale::test::PlainSheet plain(n);
        for (auto* vectors : {&positions, &velocities, &product}) vectors->resize(n * n);
        percale::copy_in(plain.positions, positions);
        percale::copy_in(plain.velocities, velocities);
        percale::set_step_springs(model.springs, positions, percale::DampingForm::length_rate, 1.0 / 60.0, springs);
        evaluate(true);
        percale::set_pattern(model.adjacency, matrix);
        percale::fill_matrix(model.mass, forces.spring_terms, matrix);
    }
    void evaluate(bool with_matrix) {
        percale::evaluate_forces({.model = &model,
                                  .springs = &springs,
                                  .positions = &positions,
                                  .velocities = &velocities,
                                  .gravity = percale::Vec3(0.0, -9.81, 0.0),
                                  .dt = 1.0 / 60.0,
                                  .with_matrix = with_matrix},
                                 forces);
    }
    void multiply() { percale::multiply(matrix, velocities, product); }

    /// What one evaluation reads and writes at least once.
    double force_bytes(bool with_matrix) const {
        const percale::SpringTerms& terms = forces.spring_terms;
        const percale::Adjacency& pattern = model.adjacency;
        return bytes_of(model.springs.first, model.springs.second, springs.stiffness, springs.rest_length, springs.damping) +
               bytes_of(terms.fx, terms.fy, terms.fz, pattern.spring, pattern.sign, model.mass) + bytes_of_vectors(positions) +
               bytes_of_vectors(velocities) + bytes_of_vectors(forces.total) +
               (with_matrix ? bytes_of(terms.a, terms.wx, terms.wy, terms.wz) : 0.0);
    }
    double product_bytes() const {
        double bytes = bytes_of(matrix.a, matrix.wx, matrix.wy, matrix.wz, model.adjacency.other);
        for (const auto& entry : matrix.diagonal) bytes += bytes_of(entry);
        return bytes + bytes_of_vectors(velocities) + bytes_of_vectors(product);
    }
};

Figures row(int n, const char* what, double seconds, int springs, double unit) {
    std::printf("%4d  %-22s %9.4f %8.2f %7.2f", n, what, 1e3 * seconds, 1e9 * seconds / springs, seconds / unit);
    return {
        {"n", n}, {"what", what}, {"ms", 1e3 * seconds}, {"ns_per_spring", 1e9 * seconds / springs}, {"units", seconds / unit}};
}

/// Ends a row with the bandwidth bound: the time a triad over as many bytes takes.
void bound(Figures& figures, double seconds, double bytes, double triad) {
    std::printf(" %9.2f %9.4f %7.2f\n", bytes / 1e6, 1e3 * triad, seconds / triad);
    figures["megabytes"] = bytes / 1e6;
    figures["triad_ms"] = 1e3 * triad;
    figures["times_bound"] = seconds / triad;
}

void measure_forces(int n, int rounds, Figures& rows) {
    percale::test::PlainSheet plain(n);
    EngineSheet engine(n);
    const double plain_bytes = bytes_of(plain.springs, plain.positions, plain.velocities, plain.forces);
    const double bytes[3] = {plain_bytes, engine.force_bytes(false), engine.force_bytes(true)};
    Triad triads[3] = {Triad(bytes[0]), Triad(bytes[1]), Triad(bytes[2])};
    const std::vector<double> seconds = percale::test::least_seconds(
        rounds, {[&] { plain.evaluate(); }, [&] { engine.evaluate(false); }, [&] { engine.evaluate(true); },
                 [&] { triads[0].run(); }, [&] { triads[1].run(); }, [&] { triads[2].run(); }});
    const char* names[3] = {"plain loop", "engine, forces", "engine, with matrix"};
    for (int k = 0; k < 3; ++k) {
        if (!triads[k].is_right()) throw std::runtime_error("the triad gave a wrong number");
        rows.push_back(row(n, names[k], seconds[k], engine.model.springs.size(), seconds[0]));
        bound(rows.back(), seconds[k], bytes[k], seconds[3 + k]);
    }
    if (static_cast<int>(plain.springs.size()) != engine.model.springs.size()) {
        throw std::runtime_error("the plain loop and the engine have different springs");
    }
}

/// Force and Hessian product: today's product with the stored blocks, apart from the forces above.
void measure_product(int n, int rounds, Figures& rows) {
    percale::test::PlainSheet plain(n);
    EngineSheet engine(n);
    Triad triad(engine.product_bytes());
    const std::vector<double> seconds =
        percale::test::least_seconds(rounds, {[&] { plain.evaluate(); }, [&] { engine.multiply(); }, [&] { triad.run(); }});
    rows.push_back(row(n, "product, stored blocks", seconds[1], engine.model.springs.size(), seconds[0]));
    bound(rows.back(), seconds[1], engine.product_bytes(), seconds[2]);
}

Figures measure(int largest, int rounds) {
    std::printf("%4s  %-22s %9s %8s %7s %9s %9s %7s\n", "N", "", "ms", "ns/sprg", "U", "MB", "triad ms", "times");
    Figures rows = Figures::array();
    for (const int n : {33, 65, 129, 257}) {
        if (n > largest) break;
        measure_forces(n, rounds, rows);
        measure_product(n, rounds, rows);
        std::fflush(stdout);
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What one evaluation of all spring forces costs, against a plain loop and against memory.",
                 "percale_force_cost");
    int largest = 257, rounds = 100;
    app.add_option("--largest", largest, "largest N of 33, 65, 129, 257")->capture_default_str()->check(CLI::Range(33, 257));
    app.add_option("--rounds", rounds, "times each is measured; the least counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100000));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(largest, rounds); });
}
