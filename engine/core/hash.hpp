// SPDX-License-Identifier: MIT
#pragma once
// A 128-bit hash of bytes, the name of a cache entry and the check that it is undamaged. It is not cryptographic, and
// the same bytes give the same hash on every little-endian machine.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace darkroom {

struct Hash {
    std::uint64_t low = 0;
    std::uint64_t high = 0;

    [[nodiscard]] bool operator==(const Hash&) const = default;
    /// 32 lower-case hexadecimal digits.
    [[nodiscard]] std::string hex() const;
};

[[nodiscard]] Hash content_hash(std::span<const std::byte> bytes);
[[nodiscard]] inline Hash content_hash(std::string_view text) { return content_hash(std::as_bytes(std::span(text))); }

}  // namespace darkroom
