// SPDX-License-Identifier: MIT
#include "gpu/shader/baked_shaders.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/hash.hpp"
#include "core/test_support_allocations.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {
namespace {

using Bytes = std::vector<std::byte>;
using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t baked_magic = 0x07230203;
// Places in the file, as docs/limits.md and the header have them.
constexpr std::size_t version_at = 8, profile_at = 12, count_at = 16, bytes_at = 20, hash_at = 24, index_at = 40;
constexpr std::size_t index_size = 44, stage_at = 32, length_at = 36, place_at = 40;

Words words_of(std::uint32_t number) { return {baked_magic, 0x10500, 0, number, 0, number * 7}; }

ShadersToBake three() {
    return {.profile = DeviceProfile::Software,
            .words = {{{sha256("one"), ShaderStage::Compute}, words_of(1)},
                      {{sha256("two"), ShaderStage::Fragment}, words_of(2)},
                      {{sha256("two"), ShaderStage::Vertex}, {baked_magic, 0x10500, 0, 9, 0}}}};
}

void put(Bytes& file, std::size_t place, std::uint32_t value) { std::memcpy(file.data() + place, &value, 4); }
/// Such that damage is not what is found.
Bytes with_right_hash(Bytes file) {
    const Hash hash = content_hash(std::span<const std::byte>(file).subspan(index_at));
    std::memcpy(file.data() + hash_at, &hash, sizeof hash);
    return file;
}
void expect_refused(const Bytes& file, const std::string& part) {
    const Result<BakedShaders> read = BakedShaders::read(file);
    ASSERT_FALSE(read) << part;
    EXPECT_EQ(read.error().fault, Fault::User);
    EXPECT_NE(read.error().text.find(part), std::string::npos) << read.error().text;
    EXPECT_EQ(read.error().text.find('\n'), std::string::npos) << read.error().text;
}

TEST(BakedShaders, AFileGivesBackWhatWasAdded) {
    const Result<BakedShaders> read = BakedShaders::read(three().bytes());
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_EQ(read->size(), 3U);
    EXPECT_EQ(read->profile(), DeviceProfile::Software);
    EXPECT_EQ(read->find(sha256("one"), ShaderStage::Compute), words_of(1));
    EXPECT_EQ(read->find(sha256("two"), ShaderStage::Fragment), words_of(2));
    EXPECT_EQ(read->find(sha256("two"), ShaderStage::Vertex), (Words{baked_magic, 0x10500, 0, 9, 0}));
    EXPECT_EQ(read->find(sha256("one"), ShaderStage::Vertex), std::nullopt) << "of another stage";
    EXPECT_EQ(read->find(sha256("three"), ShaderStage::Compute), std::nullopt);
    const Result<BakedShaders> nothing = BakedShaders::read(ShadersToBake().bytes());
    ASSERT_TRUE(nothing) << "nothing is a file, too";
    EXPECT_EQ(nothing->find(sha256("one"), ShaderStage::Compute), std::nullopt);
}

TEST(BakedShaders, EachOfManyIsFound) {
    ShadersToBake many;
    for (std::uint32_t i = 0; i < 300; ++i) many.words[{sha256(std::to_string(i)), ShaderStage::Compute}] = words_of(i);
    const Result<BakedShaders> read = BakedShaders::read(many.bytes());
    ASSERT_TRUE(read) << read.error().text;
    for (std::uint32_t i = 0; i < 300; ++i)
        EXPECT_EQ(read->find(sha256(std::to_string(i)), ShaderStage::Compute), words_of(i)) << i;
}

TEST(BakedShaders, WhatIsCutOffOrDamagedIsRefused) {
    const Bytes whole = three().bytes();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(BakedShaders::read(std::span(whole).first(size))) << size << " bytes";
    Bytes longer = whole;
    longer.push_back(std::byte{0});
    expect_refused(longer, "bytes");
    for (std::size_t place = 0; place < whole.size(); ++place) {
        if (place >= profile_at && place < count_at) continue;  // another profile is no damage
        Bytes damaged = whole;
        damaged[place] ^= std::byte{0x10};
        EXPECT_FALSE(BakedShaders::read(damaged)) << "byte " << place;
    }
}

TEST(BakedShaders, EveryNumberIsCheckedBeforeItIsUsed) {
    const Bytes whole = three().bytes();
    const auto with = [&](std::size_t place, std::uint32_t value) {
        Bytes file = whole;
        put(file, place, value);
        return with_right_hash(file);
    };
    expect_refused(with(version_at, 2), "version 2; allowed is 1");
    expect_refused(with(profile_at, 2), "profile 2");
    expect_refused(with(count_at, 65537), "allowed is at most 65536");
    expect_refused(with(count_at, 65536), "are there");
    expect_refused(with(bytes_at, ~0U), "are there");
    expect_refused(with(index_at + stage_at, 3), "kernel 1 of 3: stage 3");
    expect_refused(with(index_at + length_at, 0), "kernel 1 of 3: 0 words");
    expect_refused(with(index_at + length_at, ~0U), "kernel 1 of 3: 4294967295 words");
    expect_refused(with(index_at + place_at, 0), "kernel 1 of 3: place 0: allowed is 172");
    expect_refused(with(index_at + index_size + place_at, ~0U), "kernel 2 of 3: place 4294967295");
    expect_refused(with(index_at + 2 * index_size + length_at, 7), "kernel 3 of 3: its words end too early");
    expect_refused(with(index_at + 3 * index_size, 1), "not SPIR-V");
    expect_refused(with(index_at + 3 * index_size, ~0U), "kernel 1 of 3: its words end too early");
    Bytes twice = whole;
    std::memcpy(twice.data() + index_at + index_size, twice.data() + index_at, index_size);
    expect_refused(with_right_hash(twice), "out of order");
    Bytes longer = whole;
    longer.push_back(std::byte{0});
    put(longer, bytes_at, static_cast<std::uint32_t>(longer.size() - index_at - 3 * index_size));
    expect_refused(with_right_hash(longer), "1 bytes after the last kernel");
    expect_refused(Bytes(BakedShaders::max_bytes + 1), "16777217 bytes; allowed is at most 16777216");
    expect_refused(Bytes(64), "not a file that 'darkroom bake' wrote");
}

TEST(BakedShaders, RandomBytesAreRefusedOrRead) {
    std::mt19937 random(1);
    const Bytes whole = three().bytes();
    for (int i = 0; i < 20000; ++i) {
        Bytes file = whole;
        for (int change = 0; change < 3; ++change)
            file[index_at + random() % (3 * index_size)] = static_cast<std::byte>(random());
        const Result<BakedShaders> read = BakedShaders::read(with_right_hash(std::move(file)));
        EXPECT_TRUE(!read || read->size() == 3);
    }
}

// Counts that say of four kilobytes that they are gigabytes, and kernels that say it of their words.
TEST(BakedShaders, NoFileTakesMoreMemoryThanItself) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const auto allocated_by = [](const Bytes& file) {
        const std::uint64_t before = test::allocated_bytes();
        const bool is_read = BakedShaders::read(file).has_value();
        return std::pair(is_read, test::allocated_bytes() - before);
    };
    const Bytes whole = three().bytes();
    EXPECT_EQ(allocated_by(whole), std::pair(true, std::uint64_t{whole.size()}));
    constexpr std::uint64_t error_text = 1024;
    for (const std::size_t place : {count_at, bytes_at, index_at + length_at, index_at + place_at}) {
        for (const std::uint32_t value : {~0U, 0x7fffffffU, 65536U, 65537U}) {
            Bytes file = whole;
            put(file, place, value);
            const auto [is_read, bytes] = allocated_by(with_right_hash(file));
            EXPECT_FALSE(is_read) << place << ": " << value;
            EXPECT_LE(bytes, error_text) << place << ": " << value;
        }
    }
}

TEST(GpuShaderCompiler, WhatIsBakedIsAskedFirst) {
    const std::string text = "no GLSL at all";
    ShaderCompiler compiler{std::filesystem::path()};
    const ShadersToBake one{.words = {{{sha256(text), ShaderStage::Compute}, words_of(5)}}};
    Result<BakedShaders> baked = BakedShaders::read(one.bytes());
    ASSERT_TRUE(baked) << baked.error().text;
    compiler.set_baked(std::move(*baked));
    const Result<Words> found = compiler.compile({.name = "a kernel", .text = text});
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_EQ(*found, words_of(5));
    EXPECT_EQ(compiler.compiled, 0U);
    EXPECT_EQ(compiler.from_baked, 1U);
    compiler.has_compiler = false;
    const Result<Words> lacking = compiler.compile({.name = "another kernel", .text = text + "."});
    ASSERT_FALSE(lacking);
    EXPECT_EQ(lacking.error().text,
              "another kernel: it is not among the 1 kernels that were baked for profile gpu, and this library has no "
              "compiler of GLSL");
    EXPECT_TRUE(compiler.is_missing(lacking.error()));
}

}  // namespace
}  // namespace darkroom::gpu
