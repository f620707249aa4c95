#include "study/draws.h"

#include <cmath>
#include <numbers>

namespace percale::scenes {

double Draws::share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double Draws::log_uniform(double lowest, double highest) { return std::exp(uniform(std::log(lowest), std::log(highest))); }

double Draws::normal(double mean, double deviation) {
    const double radius = std::sqrt(-2.0 * std::log1p(-share())), angle = 2.0 * std::numbers::pi * share();
    return mean + deviation * radius * std::cos(angle);
}

}  // namespace percale::scenes
