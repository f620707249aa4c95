#pragma once

#include <string>

#include "study/study_folder.h"

namespace percale::scenes {

/// What else can do the runs of a study than this program, all by `percale sweep FOLDER --run FIRST-LAST`.
struct BatchFiles {
    std::string slurm;     // a job array of at most 1,000 tasks, for sbatch
    std::string makefile;  // make -j8
    std::string commands;  // a line a run: parallel < commands.txt
};

/// `program`: path of percale.
BatchFiles batch_files(const Study& study, const StudyFolder& folder, const std::string& program);

/// A word as a shell takes it.
std::string shell_word(const std::string& word);

}  // namespace percale::scenes
