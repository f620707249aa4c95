#include "python/shared_simulation.h"

#include <algorithm>
#include <stdexcept>

#include "percale/error.h"
#include "python/arrays.h"
#include "run/scene_build.h"

namespace percale::python {
namespace {

std::span<const double> flat(std::span<const Vec3> points) {
    return {points.empty() ? nullptr : points.front().data(), 3 * points.size()};
}

}  // namespace

SharedSimulation::SharedSimulation(const scenes::Scene& scene)
    : settings(scene.step), detector(scene.detector), simulation_(scene.step, scenes::make_detector(scene.detector)) {
    simulation_.set_cancel(&cancel_);
}

py::array SharedSimulation::array(ClothId cloth, Shown what) {
    check_idle();
    const Key key{cloth.index, what};
    const std::size_t columns = what == Shown::masses ? 1 : 3;
    auto found = arrays_.find(key);
    if (found == arrays_.end()) {
        const std::span<const double> now = numbers(key);
        found = arrays_.emplace(key, std::make_shared<std::vector<double>>(now.begin(), now.end())).first;
    }
    const std::vector<double>& held = *found->second;
    return shown<double>(found->second, held.data(), held.size() / columns, columns);
}

void SharedSimulation::check_idle() const {
    if (running_) throw std::runtime_error("another thread is in step or prepare of this simulation: one thread at a time");
}

std::span<const double> SharedSimulation::numbers(const Key& key) const {
    const ClothId cloth{key.first};
    if (key.second == Shown::positions) return flat(simulation_.positions(cloth));
    if (key.second == Shown::velocities) return flat(simulation_.velocities(cloth));
    return simulation_.masses(cloth);
}

void SharedSimulation::update_arrays() noexcept {
    std::erase_if(arrays_, [this](const auto& entry) {
        if (entry.second.use_count() == 1) return true;  // nobody looks at it
        try {
            std::ranges::copy(numbers(entry.first), entry.second->begin());
            return false;
        } catch (const SceneError&) {
            return true;  // the cloth was removed: what is held stays as it is
        }
    });
}

}  // namespace percale::python
