// SPDX-License-Identifier: MIT
#include "scene/packed/draco.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "image/codec/load_module.hpp"
#include "scene/packed/draco_module.hpp"

namespace darkroom::scene {
namespace {

// Google, "Draco Bitstream Specification", 2.2.
constexpr std::size_t head_size = 11;
constexpr std::byte version_major{2}, version_minor{2};
constexpr std::byte is_mesh{1}, sequential{0}, edgebreaker{1};
constexpr std::byte has_metadata{0x80};  // of the second byte of the flags

// The faces, and two corner tables of three corners each; an attribute with seams has a third and a fourth.
constexpr std::uint64_t connection_bytes = 12 + 2 * 24, seam_bytes = 2 * 24;

class HeadReader {
  public:
    explicit HeadReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    [[nodiscard]] std::optional<std::byte> byte() {
        if (rest_.empty()) return std::nullopt;
        const std::byte first = rest_.front();
        rest_ = rest_.subspan(1);
        return first;
    }
    /// Seven bits a byte, the lowest first.
    [[nodiscard]] std::optional<std::uint64_t> number() {
        std::uint64_t out = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const auto next = byte();
            if (!next) return std::nullopt;
            out |= std::to_integer<std::uint64_t>(*next & std::byte{0x7f}) << shift;
            if ((*next & std::byte{0x80}) == std::byte{}) return out;
        }
        return std::nullopt;
    }

  private:
    std::span<const std::byte> rest_;
};

}  // namespace

Result<DracoHead> read_draco_head(std::span<const std::byte> bytes) {
    constexpr std::string_view name = "DRACO";
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (bytes.size() < head_size || !text.starts_with(name)) return user_error("is not a Draco mesh");
    if (bytes[5] != version_major || bytes[6] != version_minor)
        return user_error(fmt::format("is of version {}.{}, 2.2 is read", std::to_integer<int>(bytes[5]),
                                      std::to_integer<int>(bytes[6])));
    if (bytes[7] != is_mesh || (bytes[8] != sequential && bytes[8] != edgebreaker))
        return user_error("has no triangles, or packs them by a method that is not known");
    if ((bytes[10] & has_metadata) != std::byte{}) return user_error("has metadata, which is not read");
    HeadReader reader(bytes.subspan(head_size));
    DracoHead head{.has_all_vertices = bytes[8] == sequential, .bytes_per_triangle = connection_bytes};
    const auto cut = [] { return user_error("is cut off in its head"); };
    std::optional<std::uint64_t> vertices, triangles;
    if (head.has_all_vertices) {
        triangles = reader.number();
        vertices = reader.number();
    } else {
        static_cast<void>(reader.byte());  // how the triangles are gone through
        vertices = reader.number();
        triangles = reader.number();
        const auto seams = reader.byte();
        if (!seams) return cut();
        head.bytes_per_triangle += seam_bytes * std::to_integer<std::uint64_t>(*seams);
    }
    if (!vertices || !triangles) return cut();
    head.vertices = *vertices;
    head.triangles = *triangles;
    return head;
}

Result<> unpack_draco(std::span<const std::byte> bytes, std::uint64_t vertices, const AdmitVertices& admit,
                      std::span<DracoAttribute> attributes, std::vector<std::uint32_t>& corners) {
    DARKROOM_TRY(read_draco_head(bytes));
    static const Result<const void*> loaded = load_module("libdarkroom_draco.so", "darkroom_draco", "Draco");
    if (!loaded) return failure(loaded.error());
    return static_cast<const DracoModule*>(*loaded)->unpack(bytes, vertices, admit, attributes, corners);
}

}  // namespace darkroom::scene
