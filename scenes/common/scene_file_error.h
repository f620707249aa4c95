#pragma once

#include <string>

#include "common/source_place.h"
#include "percale/error.h"

// Errors that carry where something was said: in a scene file, a mesh file, on the command line.
namespace percale::scenes {

/// "file:line:column", without what is unknown.
std::string place_text(const SourcePlace& place);

/// A SceneError with its place: its subject is place_text(place).
class SceneFileError : public SceneError {
public:
    SceneFileError(const SourcePlace& place, const std::string& what) : SceneError(place_text(place), what), place_(place) {}
    const SourcePlace& place() const { return place_; }

private:
    SourcePlace place_;
};

/// Throws SceneFileError "place: what".
[[noreturn]] void fail_at(const SourcePlace& place, const std::string& what);

/// Runs `work`. What it throws as a SceneError becomes one of this place: "place: " + prefix + what it says.
template <class Work>
decltype(auto) at_place(const SourcePlace& place, const std::string& prefix, Work work) {
    try {
        return work();
    } catch (const SceneError& error) {
        throw SceneFileError(place, prefix + error.what());
    }
}

}  // namespace percale::scenes
