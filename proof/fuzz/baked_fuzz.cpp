// SPDX-License-Identifier: MIT
// Files of baked kernels: each is refused, or every kernel of its index is
// found, and written again reads the same. The hash of an input is mended,
// since no fuzzer finds it.

#include <fmt/format.h>

#include <cstring>

#include "core/hash.hpp"
#include "fuzz/target.hpp"
#include "gpu/shader/baked_shaders.hpp"

namespace darkroom::fuzz::baked_fuzz {
namespace {

using namespace gpu;

// As baked_shaders.cpp lays them out.
constexpr std::size_t head_bytes = 40, hash_place = 24, index_bytes = 44;

std::string wrong_file(std::string_view text) {
    const Result<BakedShaders> baked = BakedShaders::read(bytes_of(text));
    if (!baked) return wrong_error(baked.error());
    ShadersToBake again{.profile = baked->profile()};
    for (std::size_t i = 0; i < baked->size(); ++i) {
        const char* const at = text.data() + head_bytes + i * index_bytes;
        Digest digest;
        std::uint32_t stage = 0;
        std::memcpy(&digest, at, sizeof digest);
        std::memcpy(&stage, at + sizeof digest, sizeof stage);
        const auto words = baked->find(digest, static_cast<ShaderStage>(stage));
        if (!words) return fmt::format("kernel {} is not found", i);
        again.words.insert_or_assign({digest, static_cast<ShaderStage>(stage)}, *words);
    }
    if (again.words.size() != baked->size()) return "two kernels are the same";
    const std::vector<std::byte> bytes = again.bytes();
    const Result<BakedShaders> twice = BakedShaders::read(bytes);
    if (!twice) return "what is written is refused: " + twice.error().text;
    for (const auto& [key, words] : again.words)
        if (twice->find(key.first, key.second) != words) return "what is written has other words";
    return {};
}

std::string run(std::string_view input) {
    if (std::string wrong = wrong_file(input); !wrong.empty()) return wrong;
    if (input.size() < head_bytes) return {};
    std::string mended(input);
    const Hash hash = content_hash(bytes_of(mended).subspan(head_bytes));
    static_assert(sizeof hash == head_bytes - hash_place);
    std::memcpy(mended.data() + hash_place, &hash, sizeof hash);
    return wrong_file(mended);
}

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    ShadersToBake shaders;
    for (std::uint8_t i = 0; i < 3; ++i) {
        const std::vector<std::byte> bytes = shaders.bytes();
        out.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        std::vector<std::uint32_t> words{0x07230203, 0x10300, 1u << (9 * i), 8, 0};
        words.resize(5 + i, 0xffffffff);
        shaders.words[{sha256(std::string(1, static_cast<char>(i))), static_cast<ShaderStage>(i)}] = words;
    }
    return out;
}

const Registration baked({.name = "baked", .run = run, .seeds = seeds, .max_mebibytes = 16});

}  // namespace
}  // namespace darkroom::fuzz::baked_fuzz
