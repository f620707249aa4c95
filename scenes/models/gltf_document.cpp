#include "models/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>

#include "common/glb.h"
#include "common/input_file.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// How often parts of a glTF file may use its numbers in the mean, each of which takes a byte at least. Less: bodies of many
/// materials that share their vertices are refused. More: a small file fills the memory.
constexpr std::size_t max_number_copies = 4;

using GltfJson = nlohmann::json;

const GltfJson no_list = GltfJson::array();

template <class Number>
Number number_at(const std::byte* from) {
    Number number{};
    std::memcpy(&number, from, sizeof number);
    return number;
}

template <class Number>
double value_at(const std::byte* from, bool normalized) {
    const double value = static_cast<double>(number_at<Number>(from));
    if (!normalized || !std::is_integral_v<Number>) return value;
    return std::max(value / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
}

/// The bytes of a text in base64; nothing where it holds a letter that base64 does not have.
std::optional<std::vector<std::byte>> from_base64(std::string_view text) {
    std::vector<std::byte> bytes;
    unsigned bits = 0, have = 0;
    while (text.ends_with('=')) text.remove_suffix(1);
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (const char letter : text) {
        const std::size_t value = letters.find(letter);
        if (value == std::string_view::npos) return std::nullopt;
        bits = bits << 6 | static_cast<unsigned>(value);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes.push_back(static_cast<std::byte>(bits >> have & 0xff));
    }
    return bytes;
}

/// A URI with its escapes decoded: %20 is a space.
std::string decoded(const std::string& uri) {
    std::string text;
    const auto digit = [](char letter) {
        const std::size_t value = std::string_view("0123456789abcdef").find(static_cast<char>(letter | 0x20));
        return letter >= '0' && letter <= '9' ? letter - '0' : value == std::string_view::npos ? -1 : static_cast<int>(value);
    };
    for (std::size_t k = 0; k < uri.size(); ++k) {
        const bool coded = uri[k] == '%' && k + 2 < uri.size() && digit(uri[k + 1]) >= 0 && digit(uri[k + 2]) >= 0;
        text += coded ? static_cast<char>(16 * digit(uri[k + 1]) + digit(uri[k + 2])) : uri[k];
        if (coded) k += 2;
    }
    return text;
}

std::size_t component_bytes(int component) {
    switch (component) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

double component_at(const std::byte* from, int component, bool normalized) {
    switch (component) {
        case 5120:
            return value_at<std::int8_t>(from, normalized);
        case 5121:
            return value_at<std::uint8_t>(from, normalized);
        case 5122:
            return value_at<std::int16_t>(from, normalized);
        case 5123:
            return value_at<std::uint16_t>(from, normalized);
        case 5125:
            return value_at<std::uint32_t>(from, normalized);
        default:
            return value_at<float>(from, normalized);
    }
}

std::size_t components_of(const std::string& type) {
    const std::array<std::pair<const char*, std::size_t>, 5> types = {
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};
    for (const auto& [name, count] : types)
        if (type == name) return count;
    return 0;
}

}  // namespace

std::size_t GltfDocument::Layout::bytes() const { return components * component_bytes(component); }

void GltfDocument::refuse(const std::string& fault) const { throw SceneError(file_, fault); }

GltfDocument::GltfDocument(const std::string& file) : file_(file) {
    const std::vector<std::byte> bytes = read_bytes(file);
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0)
        read_glb(bytes);
    else
        read_document(bytes);
}

void GltfDocument::read_document(const std::vector<std::byte>& bytes) {
    const char* text = reinterpret_cast<const char*>(bytes.data());
    json_ = GltfJson::parse(text + encoding_mark({text, bytes.size()}, file_), text + bytes.size());
    read_buffers({});
}

