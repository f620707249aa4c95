#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Whether lists of a type are written in their memory layout: numbers, and structs without gaps for which every bit pattern is
/// valid. `exchange` of such a struct names all its fields in their order, so that a single value makes the same bytes.
template <class Value>
inline constexpr bool is_plain_state = std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>;
template <>
inline constexpr bool is_plain_state<std::byte> = true;
template <>
inline constexpr bool is_plain_state<Vec3> = sizeof(Vec3) == 3 * sizeof(double);
template <class Value, std::size_t count>
inline constexpr bool is_plain_state<std::array<Value, count>> = is_plain_state<Value>;

/// Writes the values of a state, one after the other and every bit of them: numbers, Vec3, text, and arrays, lists and optionals
/// of these. A struct is written by `exchange(archive, value)`, a function beside it that names its fields once, for StateWriter
/// and StateReader alike.
class StateWriter {
public:
    static constexpr bool reads = false;

    /// `expected`: number of bytes for which memory is reserved.
    explicit StateWriter(std::size_t expected = 4096) : bytes_(std::max(expected, std::size_t{64})) {}

    template <class... Values>
    void operator()(const Values&... values) {
        (put(values), ...);
    }
    /// An enumerator; the reader refuses all but the first `count`.
    template <class Enum>
    void choice(const Enum& value, int count) {
        static_cast<void>(count);
        put(static_cast<std::int32_t>(value));
    }
    std::vector<std::byte> take() {
        bytes_.resize(used_);
        used_ = 0;
        return std::move(bytes_);
    }

private:
    template <class Value>
    void put(const Value& value) {
        if constexpr (std::is_arithmetic_v<Value>) {
            put_raw(&value, sizeof value);
        } else {
            exchange(*this, value);
        }
    }
    void put(bool value) { put(static_cast<std::uint8_t>(value)); }
    void put(const Vec3& value) { (*this)(value.x(), value.y(), value.z()); }
    void put(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        put_raw(text.data(), text.size());
    }
    template <class Value>
    void put(const std::optional<Value>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <class Value, std::size_t count>
    void put(const std::array<Value, count>& values) {
        for (const Value& value : values) put(value);
    }
    template <class Value, class Allocator>
    void put(const std::vector<Value, Allocator>& values) {
        put(static_cast<std::uint64_t>(values.size()));
        if constexpr (is_plain_state<Value>) {
            put_raw(values.data(), values.size() * sizeof(Value));
        } else {
            for (const Value& value : values) put(value);
        }
    }
    void put_raw(const void* from, std::size_t count) {
        if (bytes_.size() - used_ < count) bytes_.resize(std::max(2 * bytes_.size(), used_ + count));
        if (count > 0) std::memcpy(bytes_.data() + used_, from, count);
        used_ += count;
    }

    std::vector<std::byte> bytes_;
    std::size_t used_ = 0;  // of them
};

/// Reads the values of a StateWriter, in the same order. Throws SceneError where the bytes end too early or hold values that no
/// writer writes; never takes more memory than a few times that of the bytes.
class StateReader {
public:
    static constexpr bool reads = true;

    /// The bytes must outlive the reader.
    explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class... Values>
    void operator()(Values&... values) {
        (get(values), ...);
    }
    template <class Enum>
    void choice(Enum& value, int count) {
        std::int32_t number = 0;
        get(number);
        demand(number >= 0 && number < count, "no such choice");
        value = static_cast<Enum>(number);
    }
    bool at_end() const { return at_ == bytes_.size(); }
    /// Throws SceneError, with the place in the bytes, unless `good`.
    void demand(bool good, const char* fault) const {
        if (!good) refuse(fault);
    }

private:
    template <class Value>
    void get(Value& value) {
        if constexpr (std::is_arithmetic_v<Value>) {
            get_raw(&value, sizeof value);
        } else {
            exchange(*this, value);
        }
    }
    void get(bool& value) {
        std::uint8_t byte = 0;
        get(byte);
        demand(byte <= 1, "neither true nor false");
        value = byte == 1;
    }
    void get(Vec3& value) { (*this)(value.x(), value.y(), value.z()); }
    void get(std::string& text) {
        text.resize(count_of(1));
        get_raw(text.data(), text.size());
    }
    template <class Value>
    void get(std::optional<Value>& value) {
        bool there = false;
        get(there);
        value.reset();
        if (there) get(value.emplace());
    }
    template <class Value, std::size_t count>
    void get(std::array<Value, count>& values) {
        for (Value& value : values) get(value);
    }
    template <class Value, class Allocator>
    void get(std::vector<Value, Allocator>& values) {
        values.clear();
        if constexpr (is_plain_state<Value>) {
            values.resize(count_of(sizeof(Value)));
            get_raw(values.data(), values.size() * sizeof(Value));
        } else {
            std::size_t left = count_of(1);
            values.reserve(std::min(left, (bytes_.size() - at_) / sizeof(Value)));  // no more memory than bytes are left
            for (; left > 0; --left) get(values.emplace_back());
        }
    }
    /// A count of values that take at least `bytes` each.
    std::size_t count_of(std::size_t bytes) {
        std::uint64_t count = 0;
        get(count);
        demand(count <= (bytes_.size() - at_) / bytes, "it ends too early");
        return static_cast<std::size_t>(count);
    }
    void get_raw(void* to, std::size_t count) {
        demand(count <= bytes_.size() - at_, "it ends too early");
        if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
        at_ += count;
    }
    [[noreturn]] void refuse(const char* fault) const;

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

/// For `exchange`: a value of this type, constant where it is written.
template <class Value, class Type>
concept OfType = std::is_same_v<std::remove_const_t<Value>, Type>;

template <class Archive, OfType<Rotation> Value>
void exchange(Archive& archive, Value& rotation) {
    archive(rotation.w, rotation.x, rotation.y, rotation.z);
}
/// Whether a pose is finite, its rotation of length 1 and its scale above 0.
bool is_proper(const Pose& pose);

/// Refuses improper poses.
template <class Archive, OfType<Pose> Value>
void exchange(Archive& archive, Value& pose) {
    archive(pose.translation, pose.rotation, pose.scale);
    if constexpr (Archive::reads) archive.demand(is_proper(pose), "a pose that is none");
}

/// A hash of bytes.
std::uint64_t checksum(std::span<const std::byte> bytes);

/// The header of sealed bytes.
struct SealKind {
    std::string_view name;      // eight letters
    std::uint32_t version = 0;  // of the content
    std::string_view words;     // for messages: "saved state"
};

/// The content with kind, length and checksum in front.
std::vector<std::byte> sealed(const SealKind& kind, std::span<const std::byte> content);

/// The same without a copy: a writer with room for the seal, which is written when the content is complete.
StateWriter begin_sealed(std::size_t expected = 4096);
std::vector<std::byte> end_sealed(const SealKind& kind, StateWriter& writer);

/// The content again, a part of `bytes`. Throws SceneError where they are not of that kind and version, cut off or damaged.
std::span<const std::byte> unsealed(const SealKind& kind, std::span<const std::byte> bytes);

}  // namespace percale
