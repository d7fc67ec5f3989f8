// SPDX-License-Identifier: MIT
#pragma once
// An input as a row of choices.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace darkroom::fuzz {

/// Behind the end all are 0.
class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
    [[nodiscard]] bool is_empty() const { return bytes_.empty(); }
    std::uint32_t byte() {
        const auto byte = static_cast<unsigned char>(bytes_.empty() ? 0 : bytes_.front());
        bytes_.remove_prefix(std::min<std::size_t>(1, bytes_.size()));
        return byte;
    }
    /// Of at most 256.
    std::uint32_t below(std::size_t limit) { return static_cast<std::uint32_t>(byte() % limit); }
    std::uint32_t word() { return little_endian(4); }
    std::uint32_t half() { return little_endian(2); }
    /// Any float, what is not finite among them.
    float number() { return std::bit_cast<float>(word()); }
    /// Up to the next zero.
    std::string text() {
        const std::size_t end = std::min(bytes_.find('\0'), bytes_.size());
        std::string out(bytes_.substr(0, end));
        bytes_.remove_prefix(std::min(end + 1, bytes_.size()));
        return out;
    }

  private:
    std::uint32_t little_endian(int count) {
        std::uint32_t out = 0;
        for (int i = 0; i < count; ++i) out |= byte() << (8 * i);
        return out;
    }
    std::string_view bytes_;
};

}  // namespace darkroom::fuzz
