#include "study/study_folder.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "common/input_file.h"
#include "common/whole_file.h"
#include "export/kept_run.h"
#include "percale/error.h"

namespace percale::scenes {

namespace fs = std::filesystem;

std::string StudyFolder::folder_of(std::size_t run) const {
    char number[24];
    std::snprintf(number, sizeof number, "%05zu", run);
    return path_ + "/runs/" + number;
}

void StudyFolder::begin(const Study& study) const {
    std::error_code error;
    fs::create_directories(path_ + "/runs", error);
    if (error) throw SceneError(path_ + ": cannot be made: " + error.message());
    const std::string text = study_text(study), stored = file("study.json");
    if (!fs::exists(stored)) return write_whole_file(stored, text);
    if (read_text(stored) != text)
        throw SceneError(
            path_ + ": holds another study, or this one before its file or its scene was changed; name another folder with -o");
}

bool StudyFolder::is_done(std::size_t run) const { return ended_run(folder_of(run)).has_value(); }

std::string StudyFolder::complaint_of(std::size_t run) const {
    std::ifstream in(log_of(run));
    std::string line;
    std::getline(in, line);
    return line;
}

std::vector<std::string> run_words(const Study& study, const StudyFolder& folder, std::size_t run, const std::string& program) {
    std::vector<std::string> words = {program,   "run",   study.scene,     "-o", folder.folder_of(run),
                                      "--quiet", "--set", "step.threads=1"};
    for (const Override& change : overrides_of(study, run)) {
        words.push_back("--set");
        words.push_back(change.key + "=" + change.value);
    }
    return words;
}

}  // namespace percale::scenes