void GltfDocument::read_glb(const std::vector<std::byte>& bytes) {
    if (bytes.size() < 20) refuse("ends within its header");
    const auto word = [&](std::size_t at) { return std::size_t{number_at<std::uint32_t>(bytes.data() + at)}; };
    if (word(4) != 2) refuse("is GLB of version " + std::to_string(word(4)) + ", read is 2");
    if (word(8) > bytes.size())
        refuse("is cut off: " + std::to_string(bytes.size()) + " of " + std::to_string(word(8)) + " bytes");
    const std::size_t text = word(12);
    if (word(16) != glb_json_chunk) refuse("its first chunk is no JSON");
    if (text > bytes.size() - 20)
        refuse("its JSON claims " + std::to_string(text) + " bytes, the file has " + std::to_string(bytes.size()));
    const char* first = reinterpret_cast<const char*>(bytes.data()) + 20;
    json_ = GltfJson::parse(first, first + text);
    std::optional<std::vector<std::byte>> binary;
    const std::size_t next = 20 + (text + 3) / 4 * 4;
    if (next + 8 <= bytes.size() && word(next + 4) == glb_binary_chunk) {
        const std::size_t length = word(next);
        if (length > bytes.size() - next - 8)
            refuse("its buffer claims " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size()));
        binary.emplace(bytes.begin() + static_cast<std::ptrdiff_t>(next + 8),
                       bytes.begin() + static_cast<std::ptrdiff_t>(next + 8 + length));
    }
    read_buffers(std::move(binary));
}

void GltfDocument::check_extensions() const {
    for (const GltfJson& name : list("extensionsRequired")) {
        const std::string extension = name.get<std::string>();
        for (const char* unread :
             {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression", "EXT_mesh_gpu_instancing"})
            if (extension == unread) refuse("needs the extension " + extension + ", which is not read; export it without");
    }
}

void GltfDocument::read_buffers(std::optional<std::vector<std::byte>> binary) {
    check_extensions();  // the buffers of some extensions are no buffers
    const std::size_t count = list("buffers").size();
    for (std::size_t k = 0; k < count; ++k) {
        const GltfJson& buffer = at("buffers", k);
        const std::size_t length = required(buffer, "byteLength", GltfDocument::any);
        if (!buffer.contains("uri") && (k > 0 || !binary)) refuse("buffer " + std::to_string(k) + " has no uri");
        buffers_.push_back(buffer.contains("uri") ? buffer_at(buffer.at("uri").get<std::string>()) : std::move(*binary));
        if (buffers_.back().size() < length)
            refuse("buffer " + std::to_string(k) + " has " + std::to_string(buffers_.back().size()) + " bytes, not " +
                   std::to_string(length));
        bytes_ += buffers_.back().size();
    }
}

std::vector<std::byte> GltfDocument::buffer_at(const std::string& uri) const {
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(";base64,");
        if (comma == std::string::npos) refuse("a buffer's data is not base64");
        std::optional<std::vector<std::byte>> bytes = from_base64(std::string_view(uri).substr(comma + 8));
        if (!bytes) refuse("a buffer's data is not base64");
        return std::move(*bytes);
    }
    const std::filesystem::path beside = std::filesystem::path(file_).parent_path() / decoded(uri);
    std::error_code error;
    if (!std::filesystem::is_regular_file(beside, error)) refuse("its buffer " + beside.string() + " is no file");
    return read_bytes(beside.string());
}

const GltfJson& GltfDocument::list(const char* name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) return no_list;
    if (!found->is_array()) refuse(std::string(name) + " is no list");
    return *found;
}

const GltfJson& GltfDocument::at(const char* name, std::size_t number) const {
    const GltfJson& all = list(name);
    if (number >= all.size())
        refuse(std::string(name) + ": " + std::to_string(number) + " is out of range 0 ... " +
               std::to_string(static_cast<long>(all.size()) - 1));
    return all[number];
}

std::optional<std::size_t> GltfDocument::number(const GltfJson& object, const char* key, std::size_t count) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    // Some writers write 3.0.
    const bool whole = found->is_number_unsigned() ||
                       (found->is_number_float() && found->get<double>() >= 0.0 && found->get<double>() < 9e15 &&
                        found->get<double>() == static_cast<double>(static_cast<std::uint64_t>(found->get<double>())));
    if (!whole) refuse(std::string(key) + " is " + found->dump() + ", no whole number");
    const std::size_t value = found->get<std::size_t>();
    if (value >= count)
        refuse(std::string(key) + " " + std::to_string(value) + " is out of range 0 ... " +
               std::to_string(static_cast<long>(count) - 1));
    return value;
}

std::size_t GltfDocument::required(const GltfJson& object, const char* key, std::size_t count) const {
    const std::optional<std::size_t> found = number(object, key, count);
    if (!found) refuse(std::string(key) + " is missing");
    return *found;
}

