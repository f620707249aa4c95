#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

namespace percale {

/// The contact between two cloths, or of a cloth with itself, where both have self_contact.
struct ClothPair {
    bool contact = true;                   // whether they meet
    std::optional<double> thickness = {};  // m, activation distance; empty: the mean of their thicknesses

    bool operator==(const ClothPair&) const = default;
};

/// The settings of pairs of cloths, by the numbers of the cloths in either order, with ClothPair{} as the default; and the order
/// of layers.
class ClothPairs {
public:
    void set(int first, int second, const ClothPair& pair) {
        const auto place = said_.insert_or_assign(key(first, second), pair).first;
        if (pair == ClothPair{}) said_.erase(place);
    }
    ClothPair of(int first, int second) const {
        const auto found = said_.find(key(first, second));
        return found == said_.end() ? ClothPair{} : found->second;
    }
    /// The pairs that differ from ClothPair{}, the lower number first, in ascending order.
    const std::map<std::array<int, 2>, ClothPair>& said() const { return said_; }

    /// The layer in which a cloth is worn, 0 by default: of cloths that start through each other the one of the higher layer goes
    /// outside.
    void set_layer(int cloth, int layer) {
        layers_[cloth] = layer;
        if (layer == 0) layers_.erase(cloth);
    }
    int layer(int cloth) const {
        const auto found = layers_.find(cloth);
        return found == layers_.end() ? 0 : found->second;
    }
    /// The layers that are not 0.
    const std::map<int, int>& layers() const { return layers_; }

private:
    static std::array<int, 2> key(int first, int second) { return {std::min(first, second), std::max(first, second)}; }

    std::map<std::array<int, 2>, ClothPair> said_;
    std::map<int, int> layers_;
};

/// The cloth of each of a list of triangles, and the pairs of cloths. Without `cloth` all meet all.
struct MeetingCloth {
    std::span<const int> cloth = {};    // of each triangle
    const ClothPairs* pairs = nullptr;  // null: all pairs have the default

    bool meet(int first_triangle, int second_triangle) const {
        return cloth.empty() || pairs == nullptr || pairs->of(cloth[first_triangle], cloth[second_triangle]).contact;
    }
};

}  // namespace percale
