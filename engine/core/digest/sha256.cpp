// SPDX-License-Identifier: MIT
#include "core/digest/sha256.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace darkroom {

namespace {

// The names are those of the standard, sections 4.1.2, 4.2.2 and 5.3.3.
constexpr std::array<std::uint32_t, 64> k{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

using State = std::array<std::uint32_t, 8>;
using Block = std::array<std::byte, 64>;

void add_in_words(State& hash, const Block& block) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t t = 0; t < 16; ++t)
        for (std::size_t i = 0; i < 4; ++i) w[t] = w[t] << 8U | std::to_integer<std::uint32_t>(block[4 * t + i]);
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ w[t - 15] >> 3U;
        const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ w[t - 2] >> 10U;
        w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = hash;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t choice = (e & f) ^ (~e & g);
        const std::uint32_t t1 = h + sum1 + choice + k[t] + w[t];
        const std::uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t majority = (a & b) ^ (a & c) ^ (b & c);
        h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + sum0 + majority;
    }
    const State added{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < hash.size(); ++i) hash[i] += added[i];
}

#ifdef __x86_64__
// Four rounds at a time. The instructions hold the words as {a, b, e, f} and {c, d, g, h}, the highest first (Intel,
// "SHA Extensions", 2013).
__attribute__((target("sha,sse4.1"))) void add_by_instructions(State& hash, const Block& block) {
    const auto load = [](const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); };
    const __m128i cdab = _mm_shuffle_epi32(load(hash.data()), 0xb1), efgh = _mm_shuffle_epi32(load(&hash[4]), 0x1b);
    const __m128i abef_before = _mm_alignr_epi8(cdab, efgh, 8), cdgh_before = _mm_blend_epi16(efgh, cdab, 0xf0);
    __m128i abef = abef_before, cdgh = cdgh_before;
    const __m128i big_endian = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
    __m128i w0 = _mm_shuffle_epi8(load(&block[0]), big_endian), w1 = _mm_shuffle_epi8(load(&block[16]), big_endian);
    __m128i w2 = _mm_shuffle_epi8(load(&block[32]), big_endian), w3 = _mm_shuffle_epi8(load(&block[48]), big_endian);
    for (std::size_t t = 0; t < 64; t += 4) {
        const __m128i sum = _mm_add_epi32(w0, load(&k[t]));
        cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
        abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));
        const __m128i s0 = _mm_sha256msg1_epu32(w0, w1), w_7 = _mm_alignr_epi8(w3, w2, 4);
        const __m128i next = _mm_sha256msg2_epu32(_mm_add_epi32(s0, w_7), w3);
        w0 = w1, w1 = w2, w2 = w3, w3 = next;
    }
    const __m128i feba = _mm_shuffle_epi32(_mm_add_epi32(abef, abef_before), 0x1b);
    const __m128i dchg = _mm_shuffle_epi32(_mm_add_epi32(cdgh, cdgh_before), 0xb1);
    const auto store = [](void* to, __m128i four) { _mm_storeu_si128(static_cast<__m128i*>(to), four); };
    store(hash.data(), _mm_blend_epi16(feba, dchg, 0xf0));
    store(&hash[4], _mm_alignr_epi8(dchg, feba, 8));
}

bool has_instructions() {
    unsigned int eax = 0, ebx = 0, ecx = 0, edx = 0;
    const bool has_sse41 = __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_SSE4_1) != 0;
    constexpr unsigned int sha = 1U << 29;
    return has_sse41 && __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 && (ebx & sha) != 0;
}
#endif

using AddBlock = void (*)(State&, const Block&);

AddBlock fastest() {
#ifdef __x86_64__
    if (has_instructions()) return add_by_instructions;
#endif
    return add_in_words;
}

Digest digest_of(std::span<const std::byte> bytes, AddBlock add_block) {
    State hash{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    const std::uint64_t bits = std::uint64_t{bytes.size()} * 8;
    Block block{};
    while (bytes.size() >= block.size()) {
        std::memcpy(block.data(), bytes.data(), block.size());
        add_block(hash, block);
        bytes = bytes.subspan(block.size());
    }
    // A one, zeros, and the length in bits as the last eight bytes.
    block.fill(std::byte{0});
    std::ranges::copy(bytes, block.begin());
    block[bytes.size()] = std::byte{0x80};
    if (bytes.size() >= block.size() - sizeof bits) {
        add_block(hash, block);
        block.fill(std::byte{0});
    }
    for (std::size_t i = 0; i < sizeof bits; ++i) block[63 - i] = static_cast<std::byte>(bits >> 8 * i);
    add_block(hash, block);

    Digest digest{};
    for (std::size_t i = 0; i < digest.size(); ++i)
        digest[i] = static_cast<std::byte>(hash[i / 4] >> (24 - 8 * (i % 4)));
    return digest;
}

}  // namespace

Digest sha256(std::span<const std::byte> bytes) {
    static const AddBlock add_block = fastest();
    return digest_of(bytes, add_block);
}

Digest sha256_in_words(std::span<const std::byte> bytes) { return digest_of(bytes, add_in_words); }

std::string hex(const Digest& digest) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out;
    for (const std::byte byte : digest) {
        out += digits[std::to_integer<std::size_t>(byte >> 4)];
        out += digits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
    return out;
}

}  // namespace darkroom
