#pragma once

#include "percale.h"
#include "percale/contact.h"
#include "percale/plan.h"
#include "percale/report.h"

// Reports of C++ as structs of C.
namespace percale::c_interface {

percale_step_report c_report(const StepReport& report);
percale_energy c_energy(const StepEnergy& energy);
percale_start_fault c_start_fault(const StartFault& fault);
percale_start_move c_start_move(const StartMove& move);

/// The entries of a plan, one a line; each line begins with a word for its kind.
std::string plan_lines(const ScenePlan& plan);

}  // namespace percale::c_interface
