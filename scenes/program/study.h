#pragma once

#include <functional>
#include <string>
#include <vector>

#include "program/common_options.h"
#include "program/stop_signals.h"
#include "tolerances.h"

namespace percale::program {

/// What the commands of studies take; each preset takes a part of it.
struct StudyOptions {
    CommonOptions common;
    std::string file, folder;  // a scene, a study or the folder of one; the output
    std::string preset, range;
    std::vector<std::string> schemes, steps, tolerances, factors;
    int repeats = 3, max_steps = scenes::usual_steps, cell = -1, jobs = 1;
    double reference_error = 1e-9;  // m
    bool slurm = false, collect = false;
};

/// What the variants of a study came to.
struct StudyOutcome {
    std::string csv, svg, text;  // the last is printed
    bool well = true;
};

/// Makes the outcome, writes FOLDER/NAME.csv and .svg and prints it; returns the exit code. What cannot be written is reported
/// before anything is made, and after a stop (StudyStopped) nothing is there.
int write_outcome(const StudyOptions& options, const std::string& folder, const std::string& name,
                  const std::function<StudyOutcome(const StopSignals&)>& make);

/// Variants at a time.
constexpr int max_study_jobs = 1024;

// The presets: each runs its study and returns an exit code.
int compare(const StudyOptions& options);
int stress(const StudyOptions& options);
int sweep(const StudyOptions& options);

}  // namespace percale::program
