#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "tests/support/forces/kernel_problem.h"

namespace percale::test {

constexpr double kernel_dt = 1.0 / 60.0, kernel_alpha = 0.37, kernel_beta = -0.61;

/// Output of a kernel, array by array, and its return value.
struct Result {
    std::vector<std::vector<double>> arrays;
    double sum = 0.0;

    template <class List>
    void add(const List& list) {
        arrays.emplace_back(list.begin(), list.end());
    }
    void add(const Vec3Arrays& vectors) {
        for (const auto* axis : {&vectors.x, &vectors.y, &vectors.z}) add(*axis);
    }
};

using Ranges = std::vector<Slices>;

/// A kernel, run over ranges of slices, and a plain implementation.
struct Case {
    const char* name;
    double tolerance;  // relative to the largest number of each array
    std::function<Result(const Kernels&, KernelProblem, const Ranges&)> run;
    std::function<Result(KernelProblem)> plain;
};

inline std::vector<const Kernels*> available() {
    std::vector<const Kernels*> list;
    for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
        if (kernels_for(set)) list.push_back(kernels_for(set));
    }
    return list;
}

inline AlignedVector<double> packed(const Vec3Arrays& from) {
    AlignedVector<double> points;
    for (std::size_t i = 0; i < from.padded_size(); ++i) points.insert(points.end(), {from.x[i], from.y[i], from.z[i], 0.0});
    return points;
}

inline AlignedVector<float> packed(const KernelProblem& problem, const AlignedVector<float>& from) {
    AlignedVector<float> points;
    for (std::size_t i = 0; i < problem.padded; ++i) {
        points.insert(points.end(), {from[i], from[problem.padded + i], from[2 * problem.padded + i], 0.0f});
    }
    return points;
}

inline ConstAxes view(const Vec3Arrays& vectors) { return vectors.axes(); }

/// Floats of a kernel's result, one 3-vector a vertex.
struct FloatResult {
    std::size_t padded;
    AlignedVector<float> data;
    explicit FloatResult(const KernelProblem& problem) : padded(problem.padded), data(3 * problem.padded, 0.0f) {}
    void set(int i, const Vec3& value) {
        for (std::size_t axis = 0; axis < 3; ++axis) data[axis * padded + i] = static_cast<float>(value[static_cast<int>(axis)]);
    }
};

template <class Work>
void for_vertices(const KernelProblem& problem, Work work) {
    for (int i = 0; i < static_cast<int>(problem.padded); ++i) work(i);
}

/// work(entry) for the entries of a vertex.
template <class Work>
void for_entries(const KernelProblem& problem, int i, Work work) {
    const int s = i / slice_lanes;
    for (int e = problem.start[s] + i % slice_lanes; e < problem.start[s + 1]; e += slice_lanes) work(e);
}

// Springs

inline Case start_case() {
    return {"start_springs", 1e-12,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                const AlignedVector<double> points = packed(p.x);
                AlignedVector<double> stiffness(p.other.size()), rest(p.other.size());
                const StartPass pass{.springs = p.springs(),
                                     .positions = view(p.x),
                                     .points = points.data(),
                                     .dt = kernel_dt,
                                     .stiffness = stiffness.data(),
                                     .rest = rest.data()};
                for (const Slices range : ranges) kernels.start_springs(pass, range);
                Result result;
                result.add(stiffness);
                result.add(rest);
                return result;
            },
            [](KernelProblem p) {
                std::vector<double> stiffness, rest;
                for (int e = 0; e < p.start.back(); ++e) {
                    const double l = (p.x.at(p.vertex_of(e)) - p.x.at(p.other[e])).norm(), rate = p.damping[e] / kernel_dt;
                    stiffness.push_back(p.stiffness[e] + rate);
                    const double sum = p.stiffness[e] * p.rest_length[e] + rate * l;
                    rest.push_back(stiffness.back() > 0.0 ? sum / stiffness.back() : 0.0);
                }
                Result result;
                result.add(stiffness);
                result.add(rest);
                return result;
            }};
}

struct PlainSpring {
    Vec3 force, d;
    double energy, along, across;
};

