#include "study/batch_files.h"

#include <filesystem>

#include "percale/error.h"

namespace percale::scenes {

namespace {

constexpr std::size_t max_tasks = 1000;  // one less than Slurm's own limit, MaxArraySize

/// A word of a recipe: a dollar sign is make's own.
std::string recipe_text(const std::string& text) {
    std::string out;
    for (const char letter : text) out += letter == '$' ? "$$" : std::string(1, letter);
    return out;
}

}  // namespace

std::string shell_word(const std::string& word) {
    std::string text = "'";
    for (const char letter : word) text += letter == '\'' ? "'\\''" : std::string(1, letter);
    return text + "'";
}

BatchFiles batch_files(const Study& study, const StudyFolder& folder, const std::string& program) {
    const std::size_t runs = study.runs.size(), chunk = (runs + max_tasks - 1) / max_tasks, tasks = (runs + chunk - 1) / chunk;
    const std::string path = std::filesystem::absolute(folder.path()).lexically_normal().string();
    for (const std::string& name : {path, program})
        if (name.find('\n') != std::string::npos)
            throw SceneError(name, "a name with a line end is none that a Makefile can hold");
    const std::string sweep = shell_word(program) + " sweep " + shell_word(path) + " --quiet";
    BatchFiles files;
    files.slurm = "#!/bin/sh\n#SBATCH --job-name=percale\n#SBATCH --array=0-" + std::to_string(tasks - 1) +
                  "\n#SBATCH --cpus-per-task=1\n#SBATCH --output=/dev/null\nfirst=$((SLURM_ARRAY_TASK_ID * " +
                  std::to_string(chunk) + "))\nlast=$((first + " + std::to_string(chunk - 1) + "))\n[ $last -lt " +
                  std::to_string(runs) + " ] || last=" + std::to_string(runs - 1) + "\nexec " + sweep + " --run $first-$last\n";
    files.makefile = "all:\n.PHONY: all\n";
    for (std::size_t run = 0; run < runs; ++run) {
        const std::string number = std::to_string(run),
                          target = folder.folder_of(run).substr(folder.path().size() + 1) + "/report.json";
        const std::string command = sweep + " --run " + number + "-" + number;
        files.makefile += "all: " + target + "\n" + target + ":\n\t" + recipe_text(command) + "\n";
        files.commands += command + "\n";
    }
    return files;
}

}  // namespace percale::scenes
