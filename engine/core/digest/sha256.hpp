// SPDX-License-Identifier: MIT
#pragma once
// SHA-256 (FIPS 180-4), the identity of text that strangers may have written: nobody can make two that share one. Our
// own, because hosts link the library, and a library of hashes is more than these lines.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace darkroom {

using Digest = std::array<std::byte, 32>;

[[nodiscard]] Digest sha256(std::span<const std::byte> bytes);
/// The same, without the instructions that processors have for it.
[[nodiscard]] Digest sha256_in_words(std::span<const std::byte> bytes);
[[nodiscard]] inline Digest sha256(std::string_view text) { return sha256(std::as_bytes(std::span(text))); }
/// 64 lower-case hexadecimal digits.
[[nodiscard]] std::string hex(const Digest& digest);

}  // namespace darkroom
