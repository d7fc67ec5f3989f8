// SPDX-License-Identifier: MIT
#include "core/hash.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace darkroom {

namespace {

// Austin Appleby, MurmurHash3 (2011), the 128-bit variant for 64-bit machines, whose author placed it in the public
// domain.
constexpr std::uint64_t multiplier_1 = 0x87c37b91114253d5;
constexpr std::uint64_t multiplier_2 = 0x4cf5ad432745937f;

std::uint64_t mix_final(std::uint64_t value) {
    value ^= value >> 33U;
    value *= 0xff51afd7ed558ccd;
    value ^= value >> 33U;
    value *= 0xc4ceb9fe1a85ec53;
    return value ^ (value >> 33U);
}

std::uint64_t mix_low(std::uint64_t word) { return std::rotl(word * multiplier_1, 31) * multiplier_2; }
std::uint64_t mix_high(std::uint64_t word) { return std::rotl(word * multiplier_2, 33) * multiplier_1; }

}  // namespace

std::string Hash::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

Hash content_hash(std::span<const std::byte> bytes) {
    constexpr std::size_t block_size = 16;
    Hash hash;
    const std::size_t block_count = bytes.size() / block_size;
    for (std::size_t block = 0; block < block_count; ++block) {
        std::uint64_t words[2];
        std::memcpy(words, bytes.data() + block * block_size, block_size);
        hash.low = (std::rotl(hash.low ^ mix_low(words[0]), 27) + hash.high) * 5 + 0x52dce729;
        hash.high = (std::rotl(hash.high ^ mix_high(words[1]), 31) + hash.low) * 5 + 0x38495ab5;
    }
    const std::span<const std::byte> tail = bytes.subspan(block_count * block_size);
    if (!tail.empty()) {
        std::uint64_t words[2] = {0, 0};
        std::memcpy(words, tail.data(), tail.size());
        hash.low ^= mix_low(words[0]);
        hash.high ^= mix_high(words[1]);
    }
    hash.low ^= bytes.size();
    hash.high ^= bytes.size();
    hash.low += hash.high;
    hash.high += hash.low;
    hash.low = mix_final(hash.low);
    hash.high = mix_final(hash.high);
    hash.low += hash.high;
    hash.high += hash.low;
    return hash;
}

}  // namespace darkroom
