#pragma once

#include <stdexcept>
#include <string>

namespace percale {

/// Wrong input. The message names the object, the index or key, the value and the allowed range.
/// Thrown only by the call that was given the wrong input; never for numerical trouble inside a step.
class SceneError : public std::runtime_error {
public:
    explicit SceneError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace percale
