#pragma once

#include <string>

#include "percale.h"
#include "percale/error.h"

// Every function of the C interface runs within these: no exception leaves it, and every failure has a status and a text.
namespace percale::c_interface {

/// A failure with the status that the caller gets; the status of a plain SceneError is PERCALE_INVALID_ARGUMENT.
class CallError : public SceneError {
public:
    CallError(percale_status status, const std::string& message) : SceneError(message), status_(status) {}
    percale_status status() const { return status_; }

private:
    percale_status status_;
};

/// The text of an error; where memory is short, a text that states it.
class ErrorText {
public:
    void set(const char* function, const char* what) noexcept;
    const char* text() const noexcept { return shown_; }

private:
    std::string text_;
    const char* shown_ = "";
};

/// The error of the last failed call of this thread.
ErrorText& thread_error() noexcept;

/// Within a handler: returns the status of the exception; its text goes to the thread and, where there is one, to the object.
percale_status failure(const char* function, ErrorText* of_object) noexcept;

/// Throws SceneError where a pointer that is needed is NULL.
template <class Value>
Value& demanded(Value* pointer, const char* name) {
    if (pointer == nullptr) throw SceneError(name, "is NULL");
    return *pointer;
}

/// Runs the work; the text of an error names `function`.
template <class Work>
percale_status call(const char* function, Work work, ErrorText* of_object = nullptr) noexcept {
    try {
        work();
        return PERCALE_OK;
    } catch (...) {
        return failure(function, of_object);
    }
}

/// The same on a simulation's handle.
template <class Handle, class Work>
percale_status call_on(const char* function, Handle* handle, Work work) noexcept {
    ErrorText* text = handle == nullptr ? nullptr : &handle->error;
    return call(
        function, [&] { work(demanded(handle, "simulation")); }, text);
}

}  // namespace percale::c_interface
