// Prints the cost of one evaluation of all forces on a sheet of N x N vertices: by the plain loop over an array of spring
// structs (the machine unit U), by the engine without and with the terms of the step matrix, and for the product with that
// matrix in double and in single precision; each with every instruction set, for springs in slices and, where the engine would
// put them there, in bands. Beside each stands the time in which memory of the same size can be read and written at all, by a
// triad in the same run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/forces/total_force.h"
#include "engine/linear/multigrid.h"
#include "engine/model/cloth_model.h"
#include "tests/bench/bench_report.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::AlignedVector;
using percale::SpringLayout;
using percale::Vec3Arrays;
using percale::test::Figures;

// The bound is that of memory, not that of narrow instructions.
#if defined(__x86_64__) && defined(__linux__)
#define PERCALE_WIDEST __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define PERCALE_WIDEST
#endif

PERCALE_WIDEST void triad(double* a, const double* b, const double* c, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + 3.0 * c[i];
}

/// a = b + 3 c over three lists of doubles, `bytes` in all.
class Triad {
public:
    explicit Triad(double bytes)
        : a_(static_cast<std::size_t>(bytes / (3 * sizeof(double))) + 1), b_(a_.size(), 1.0), c_(a_.size(), 2.0) {}
    void run() { triad(a_.data(), b_.data(), c_.data(), a_.size()); }
    bool is_right() const { return a_.front() == 7.0 && a_.back() == 7.0; }

private:
    AlignedVector<double> a_, b_, c_;
};

template <class... Lists>
double bytes_of(const Lists&... lists) {
    return (0.0 + ... + static_cast<double>(lists.size() * sizeof(lists[0])));
}

double bytes_of_vectors(const Vec3Arrays& v) { return bytes_of(v.x, v.y, v.z); }

/// The engine's side: a stretched moving sheet with everything one evaluation and one product need.
class EngineSheet {
public:
    EngineSheet(int n, const percale::Kernels* kernels, SpringLayout layout) : compute_{.kernels = kernels} {
        percale::append_cloth(model_, percale::make_grid(1.0, 1.0, n, n), percale::test::bench_fabric(), "sheet");
        percale::finish_model(model_);
        model_.adjacency = percale::make_adjacency(model_.springs, model_.vertex_count(), layout);
        const percale::test::PlainSheet plain(n);
        for (auto* vectors : {&positions_, &velocities_, &product_}) vectors->resize(n * n);
        percale::copy_in(plain.positions, positions_);
        percale::copy_in(plain.velocities, velocities_);
        percale::set_step_springs(compute_, {model_.adjacency, positions_, percale::DampingForm::length_rate, 1.0 / 60.0},
                                  springs_);
        set_matrix();
    }
    EngineSheet(const EngineSheet&) = delete;
    EngineSheet& operator=(const EngineSheet&) = delete;

    bool has_bands() const { return model_.adjacency.bands.count > 0; }
    int spring_count() const { return model_.springs.size(); }
    void evaluate(bool with_matrix) {
        percale::evaluate_forces({.compute = &compute_,
                                  .model = &model_,
                                  .springs = &springs_,
                                  .positions = &positions_,
                                  .velocities = &velocities_,
                                  .gravity = percale::Vec3(0.0, -9.81, 0.0),
                                  .dt = 1.0 / 60.0,
                                  .with_matrix = with_matrix},
                                 forces_);
    }
    void multiply() { percale::multiply(matrix_, velocities_, points_, product_); }
    void multiply_floats() { multigrid_->multiply(float_velocities_, float_product_); }

