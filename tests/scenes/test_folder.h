#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace percale::scenes::test {

/// An empty folder for one test, removed with everything in it. Its name holds a space: users' folders do.
class TestFolder {
public:
    TestFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "percale test XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder can be made");
        path_ = name;
    }
    ~TestFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

    std::string read(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        if (!in) throw std::runtime_error(path(name) + " is missing");
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }

    bool holds(const std::string& name) const { return std::filesystem::exists(path(name)); }

    /// How many files there are, folders below included.
    int file_count() const {
        int count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) count += entry.is_regular_file() ? 1 : 0;
        return count;
    }

private:
    std::string path_;
};

}  // namespace percale::scenes::test
