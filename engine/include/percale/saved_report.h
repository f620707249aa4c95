#pragma once

#include "percale/report.h"
#include "percale/saved_state.h"

// Parts of reports as saved states hold them.
namespace percale {

template <class Archive, OfType<StepEnergy> Value>
void exchange(Archive& archive, Value& energy) {
    archive(energy.kinetic, energy.gravity, energy.elastic, energy.contact, energy.work);
    for (const auto entry : ledger_entries) archive(energy.*entry);
}

template <class Archive, OfType<StageTimes> Value>
void exchange(Archive& archive, Value& times) {
    archive(times.refresh, times.evaluate, times.force, times.setup, times.solve, times.cut, times.measure);
}

}  // namespace percale
