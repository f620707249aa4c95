#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

namespace percale {

/// What a cloth is to another, or to itself, where both have self_contact.
struct ClothPair {
    bool contact = true;                   // whether they meet
    std::optional<double> thickness = {};  // m, below it they are in contact; without, the mean of their thicknesses

    bool operator==(const ClothPair&) const = default;
};

/// What is said of pairs of cloths, by the numbers of the cloths, in either order; of all others ClothPair{} holds. And the order
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
    /// Only what differs from ClothPair{}, the lower number first, in ascending order.
    const std::map<std::array<int, 2>, ClothPair>& said() const { return said_; }

    /// How far out a cloth is worn, 0 where nothing is said: of cloths that start through each other the one of the higher layer
    /// goes outside.
    void set_layer(int cloth, int layer) {
        layers_[cloth] = layer;
        if (layer == 0) layers_.erase(cloth);
    }
    int layer(int cloth) const {
        const auto found = layers_.find(cloth);
        return found == layers_.end() ? 0 : found->second;
    }
    /// Only those that are not 0.
    const std::map<int, int>& layers() const { return layers_; }

private:
    static std::array<int, 2> key(int first, int second) { return {std::min(first, second), std::max(first, second)}; }

    std::map<std::array<int, 2>, ClothPair> said_;
    std::map<int, int> layers_;
};

/// Which cloth each of a list of triangles belongs to, and what cloths are to each other. Without `cloth` all meet all.
struct MeetingCloth {
    std::span<const int> cloth = {};    // of each triangle
    const ClothPairs* pairs = nullptr;  // null: nothing is said

    bool meet(int first_triangle, int second_triangle) const {
        return cloth.empty() || pairs == nullptr || pairs->of(cloth[first_triangle], cloth[second_triangle]).contact;
    }
};

}  // namespace percale
