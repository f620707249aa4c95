#include "percale/saved_state.h"

#include <algorithm>
#include <cmath>

#include "percale/error.h"
#include "support/hash.h"

namespace percale {
namespace {

/// |q|^2 - 1 of a rotation in a saved state, which was made of unit length before. Smaller: rounding gets a good state refused.
/// Larger: a quaternion that was never meant to be a rotation is accepted.
constexpr double unit_square_error = 1e-6;

constexpr std::size_t name_length = 8;

struct Seal {
    std::array<char, name_length> name{};
    std::uint32_t version = 0;
    std::uint64_t length = 0, checksum = 0;
};

template <class Archive, OfType<Seal> Value>
void exchange(Archive& archive, Value& seal) {
    archive(seal.name, seal.version, seal.length, seal.checksum);
}

constexpr std::size_t seal_length = name_length + sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);

std::array<char, name_length> letters(std::string_view name) {
    std::array<char, name_length> result{};
    std::copy_n(name.begin(), std::min(name.size(), name_length), result.begin());
    return result;
}

/// Writes the seal over the first seal_length bytes.
void put_seal(const SealKind& kind, std::span<std::byte> bytes) {
    const std::span<const std::byte> content = bytes.subspan(seal_length);
    StateWriter writer;
    writer(Seal{letters(kind.name), kind.version, content.size(), checksum(content)});
    std::ranges::copy(writer.take(), bytes.begin());
}

[[noreturn]] void refuse_seal(const SealKind& kind, const std::string& fault) {
    throw SceneError(std::string(kind.words) + ": " + fault);
}

}  // namespace

bool is_proper(const Pose& pose) {
    const Rotation& q = pose.rotation;
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    return pose.translation.allFinite() && std::abs(square - 1.0) <= unit_square_error && pose.scale > 0.0 &&
           std::isfinite(pose.scale);
}

std::uint64_t checksum(std::span<const std::byte> content) {
    constexpr std::size_t word_length = sizeof(std::uint64_t), lanes = 4;
    // Each word waits for the previous one in its lane only.
    std::array<Hash, lanes> lane;
    const auto add = [&](Hash& hash, std::size_t at, std::size_t count) {
        std::uint64_t word = 0;
        std::memcpy(&word, content.data() + at, count);
        hash.add(word);
    };
    std::size_t at = 0;
    for (; at + lanes * word_length <= content.size(); at += lanes * word_length) {
        for (std::size_t k = 0; k < lanes; ++k) add(lane[k], at + k * word_length, word_length);
    }
    Hash hash;
    hash.add(static_cast<std::uint64_t>(content.size()));
    for (; at < content.size(); at += word_length) add(hash, at, std::min(word_length, content.size() - at));
    for (const Hash& each : lane) hash.add(each.value());
    return hash.value();
}

void StateReader::refuse(const char* fault) const {
    throw SceneError("saved state: " + std::string(fault) + " (byte " + std::to_string(at_) + " of " +
                     std::to_string(bytes_.size()) + ")");
}

std::vector<std::byte> sealed(const SealKind& kind, std::span<const std::byte> content) {
    std::vector<std::byte> bytes(seal_length + content.size());
    std::ranges::copy(content, bytes.begin() + seal_length);
    put_seal(kind, bytes);
    return bytes;
}

StateWriter begin_sealed(std::size_t expected) {
    StateWriter writer(expected);
    writer(Seal{});
    return writer;
}

std::vector<std::byte> end_sealed(const SealKind& kind, StateWriter& writer) {
    std::vector<std::byte> bytes = writer.take();
    put_seal(kind, bytes);
    return bytes;
}

std::span<const std::byte> unsealed(const SealKind& kind, std::span<const std::byte> bytes) {
    const std::string other = "it is none: it does not begin like one";
    if (bytes.size() < seal_length) refuse_seal(kind, bytes.empty() ? "it is empty" : other);
    Seal seal;
    StateReader reader(bytes);
    reader(seal);
    if (seal.name != letters(kind.name)) refuse_seal(kind, other);
    if (seal.version != kind.version) {
        refuse_seal(kind, "it is of version " + std::to_string(seal.version) + ", this build reads version " +
                              std::to_string(kind.version));
    }
    const std::span<const std::byte> content = bytes.subspan(seal_length);
    if (content.size() != seal.length) {
        refuse_seal(kind, "it is cut off or not all of it: " + std::to_string(content.size()) + " of " +
                              std::to_string(seal.length) + " bytes");
    }
    if (checksum(content) != seal.checksum) refuse_seal(kind, "it is damaged: its checksum is wrong");
    return content;
}

}  // namespace percale
