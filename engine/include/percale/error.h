#pragma once

#include <stdexcept>
#include <string>

namespace percale {

/// Wrong input. The message names the object, the index or key, the value and the allowed range.
/// Thrown only by the call that was given the wrong input; never for numerical trouble inside a step.
class SceneError : public std::runtime_error {
public:
    explicit SceneError(const std::string& message) : SceneError({}, message) {}
    /// what() is "subject: reason"; without a subject the reason alone.
    SceneError(const std::string& subject, const std::string& reason)
        : std::runtime_error(subject.empty() ? reason : subject + ": " + reason), subject_(subject), reason_(reason) {}

    /// The subject of the error: the name that the caller gave, or a place; "" if there is none.
    const std::string& subject() const { return subject_; }
    /// The message without the subject.
    const std::string& reason() const { return reason_; }

private:
    std::string subject_;
    std::string reason_;
};

}  // namespace percale
