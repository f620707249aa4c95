#pragma once

#include <string>

#include "percale/error.h"

namespace percale::scenes::test {

/// The message with which an action is refused; empty if it is not. Anything but a SceneError passes through and fails the test.
template <typename Action>
std::string message_of(const Action& action) {
    try {
        action();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

}  // namespace percale::scenes::test