    /// Bytes that one evaluation must read and write; the constants stand once a place of the layout.
    double force_bytes(bool with_matrix) const {
        const double places = with_matrix ? bytes_of(forces_.spring_terms.values) : 0.0;
        return places + layout_bytes() + 2 * constant_bytes() + bytes_of(model_.mass, forces_.spring_terms.points) +
               bytes_of_vectors(positions_) + bytes_of_vectors(forces_.total);
    }
    double product_bytes() const {
        return layout_bytes() + bytes_of(forces_.spring_terms.values, matrix_.mass, matrix_.free, points_) +
               bytes_of_vectors(velocities_) + bytes_of_vectors(product_);
    }
    double float_product_bytes() const {
        return layout_bytes() + bytes_of(forces_.spring_terms.values, float_velocities_, float_product_) +
               0.5 * bytes_of(matrix_.mass, points_);
    }

private:
    void set_matrix() {
        evaluate(true);
        percale::set_pattern(compute_, model_.adjacency, model_.mass, matrix_);
        percale::fill_matrix(forces_.spring_terms, {}, percale::ForceBlocks(), matrix_);
        multiply();
        multigrid_ = std::make_unique<percale::Multigrid>(compute_, model_.adjacency, model_.rest);
        multigrid_->fill(matrix_, percale::Multigrid::Coarser::filled);
        const std::size_t padded = multigrid_->padded();
        float_velocities_.assign(3 * padded, 0.0f);
        float_product_.assign(3 * padded, 0.0f);
        percale::for_chunks(compute_, multigrid_->slices(), [&](percale::Slices range) {
            compute_.kernels->to_float(1.0, velocities_.axes(), {float_velocities_.data(), padded}, range);
        });
        multiply_floats();
        check_products();
    }

    /// Both products are of the same matrix and vector. Throws where they differ by more than rounding.
    void check_products() const {
        double difference = 0.0, size = 0.0;
        for (std::size_t i = 0; i < product_.x.size(); ++i) {
            difference = std::max(difference, std::abs(product_.x[i] - float_product_[i]));
            size = std::max(size, std::abs(product_.x[i]));
        }
        if (!(difference < 1e-3 * size)) throw std::runtime_error("the products in double and in single precision differ");
    }

    double layout_bytes() const { return model_.adjacency.bands.count > 0 ? 0.0 : bytes_of(model_.adjacency.other); }
    double constant_bytes() const { return bytes_of(model_.adjacency.stiffness); }

    percale::Compute compute_;
    percale::ClothModel model_;
    Vec3Arrays positions_, velocities_, product_;
    percale::StepSprings springs_;
    percale::Forces forces_;
    percale::BlockMatrix matrix_;
    AlignedVector<double> points_;
    std::unique_ptr<percale::Multigrid> multigrid_;
    AlignedVector<float> float_velocities_, float_product_;
};

/// One thing that is measured, and the memory it goes through.
struct Item {
    std::string set, layout, what;
    std::function<void()> call;
    double bytes;
};

void add_items(EngineSheet& sheet, const std::string& set, const std::string& layout, std::vector<Item>& items) {
    items.push_back({set, layout, "forces", [&sheet] { sheet.evaluate(false); }, sheet.force_bytes(false)});
    items.push_back({set, layout, "forces, matrix", [&sheet] { sheet.evaluate(true); }, sheet.force_bytes(true)});
    items.push_back({set, layout, "product f64", [&sheet] { sheet.multiply(); }, sheet.product_bytes()});
    items.push_back({set, layout, "product f32", [&sheet] { sheet.multiply_floats(); }, sheet.float_product_bytes()});
}

constexpr int passes = 5;  // one after the other, so that the caches hold what fits into them, as in a solve

/// The shortest time of each item, then of a triad over as many bytes, s.
std::vector<double> time_items(const std::vector<Item>& items, int rounds) {
    std::vector<Triad> triads;
    for (const Item& item : items) triads.emplace_back(item.bytes);
    std::vector<std::function<void()>> calls;
    const auto add = [&calls](auto call) {
        calls.push_back([call] {
            for (int pass = 0; pass < passes; ++pass) call();
        });
    };
    for (const Item& item : items) add([&item] { item.call(); });
    for (Triad& triad : triads) add([&triad] { triad.run(); });
    std::vector<double> seconds = percale::test::min_seconds(rounds, calls);
    for (double& time : seconds) time /= passes;
    for (const Triad& triad : triads) {
        if (!triad.is_right()) throw std::runtime_error("the triad gave a wrong number");
    }
    return seconds;
}

