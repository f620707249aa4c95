#include "frames/frame_folder.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "percale/error.h"

namespace percale::scenes {

namespace fs = std::filesystem;

void FrameFolder::need_folder_of(const std::string& name) {
    const std::string parent = fs::path(name).parent_path().string();
    folders_.try_emplace(parent, path(parent));
}

void FrameFolder::write(const std::string& name, const std::function<void(const std::string&)>& write_to) {
    need_folder_of(name);
    write_to(path(name));
    written_.push_back(path(name));
}

std::ostream& FrameFolder::grown(const std::string& name) {
    need_folder_of(name);
    Growing& growing = growing_.try_emplace(name, path(name)).first->second;
    errno = 0;  // so that it says why writing this file fails
    return growing.file.out();
}

void FrameFolder::check() {
    for (auto& [name, growing] : growing_) growing.file.check();
}

std::string FrameFolder::scratch(const std::string& name) {
    Growing& growing = growing_.at(name);
    growing.file.out().flush();
    growing.file.check();
    growing.scratch = true;
    return path(name) + part_suffix;
}

void FrameFolder::copy(const std::string& other, const std::string& name) {
    const std::string from = other + "/" + name, to = path(name), part = to + part_suffix;
    need_folder_of(name);
    std::error_code error;
    fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
    if (!error) fs::rename(part, to, error);
    if (error) throw SceneError(from + ": cannot be copied to " + to + ": " + error.message());
    written_.push_back(to);
}

void FrameFolder::go_on(const std::string& other, const GrownFile& file, bool keep) {
    need_folder_of(file.name);
    const std::string source = whole_or_part(other + "/" + file.name);
    growing_.try_emplace(file.name, path(file.name), source, file.bytes).first->second.kept = keep;
    std::error_code error;
    fs::remove(path(file.name), error);
    if (error) throw SceneError(path(file.name) + ": cannot be replaced: " + error.message());
}

std::vector<GrownFile> FrameFolder::sync() {
    std::vector<GrownFile> files;
    for (auto& [name, growing] : growing_) files.push_back({name, growing.file.sync()});
    return files;
}

void FrameFolder::keep() {
    written_.clear();
    for (auto& [name, growing] : growing_) growing.kept = true;
}

void FrameFolder::discard() {
    for (const std::string& file : written_) std::remove(file.c_str());
    written_.clear();
    for (auto& [name, growing] : growing_) {
        if (growing.kept)
            growing.file.leave();
        else if (growing.whole)
            std::remove(path(name).c_str());
    }
}

void FrameFolder::finish() {
    check();
    for (auto& [name, growing] : growing_) {
        if (growing.scratch && growing.kept) growing.file.leave();
        if (growing.scratch) continue;
        growing.file.commit();
        growing.whole = true;
    }
    std::erase_if(growing_, [](const auto& entry) { return entry.second.scratch; });
}

}  // namespace percale::scenes
