#include "percale/saved_state.h"

#include <algorithm>
#include <cmath>

#include "percale/error.h"
#include "support/hash.h"
#include "tolerances.h"

namespace percale {
namespace {

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
    Hash hash;
    hash.add(static_cast<std::uint64_t>(content.size()));
    for (std::size_t at = 0; at < content.size(); at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, content.data() + at, std::min(sizeof word, content.size() - at));
        hash.add(word);
    }
    return hash.value();
}

void StateReader::refuse(const char* fault) const {
    throw SceneError("saved state: " + std::string(fault) + " (byte " + std::to_string(at_) + " of " +
                     std::to_string(bytes_.size()) + ")");
}

std::vector<std::byte> sealed(const SealKind& kind, std::span<const std::byte> content) {
    StateWriter writer;
    writer(Seal{letters(kind.name), kind.version, content.size(), checksum(content)});
    std::vector<std::byte> bytes = writer.take();
    bytes.insert(bytes.end(), content.begin(), content.end());
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
