#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "c/call.h"
#include "percale/mesh.h"

// Conversions from the types of C to those of C++ and back.
namespace percale::c_interface {

// Views hand out Vec3 and Triangle as plain numbers in a row.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double));
static_assert(sizeof(Triangle) == 3 * sizeof(int));

/// A struct with the default of each field, its struct_size included.
template <class Struct>
Struct default_struct();
template <>
percale_setup default_struct();
template <>
percale_workers default_struct();
template <>
percale_cloth_settings default_struct();
template <>
percale_obstacle_settings default_struct();
template <>
percale_seam_settings default_struct();
template <>
percale_scripted_changes default_struct();
template <>
percale_energy default_struct();
template <>
percale_step_report default_struct();
template <>
percale_start_fault default_struct();
template <>
percale_certificate default_struct();
template <>
percale_option default_struct();

/// `struct_size` as the caller has compiled the struct.
template <class Struct>
void check_struct_size(std::size_t struct_size) {
    if (struct_size == sizeof(Struct)) return;
    throw SceneError("struct_size", std::to_string(struct_size) + " bytes, this version of the library knows " +
                                        std::to_string(sizeof(Struct)) + "; percale_init_... sets it");
}

/// A struct of the caller, its size checked.
template <class Struct>
Struct& known(Struct* given, const char* name) {
    check_struct_size<std::remove_const_t<Struct>>(demanded(given, name).struct_size);
    return *given;
}

/// The same for settings that may be left out.
template <class Struct>
Struct known_or_default(const Struct* given, const char* name) {
    return given == nullptr ? default_struct<Struct>() : known(given, name);
}

template <class Struct>
percale_status init_struct(const char* function, Struct* given, std::size_t struct_size) noexcept {
    return call(function, [&] {
        check_struct_size<Struct>(struct_size);
        demanded(given, "the struct") = default_struct<Struct>();
    });
}

inline Vec3 vector_of(const double* numbers, const char* name) {
    const double* xyz = &demanded(numbers, name);
    return Vec3(xyz[0], xyz[1], xyz[2]);
}

inline void write_vector(const Vec3& vector, double* numbers) { std::copy_n(vector.data(), 3, numbers); }

/// Throws SceneError for more items than an int counts.
int counted_items(std::size_t count, const char* name);

/// Throws SceneError for NULL unless there are none.
template <class Item>
std::span<const Item> items_of(const Item* items, std::size_t count, const char* name) {
    if (count > 0) static_cast<void>(demanded(items, name));
    return {items, static_cast<std::size_t>(counted_items(count, name))};
}

std::vector<Vec3> vectors_of(const double* numbers, std::size_t count, const char* name);

Pose pose_of(const percale_pose& pose);
percale_pose c_pose(const Pose& pose);

/// A buffer of the caller: the number of items goes to *count; NULL without capacity requests that alone.
template <class Item>
struct Buffer {
    Item* items;
    std::size_t capacity;  // in items
    std::size_t* count;

    /// Calls write(items) where there is room for `needed`. Throws SceneError for NULL, CallError where there is not.
    template <class Write>
    void fill(std::size_t needed, Write write) const {
        const bool asks = items == nullptr && capacity == 0;
        if (asks) static_cast<void>(demanded(count, "count, where there is no buffer,"));
        if (count != nullptr) *count = needed;
        if (asks) return;
        static_cast<void>(demanded(items, "the buffer"));
        if (capacity < needed) {
            throw CallError(PERCALE_BUFFER_TOO_SMALL,
                            "room for " + std::to_string(capacity) + " items, there are " + std::to_string(needed));
        }
        write(items);
    }
};

void give_vectors(std::span<const Vec3> vectors, const Buffer<double>& buffer);
void give_text(const std::string& text, const Buffer<char>& buffer);
template <class Item>
void give_items(std::span<const Item> values, const Buffer<Item>& buffer) {
    buffer.fill(values.size(), [&](Item* to) { std::ranges::copy(values, to); });
}

}  // namespace percale::c_interface
