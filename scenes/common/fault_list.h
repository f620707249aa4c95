#pragma once

#include <vector>

#include "common/scene_file_error.h"

namespace percale::scenes {

/// What checks do with faults: the first one is thrown, or all are kept.
class FaultList {
public:
    /// `keep`: false to throw.
    explicit FaultList(bool keep) : keep_(keep) {}

    /// Runs one check, which throws SceneError for a fault.
    template <class Check>
    void attempt(Check check) {
        if (!keep_) return check();
        try {
            check();
        } catch (const SceneFileError& error) {
            found.push_back(error);
        } catch (const SceneError& error) {
            found.push_back(SceneFileError({}, error.what()));
        }
    }

    std::vector<SceneFileError> found;  // in the order in which they were found

private:
    bool keep_;
};

}  // namespace percale::scenes
