#include "c/handles.h"
#include "c/host.h"
#include "percale/report.h"

// Functions of percale.h about the library itself.

using namespace percale::c_interface;

static_assert(PERCALE_STEP_OK == static_cast<int>(percale::StepStatus::ok));
static_assert(PERCALE_STEP_NOT_CONVERGED == static_cast<int>(percale::StepStatus::not_converged));
static_assert(PERCALE_STEP_HALVED == static_cast<int>(percale::StepStatus::halved));
static_assert(PERCALE_STEP_TOLERANCE_MISSED == static_cast<int>(percale::StepStatus::tolerance_missed));
static_assert(PERCALE_STEP_PIN_BLOCKED == static_cast<int>(percale::StepStatus::pin_blocked));
static_assert(PERCALE_STEP_OBSTACLE_TOO_FAST == static_cast<int>(percale::StepStatus::obstacle_too_fast));
static_assert(PERCALE_STEP_WRONG_DERIVATIVE == static_cast<int>(percale::StepStatus::wrong_derivative));
static_assert(PERCALE_STEP_NOT_FINITE == static_cast<int>(percale::StepStatus::not_finite));
static_assert(PERCALE_STEP_WORK_LIMIT == static_cast<int>(percale::StepStatus::work_limit));
static_assert(PERCALE_STEP_CANCELLED == static_cast<int>(percale::StepStatus::cancelled));

const char* percale_version(void) { return PERCALE_C_VERSION; }

const char* percale_status_text(percale_status status) {
    switch (status) {
        case PERCALE_OK:
            return "ok";
        case PERCALE_INVALID_ARGUMENT:
            return "invalid argument";
        case PERCALE_BUFFER_TOO_SMALL:
            return "buffer too small";
        case PERCALE_START_REFUSED:
            return "start refused";
        case PERCALE_STEP_FAILED:
            return "step failed";
        case PERCALE_NOT_BUILT:
            return "not built";
        case PERCALE_OUT_OF_MEMORY:
            return "out of memory";
        case PERCALE_INTERNAL_ERROR:
            return "internal error";
    }
    return "unknown status";
}

const char* percale_step_status_text(int status) {
    if (status < PERCALE_STEP_OK || status > PERCALE_STEP_CANCELLED) return "unknown status";
    return percale::status_word(static_cast<percale::StepStatus>(status));
}

const char* percale_last_error(const percale_simulation* simulation) {
    return simulation == nullptr ? thread_error().text() : simulation->error.text();
}

int percale_has_detector(const char* detector) {
    if (detector == nullptr) return 0;
    try {
        static_cast<void>(make_detector(detector));
        return 1;
    } catch (...) {
        return 0;
    }
}