inline PlainSpring plain_spring(const KernelProblem& p, int e, bool with_motion) {
    const int i = p.vertex_of(e), j = p.other[e];
    const Vec3 x = p.x.at(i) - p.x.at(j);
    const double l = x.norm(), k = p.stiffness[e], stretch = l - p.rest_length[e], c = with_motion ? p.damping[e] : 0.0;
    const Vec3 d = l > 0.0 ? Vec3(x / l) : Vec3(Vec3::Zero());
    const double tension = k * stretch + c * (p.v.at(i) - p.v.at(j)).dot(d), along = kernel_dt * kernel_dt * k + kernel_dt * c;
    // Each spring is seen from both ends: half its energy from each.
    return {.force = -tension * d,
            .d = d,
            .energy = 0.25 * k * stretch * stretch,
            .along = along,
            .across = l > 0.0 ? std::clamp(kernel_dt * kernel_dt * tension / l, 0.0, along) : along};
}

inline Result run_springs(const Kernels& kernels, KernelProblem& p, const Ranges& ranges, bool with_matrix, bool with_motion) {
    const AlignedVector<double> points = packed(p.x), motion = packed(p.v);
    AlignedVector<float> values(4 * p.other.size(), -7.0f);
    const SpringPass pass{.springs = p.springs(),
                          .positions = view(p.x),
                          .velocities = view(p.v),
                          .points = points.data(),
                          .motion = with_motion ? motion.data() : nullptr,
                          .dt = kernel_dt,
                          .forces = p.y.axes(),
                          .values = with_matrix ? values.data() : nullptr,
                          .scratch = nullptr};
    Result result;
    for (const Slices range : ranges) result.sum += kernels.springs(pass, range);
    result.add(p.y);
    result.add(values);
    return result;
}

inline Result plain_springs(KernelProblem& p, bool with_matrix, bool with_motion) {
    Result result;
    std::vector<double> values(4 * p.other.size(), -7.0);
    for_vertices(p, [&](int i) {
        for_entries(p, i, [&](int e) {
            const PlainSpring spring = plain_spring(p, e, with_motion);
            p.y.add(i, spring.force);
            result.sum += spring.energy;
            if (!with_matrix) return;
            const std::size_t at = 4 * static_cast<std::size_t>(e - e % slice_lanes) + e % slice_lanes;
            values[at] = spring.across;
            const Vec3 w = std::sqrt(spring.along - spring.across) * spring.d;
            for (int axis = 0; axis < 3; ++axis) values[at + (axis + 1) * slice_lanes] = w[axis];
        });
    });
    result.add(p.y);
    result.add(values);
    return result;
}

inline Case spring_case(bool with_matrix, bool with_motion) {
    return {with_motion ? "springs with velocities" : "springs", with_matrix ? 1e-6 : 1e-12,
            [=](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                return run_springs(kernels, p, ranges, with_matrix, with_motion);
            },
            [=](KernelProblem p) { return plain_springs(p, with_matrix, with_motion); }};
}

// Vectors

inline Case pack_case() {
    return {"pack_points", 0.0,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                AlignedVector<double> points(4 * p.padded);
                AlignedVector<float> floats(4 * p.padded);
                for (const Slices range : ranges) {
                    kernels.pack_points(view(p.x), points.data(), range);
                    kernels.pack_float_points({p.float_x.data(), p.padded}, floats.data(), range);
                }
                Result result;
                result.add(points);
                result.add(floats);
                return result;
            },
            [](KernelProblem p) {
                Result result;
                result.add(packed(p.x));
                result.add(packed(p, p.float_x));
                return result;
            }};
}

inline Case dot_case() {
    return {"dot", 1e-12,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                Result result;
                for (const Slices range : ranges) result.sum += kernels.dot(view(p.x), view(p.v), range);
                return result;
            },
            [](KernelProblem p) {
                Result result;
                for_vertices(p, [&](int i) { result.sum += p.x.at(i).dot(p.v.at(i)); });
                return result;
            }};
}