Figures row(int n, const Item& item, double seconds, double unit, double triad) {
    const double springs = static_cast<double>(percale::test::plain_springs(n).size());
    std::printf("%4d  %-8s %-6s %-14s %9.4f %8.2f %7.3f %7.2f %9.4f %7.2f\n", n, item.set.c_str(), item.layout.c_str(),
                item.what.c_str(), 1e3 * seconds, 1e9 * seconds / springs, seconds / unit, item.bytes / 1e6, 1e3 * triad,
                seconds / triad);
    return {{"n", n},
            {"instructions", item.set},
            {"layout", item.layout},
            {"what", item.what},
            {"ms", 1e3 * seconds},
            {"ns_per_spring", 1e9 * seconds / springs},
            {"units", seconds / unit},
            {"megabytes", item.bytes / 1e6},
            {"triad_ms", 1e3 * triad},
            {"times_bound", seconds / triad}};
}

/// Measures everything with one instruction set. The plain loop is in each run of the clock, so each has its own unit.
void measure_set(int n, const percale::Kernels* kernels, int rounds, Figures& rows) {
    const std::string set = percale::instruction_set_name(kernels->set);
    percale::test::PlainSheet plain(n);
    EngineSheet best(n, kernels, SpringLayout::best), slices(n, kernels, SpringLayout::slices);
    if (static_cast<int>(plain.springs.size()) != best.spring_count()) {
        throw std::runtime_error("the plain loop and the engine have different springs");
    }
    std::vector<Item> items = {{"-", "-", "plain loop", [&plain] { plain.evaluate(); },
                                bytes_of(plain.springs, plain.positions, plain.velocities, plain.forces)}};
    if (best.has_bands()) add_items(best, set, "bands", items);
    add_items(slices, set, "slices", items);
    const std::vector<double> seconds = time_items(items, rounds);
    for (std::size_t k = 0; k < items.size(); ++k) {
        rows.push_back(row(n, items[k], seconds[k], seconds[0], seconds[items.size() + k]));
    }
    std::fflush(stdout);
}

std::vector<const percale::Kernels*> available_sets(const std::string& wish) {
    std::vector<const percale::Kernels*> sets;
    for (const auto set : {percale::InstructionSet::baseline, percale::InstructionSet::avx2, percale::InstructionSet::avx512}) {
        const bool wanted = wish == "all" || wish == percale::instruction_set_name(set);
        if (!wanted) continue;
        if (const percale::Kernels* kernels = percale::kernels_for(set)) sets.push_back(kernels);
    }
    if (sets.empty()) throw std::runtime_error("--instructions " + wish + ": this build or this processor lacks them");
    return sets;
}

Figures measure(const std::vector<int>& sizes, int rounds, const std::string& instructions) {
    const auto sets = available_sets(instructions);
    std::printf("%4s  %-8s %-6s %-14s %9s %8s %7s %7s %9s %7s\n", "N", "set", "layout", "", "ms", "ns/sprg", "U", "MB",
                "triad ms", "times");
    Figures rows = Figures::array();
    for (const int n : sizes) {
        for (const percale::Kernels* kernels : sets) measure_set(n, kernels, rounds, rows);
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What forces and products with the step matrix cost, against a plain loop and against memory.",
                 "percale_force_cost");
    std::vector<int> sizes = {33, 65, 129, 257};
    int rounds = 30;
    std::string instructions = "all";
    app.add_option("--sizes", sizes, "N of the sheets")->capture_default_str()->check(CLI::Range(4, 1000));
    app.add_option("--rounds", rounds, "times that 5 passes of each are measured; the least counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100000));
    app.add_option("--instructions", instructions, "baseline, avx2, avx512 or all that there are")
        ->capture_default_str()
        ->check(CLI::IsMember({"baseline", "avx2", "avx512", "all"}));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(sizes, rounds, instructions); });
}
