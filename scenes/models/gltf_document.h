#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace percale::scenes {

/// A glTF 2.0 file, as text beside its buffers or as GLB (Khronos, glTF 2.0 Specification, 2021): its document, and numbers out
/// of its buffers. Whatever throws, throws SceneError naming the file, or json::exception where a value is of another type.
class GltfDocument {
public:
    /// A bound above any number of a file.
    static constexpr std::size_t any = std::size_t{1} << 53;

    explicit GltfDocument(const std::string& file);

    const nlohmann::json& root() const { return json_; }

    /// A list of the document: "nodes"; empty where it has none.
    const nlohmann::json& list(const char* name) const;
    /// An element of that list.
    const nlohmann::json& at(const char* name, std::size_t number) const;
    /// A whole number that an object has, below `count`; nothing where it has none.
    std::optional<std::size_t> number(const nlohmann::json& object, const char* key, std::size_t count) const;
    /// The same for a key that has to be there.
    std::size_t required(const nlohmann::json& object, const char* key, std::size_t count) const;

    /// Numbers of an accessor, element by element: `components` each; integers as they are, or, where they are normalized, as
    /// fractions of the largest one (3.11 of the specification). Refuses where all that was asked for comes to far more than the
    /// buffers hold: a small file may name one accessor without end.
    std::vector<double> numbers(std::size_t accessor, std::size_t components) const;

    /// The size of all its buffers, bytes.
    std::size_t buffer_bytes() const { return bytes_; }

    [[noreturn]] void refuse(const std::string& fault) const;

private:
    struct View {
        std::size_t buffer = 0, offset = 0, length = 0, stride = 0;
    };
    /// How the elements of an accessor lie.
    struct Layout {
        int component = 0;           // its number in the specification
        std::size_t components = 0;  // of an element
        bool normalized = false;
        std::size_t bytes() const;  // of an element
    };

    void read_document(const std::vector<std::byte>& bytes);
    void read_glb(const std::vector<std::byte>& bytes);
    /// Refuses extensions that hide vertices or place meshes; others only change the appearance.
    void check_extensions() const;
    void read_buffers(std::optional<std::vector<std::byte>> binary);
    std::vector<std::byte> buffer_at(const std::string& uri) const;
    View view_of(std::size_t number) const;
    Layout layout_of(const nlohmann::json& accessor) const;
    /// `count` elements of a view from a byte on.
    void read_elements(const View& view, std::size_t from, const Layout& layout, std::size_t count, double* to) const;
    void read_sparse(const nlohmann::json& sparse, const Layout& layout, std::size_t count, std::vector<double>& numbers) const;

    std::string file_;
    nlohmann::json json_;
    std::vector<std::vector<std::byte>> buffers_;
    std::size_t bytes_ = 0;                // of all buffers
    mutable std::size_t query_boxes_ = 0;  // numbers, in all calls of `numbers`
};

}  // namespace percale::scenes
