#pragma once

#include <string>
#include <vector>

#include "study/study.h"

namespace percale::scenes {

/// Where the runs of a study are kept: study.json (what it is), runs/00012 (a run's folder), runs/00012.log (what it had to say).
class StudyFolder {
public:
    explicit StudyFolder(std::string path) : path_(std::move(path)) {}

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    std::string folder_of(std::size_t run) const;
    std::string log_of(std::size_t run) const { return folder_of(run) + ".log"; }

    /// Makes the folder, or takes up the one there. Throws SceneError where it holds another study, or cannot be made.
    void begin(const Study& study) const;
    /// Whether a run has ended by itself: its report is there, whole, and does not say that it was stopped.
    bool is_done(std::size_t run) const;
    /// The first line of a run's log; "" without one.
    std::string complaint_of(std::size_t run) const;

private:
    std::string path_;
};

/// The words of the command line by which `program`, a path of percale, makes a run.
std::vector<std::string> run_words(const Study& study, const StudyFolder& folder, std::size_t run, const std::string& program);

}  // namespace percale::scenes