GltfDocument::View GltfDocument::view_of(std::size_t number_of_view) const {
    const GltfJson& from = at("bufferViews", number_of_view);
    View view;
    view.buffer = required(from, "buffer", buffers_.size());
    view.offset = number(from, "byteOffset", GltfDocument::any).value_or(0);
    view.length = required(from, "byteLength", GltfDocument::any);
    view.stride = number(from, "byteStride", 253).value_or(0);
    const std::size_t there = buffers_[view.buffer].size();
    if (view.offset > there || view.length > there - view.offset)
        refuse("buffer view " + std::to_string(number_of_view) + " is outside of its buffer of " + std::to_string(there) +
               " bytes");
    return view;
}

GltfDocument::Layout GltfDocument::layout_of(const GltfJson& accessor) const {
    Layout layout;
    layout.component = static_cast<int>(required(accessor, "componentType", 65536));
    layout.components = components_of(accessor.at("type").get<std::string>());
    layout.normalized = accessor.value("normalized", false);
    if (layout.bytes() == 0)
        refuse("an accessor is of type " + accessor.at("type").dump() + " of " + std::to_string(layout.component) +
               ", which is not read");
    return layout;
}

void GltfDocument::read_elements(const View& view, std::size_t from, const Layout& layout, std::size_t count, double* to) const {
    const std::size_t size = layout.bytes(), stride = std::max(size, view.stride);
    const bool fits =
        count == 0 || (from <= view.length && size <= view.length - from && count - 1 <= (view.length - from - size) / stride);
    if (!fits) refuse("an accessor of " + std::to_string(count) + " elements is outside of its buffer view");
    const std::byte* element = buffers_[view.buffer].data() + view.offset + from;
    const std::size_t step = component_bytes(layout.component);
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t c = 0; c < layout.components; ++c)
            *to++ = component_at(element + k * stride + c * step, layout.component, layout.normalized);
}

void GltfDocument::read_sparse(const GltfJson& sparse, const Layout& layout, std::size_t count,
                               std::vector<double>& numbers) const {
    const std::size_t changed = required(sparse, "count", count + 1);
    const GltfJson &indices = sparse.at("indices"), &values = sparse.at("values");
    std::vector<double> places(changed), elements(changed * layout.components);
    const Layout of_index{
        .component = static_cast<int>(required(indices, "componentType", 65536)), .components = 1, .normalized = false};
    if (of_index.bytes() == 0 || of_index.component == 5126) refuse("sparse indices are of another type");
    View view = view_of(required(indices, "bufferView", GltfDocument::any));
    view.stride = 0;
    read_elements(view, number(indices, "byteOffset", GltfDocument::any).value_or(0), of_index, changed, places.data());
    view = view_of(required(values, "bufferView", GltfDocument::any));
    view.stride = 0;
    read_elements(view, number(values, "byteOffset", GltfDocument::any).value_or(0), layout, changed, elements.data());
    for (std::size_t k = 0; k < changed; ++k) {
        if (!(places[k] >= 0.0 && places[k] < static_cast<double>(count))) refuse("a sparse index is out of range");
        const auto at = static_cast<std::size_t>(places[k]) * layout.components;
        std::copy_n(elements.begin() + static_cast<std::ptrdiff_t>(k * layout.components), layout.components,
                    numbers.begin() + static_cast<std::ptrdiff_t>(at));
    }
}

std::vector<double> GltfDocument::numbers(std::size_t number_of_accessor, std::size_t components) const {
    const GltfJson& accessor = at("accessors", number_of_accessor);
    const Layout layout = layout_of(accessor);
    if (layout.components != components)
        refuse("accessor " + std::to_string(number_of_accessor) + " has " + std::to_string(layout.components) +
               " numbers an element, not " + std::to_string(components));
    const std::size_t count = required(accessor, "count", GltfDocument::any);
    // Without a view it is of zeros, which take no bytes of the file.
    if (count > std::max(bytes_, always_allowed_vertices))
        refuse("accessor " + std::to_string(number_of_accessor) + " claims " + std::to_string(count) +
               " elements, more than its buffers hold");
    query_boxes_ += count * components;
    if (query_boxes_ > std::max(max_part_copies * always_allowed_vertices, max_number_copies * bytes_))
        refuse("its parts use the same numbers over and over, " + std::to_string(query_boxes_) + " in all; give each its own");
    std::vector<double> numbers(count * components);
    if (const auto view = number(accessor, "bufferView", GltfDocument::any))
        read_elements(view_of(*view), number(accessor, "byteOffset", GltfDocument::any).value_or(0), layout, count,
                      numbers.data());
    if (accessor.contains("sparse")) read_sparse(accessor.at("sparse"), layout, count, numbers);
    return numbers;
}

}  // namespace percale::scenes
