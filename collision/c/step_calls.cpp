#include "c/handles.h"
#include "c/report_structs.h"
#include "c/structs.h"

// Steps, plans and saved states of percale.h.

using namespace percale::c_interface;

namespace {

/// Keeps the fault of a start that is refused.
template <class Work>
void with_start_fault(percale_simulation& of, Work work) {
    try {
        work();
    } catch (const percale::StartError& error) {
        of.start_fault = error.fault();
        throw;
    }
}

}  // namespace

percale_status percale_prepare(percale_simulation* simulation) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { with_start_fault(of, [&] { of.simulation.prepare(); }); });
}

percale_status percale_start_repair(const percale_simulation* simulation, percale_start_move* moves, size_t capacity,
                                    size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        std::vector<percale_start_move> reported;
        for (const percale::StartMove& move : of.simulation.start_repair()) reported.push_back(c_start_move(move));
        give_items<percale_start_move>(reported, {moves, capacity, count});
    });
}

percale_status percale_last_start_fault(const percale_simulation* simulation, percale_start_fault* fault) {
    return call_on(__func__, simulation,
                   [&](const percale_simulation& of) { known(fault, "fault") = c_start_fault(of.start_fault); });
}

percale_status percale_step(percale_simulation* simulation, percale_step_report* report) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        if (report != nullptr) static_cast<void>(known(report, "report"));
        percale::StepReport made;
        with_start_fault(of, [&] { made = of.simulation.step(); });
        of.explanation = made.explanation();
        if (report != nullptr) *report = c_report(made);
        if (!made.ok()) throw CallError(PERCALE_STEP_FAILED, of.explanation);
    });
}

const char* percale_explanation(const percale_simulation* simulation) {
    const char* text = nullptr;
    call_on(__func__, simulation, [&](const percale_simulation& of) { text = of.explanation.c_str(); });
    return text;
}

percale_status percale_keep_impulses(percale_simulation* simulation, int keep) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.keep_impulses(keep != 0); });
}

percale_status percale_keep_previous_positions(percale_simulation* simulation, int keep) {
    return call_on(__func__, simulation, [&](percale_simulation& of) { of.simulation.keep_previous_positions(keep != 0); });
}

percale_status percale_plan_text(const percale_simulation* simulation, const percale_scripted_changes* changes, char* text,
                                 size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        const auto given = known_or_default(changes, "changes");
        const percale::ScriptedChanges to_come{
            .obstacles = given.obstacles != 0, .pins = given.pins != 0, .gravity = given.gravity != 0, .wind = given.wind != 0};
        give_text(plan_lines(of.simulation.plan(to_come)), {text, capacity, count});
    });
}

percale_status percale_save(const percale_simulation* simulation, void* bytes, size_t capacity, size_t* count) {
    return call_on(__func__, simulation, [&](const percale_simulation& of) {
        const std::vector<std::byte> saved = of.simulation.save();
        give_items<std::byte>(saved, {static_cast<std::byte*>(bytes), capacity, count});
    });
}

percale_status percale_restore(percale_simulation* simulation, const void* bytes, size_t size) {
    return call_on(__func__, simulation, [&](percale_simulation& of) {
        const auto* saved = static_cast<const std::byte*>(&demanded(static_cast<const std::byte*>(bytes), "bytes"));
        of.simulation.restore({saved, size});
    });
}