inline Case advance_case() {
    return {"advance and turn", 1e-12,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                Result result;
                Vec3Arrays r = p.v;
                for (const Slices range : ranges) {
                    result.sum += kernels.advance(kernel_alpha, view(p.v), view(p.y), p.x.axes(), r.axes(), range);
                    kernels.turn(kernel_beta, view(r), p.y.axes(), range);
                }
                for (const Vec3Arrays* vectors : {&p.x, &r, &p.y}) result.add(*vectors);
                return result;
            },
            [](KernelProblem p) {
                Result result;
                Vec3Arrays r = p.v;
                for_vertices(p, [&](int i) {
                    p.x.add(i, kernel_alpha * p.v.at(i));
                    r.add(i, -kernel_alpha * p.y.at(i));
                    result.sum += r.at(i).squaredNorm();
                    p.y.set(i, r.at(i) + kernel_beta * p.y.at(i));
                });
                for (const Vec3Arrays* vectors : {&p.x, &r, &p.y}) result.add(*vectors);
                return result;
            }};
}

inline Case jacobi_case() {
    return {"jacobi", 1e-12,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                for (const Slices range : ranges) kernels.jacobi(p.blocks.data(), p.padded, view(p.x), p.y.axes(), range);
                Result result;
                result.add(p.y);
                return result;
            },
            [](KernelProblem p) {
                for_vertices(p, [&](int i) { p.y.set(i, p.block(i) * p.x.at(i)); });
                Result result;
                result.add(p.y);
                return result;
            }};
}

inline Case conversion_case() {
    return {"to_float and add_float", 1e-6,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                FloatResult floats(p);
                for (const Slices range : ranges) {
                    kernels.to_float(kernel_alpha, view(p.x), {floats.data.data(), p.padded}, range);
                    kernels.add_float(kernel_beta, {p.float_x.data(), p.padded}, p.y.axes(), range);
                }
                Result result;
                result.add(floats.data);
                result.add(p.y);
                return result;
            },
            [](KernelProblem p) {
                FloatResult floats(p);
                for_vertices(p, [&](int i) {
                    floats.set(i, kernel_alpha * p.x.at(i));
                    p.y.add(i, kernel_beta * p.float_at(p.float_x, i));
                });
                Result result;
                result.add(floats.data);
                result.add(p.y);
                return result;
            }};
}

inline Case float_dot_case() {
    return {"float_dot", 0.0,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                Result result;
                for (const Slices range : ranges) {
                    result.sum += kernels.float_dot({p.float_x.data(), p.padded}, {p.float_y.data(), p.padded}, range);
                }
                return result;
            },
            [](KernelProblem p) {
                Result result;
                for_vertices(p, [&](int i) {
                    const auto term = [&](std::size_t axis) {
                        return p.float_x[axis * p.padded + i] * p.float_y[axis * p.padded + i];
                    };
                    result.sum += term(0) + term(1) + term(2);
                });
                return result;
            }};
}

inline Case float_advance_case() {
    return {"float_advance and float_turn", 0.0,
            [](const Kernels& kernels, KernelProblem p, const Ranges& ranges) {
                FloatResult q(p);
                std::copy(p.blocks.begin(), p.blocks.begin() + static_cast<std::ptrdiff_t>(q.data.size()), q.data.begin());
                const auto view = [&](AlignedVector<float>& list) { return FloatVec3Arrays{list.data(), p.padded}; };
                Result result;
                for (const Slices range : ranges) {
                    const FloatVec3Arrays direction = view(p.float_y), r = view(p.float_r);
                    result.sum += kernels.float_advance(0.37f, direction, view(q.data), view(p.float_x), r, range);
                    kernels.float_turn(-0.61f, r, direction, range);
                }
                for (const auto* list : {&p.float_x, &p.float_r, &p.float_y}) result.add(*list);
                return result;
            },
            [](KernelProblem p) {
                Result result;
                for (std::size_t k = 0; k < 3 * p.padded; ++k) {
                    p.float_x[k] += 0.37f * p.float_y[k];
                    p.float_r[k] -= 0.37f * p.blocks[k];
                    p.float_y[k] = p.float_r[k] + -0.61f * p.float_y[k];
                }
                for_vertices(p, [&](int i) {
                    const auto square = [&](std::size_t axis) {
                        return p.float_r[axis * p.padded + i] * p.float_r[axis * p.padded + i];
                    };
                    result.sum += square(0) + square(1) + square(2);
                });
                for (const auto* list : {&p.float_x, &p.float_r, &p.float_y}) result.add(*list);
                return result;
            }};
}

}  // namespace percale::test
