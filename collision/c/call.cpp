#include "c/call.h"

#include <exception>
#include <new>

#include "percale/contact.h"
#include "percale/workers.h"

namespace percale::c_interface {

void ErrorText::set(const char* function, const char* what) noexcept {
    try {
        std::string text = function;
        text += ": ";
        text += what;
        text_.swap(text);
        shown_ = text_.c_str();
    } catch (...) {
        shown_ = "out of memory, also for the text of this error";
    }
}

ErrorText& thread_error() noexcept {
    thread_local ErrorText text;
    return text;
}

percale_status failure(const char* function, ErrorText* of_object) noexcept {
    const auto reported = [&](percale_status status, const char* what) {
        thread_error().set(function, what);
        if (of_object != nullptr) of_object->set(function, what);
        return status;
    };
    try {
        throw;
    } catch (const CallError& error) {
        return reported(error.status(), error.what());
    } catch (const StartError& error) {
        return reported(PERCALE_START_REFUSED, error.what());
    } catch (const WorkersError& error) {
        return reported(PERCALE_INTERNAL_ERROR, error.what());
    } catch (const SceneError& error) {
        return reported(PERCALE_INVALID_ARGUMENT, error.what());
    } catch (const std::bad_alloc&) {
        return reported(PERCALE_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        return reported(PERCALE_INTERNAL_ERROR, error.what());
    } catch (...) {
        return reported(PERCALE_INTERNAL_ERROR, "an exception of unknown type");
    }
}

}  // namespace percale::c_interface
