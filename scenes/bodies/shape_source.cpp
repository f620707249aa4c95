#include "bodies/shape_source.h"

#include <algorithm>
#include <cmath>

#include "common/bounds.h"
#include "common/text.h"

namespace percale::scenes {

std::vector<Vec3> between(std::vector<Vec3> from, const std::vector<Vec3>& to, double share) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] += share * (to[i] - from[i]);
    return from;
}

double largest_displacement(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    double squared = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) squared = std::max(squared, (to[i] - from[i]).squaredNorm());
    return std::sqrt(squared);
}

double diagonal(const std::vector<Vec3>& shape) { return Bounds(shape).extent().norm(); }

void SampledShapes::set_equal_times(int count, double rate) {
    times_.clear();
    for (int k = 0; k < count; ++k) times_.push_back(k / rate);
}

const std::vector<Vec3>& SampledShapes::sample(int number, int other) {
    for (const Loaded& known : loaded_) {
        if (known.number == number) return known.vertices;
    }
    Loaded& place = loaded_[0].number == other ? loaded_[1] : loaded_[0];
    place = {number, load(number)};
    return place.vertices;
}

std::vector<Vec3> SampledShapes::at(double time) {
    const double t = std::clamp(time, 0.0, length());
    const int from = static_cast<int>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin()) - 1;
    const int to = std::min(from + 1, static_cast<int>(times_.size()) - 1);
    const std::vector<Vec3>& vertices = sample(from, to);
    if (t == times_[from]) return vertices;
    return between(vertices, sample(to, from), (t - times_[from]) / (times_[to] - times_[from]));
}

std::string SampledShapes::text() const {
    return counted(static_cast<long>(times_.size()), "frame") + " in " + short_number(length()) + " s";
}

}  // namespace percale::scenes
