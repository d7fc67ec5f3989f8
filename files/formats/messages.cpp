// SPDX-License-Identifier: MIT
#include "formats/messages.hpp"

#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace darkroom {
namespace {

// As checks of files have them (formats/exr/exr_check.cpp).
constexpr std::uint32_t max_side = 65536, max_parts = 256, max_channels = 1024, max_names = 65536;
constexpr int farthest = 1 << 30;

class Packer {
  public:
    template <class T>
    void put(const T& value) requires std::is_arithmetic_v<T> {
        const auto* const from = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof value);
    }
    void put(const std::string& text) {
        put(static_cast<std::uint32_t>(text.size()));
        const auto* const from = reinterpret_cast<const std::byte*>(text.data());
        bytes.insert(bytes.end(), from, from + text.size());
    }
    template <class T>
    void put(const std::vector<T>& list) {
        put(static_cast<std::uint32_t>(list.size()));
        for (const T& one : list) put(one);
    }

    std::vector<std::byte> bytes;
};

/// What does not fit leaves it wrong, and all that follows zero.
class Unpacker {
  public:
    explicit Unpacker(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    void take(T& value) requires std::is_arithmetic_v<T> {
        if (!has(sizeof value)) return;
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_ = bytes_.subspan(sizeof value);
    }
    void take(std::string& text) {
        const std::uint32_t size = count(1, max_reply_bytes);
        text.assign(reinterpret_cast<const char*>(bytes_.data()), size);
        bytes_ = bytes_.subspan(size);
    }
    template <class T>
    void take(std::vector<T>& list, std::size_t least_bytes, std::uint32_t most) {
        list.resize(count(least_bytes, most));
        for (T& one : list) take(one);
    }
    /// Of things of at least so many bytes each.
    std::uint32_t count(std::size_t least_bytes, std::uint32_t most) {
        std::uint32_t out = 0;
        take(out);
        return out <= most && has(out * least_bytes) ? out : 0;
    }
    void expect(bool is_so) { is_right_ = is_right_ && is_so; }
    [[nodiscard]] bool is_right() const { return is_right_; }
    [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }

  private:
    bool has(std::size_t size) {
        is_right_ = is_right_ && size <= bytes_.size();
        return is_right_;
    }

    std::span<const std::byte> bytes_;
    bool is_right_ = true;
};

void take_part(Unpacker& from, FilePart& part) {
    from.take(part.name);
    from.take(part.view);
    from.take(part.views, 4, max_names);
    from.take(part.compression);
    from.take(part.color_space);
    from.take(part.channels, 4, max_channels);
    for (std::size_t i = 0; i < part.channels.size(); ++i) {
        std::uint32_t kind = 0;
        from.take(kind);
        from.expect(kind <= static_cast<std::uint32_t>(SampleKind::Float));
        part.kinds.push_back(static_cast<SampleKind>(kind));
    }
    for (int* const place : {&part.x, &part.y}) {
        from.take(*place);
        from.expect(*place >= -2 * farthest + 1 && *place <= 2 * (farthest - 1));
    }
    for (std::uint32_t* const side : {&part.width, &part.height, &part.display_width, &part.display_height}) {
        from.take(*side);
        from.expect(*side >= 1);
    }
    for (bool* const fact : {&part.is_associated, &part.has_primaries}) {
        std::uint32_t number = 0;
        from.take(number);
        from.expect(number <= 1);
        *fact = number != 0;
    }
}

}  // namespace

std::vector<std::byte> packed(const PictureDescription& description) {
    Packer to;
    to.put(static_cast<std::uint32_t>(description.parts.size()));
    for (const auto& [part, row_unit, attributes] : description.parts) {
        to.put(part.name);
        to.put(part.view);
        to.put(part.views);
        to.put(part.compression);
        to.put(part.color_space);
        to.put(part.channels);
        for (const SampleKind kind : part.kinds) to.put(static_cast<std::uint32_t>(kind));
        for (const int place : {part.x, part.y}) to.put(place);
        for (const std::uint32_t side : {part.width, part.height, part.display_width, part.display_height})
            to.put(side);
        for (const bool fact : {part.is_associated, part.has_primaries}) to.put(std::uint32_t{fact});
        to.put(row_unit);
        to.put(static_cast<std::uint32_t>(attributes.size()));
        for (const auto& [name, numbers] : attributes) {
            to.put(name);
            to.put(numbers);
        }
    }
    return std::move(to.bytes);
}

std::optional<PictureDescription> unpacked(std::span<const std::byte> bytes) {
    Unpacker from(bytes);
    PictureDescription out;
    out.parts.resize(from.count(1, max_parts));
    for (auto& [part, row_unit, attributes] : out.parts) {
        take_part(from, part);
        from.take(row_unit);
        from.expect(row_unit >= 1 && row_unit <= max_side);
        attributes.resize(from.count(8, max_names));
        for (auto& [name, numbers] : attributes) {
            from.take(name);
            from.take(numbers, sizeof(double), max_reply_bytes);
        }
        if (!from.is_right()) return std::nullopt;
    }
    if (!from.is_right() || !from.is_at_end() || out.parts.empty()) return std::nullopt;
    return out;
}

}  // namespace darkroom
