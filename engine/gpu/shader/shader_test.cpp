// SPDX-License-Identifier: MIT
#include "gpu/shader/shader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>

#include "core/files.hpp"
#include "core/system/folders.hpp"
#include "core/thread/parallel.hpp"

namespace darkroom::gpu {

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t spirv_magic = 0x07230203;

ShaderSource source(std::string body) {
    return {.name = "test", .text = "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n" + body};
}

class GpuShaderCache : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::remove_all(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }
    [[nodiscard]] std::filesystem::path only_entry() const {
        const std::filesystem::directory_iterator entries(folder);
        return entries == std::filesystem::directory_iterator() ? std::filesystem::path() : entries->path();
    }
    [[nodiscard]] std::uintmax_t bytes_in_folder() const {
        std::uintmax_t bytes = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) bytes += entry.file_size();
        return bytes;
    }
    void make_older(int hours) const {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            std::filesystem::last_write_time(entry.path(), entry.last_write_time() - std::chrono::hours(hours));
        }
    }
    std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) /
        ("darkroom_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    ShaderSource empty = source("layout(local_size_x = 1) in;\nvoid main() {}\n");
};

/// How many instructions call this function of GLSL.std.450.
std::ptrdiff_t calls_of(const Words& words, std::uint32_t function) {
    constexpr std::uint32_t header_words = 5, call_instruction = 12;
    std::ptrdiff_t calls = 0;
    for (std::size_t i = header_words; i < words.size() && words[i] >> 16 != 0; i += words[i] >> 16)
        if ((words[i] & 0xffff) == call_instruction && words[i + 4] == function) ++calls;
    return calls;
}

// A driver may make anything of FMin, FMax and FClamp of NaN.
TEST(GpuShaderCompiler, ClampsTakeTheOperandThatIsANumber) {
    constexpr std::uint32_t f_min = 37, f_max = 40, f_clamp = 43, n_min = 79, n_max = 80, n_clamp = 81;
    ShaderCompiler compiler{std::filesystem::path()};
    const Result<Words> words =
        compiler.compile({.name = "test",
                          .text = "#version 460\nlayout(location = 0) in vec3 a;\nlayout(location = 0) out vec3 b;\n"
                                  "void main() { b = vec3(clamp(a.x, a.y, a.z), min(a.x, a.y), max(a.y, a.z)); }\n",
                          .stage = ShaderStage::Fragment});
    ASSERT_TRUE(words) << words.error().text;
    for (const std::uint32_t function : {f_min, f_max, f_clamp}) EXPECT_EQ(calls_of(*words, function), 0) << function;
    for (const std::uint32_t function : {n_min, n_max, n_clamp}) EXPECT_EQ(calls_of(*words, function), 1) << function;
}

TEST_F(GpuShaderCache, AnEntryInThePlaceOfAnotherIsNone) {
    const ShaderSource other = source("layout(local_size_x = 2) in;\nvoid main() {}\n");
    std::vector<std::filesystem::path> entries;
    std::vector<Words> right;
    {
        ShaderCompiler compiler{folder};
        for (const ShaderSource& one : {empty, other}) right.push_back(compiler.compile(one).value());
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder)) entries.push_back(entry.path());
    ASSERT_EQ(entries.size(), 2U);
    std::filesystem::rename(entries[0], folder / "kept");
    std::filesystem::rename(entries[1], entries[0]);
    std::filesystem::rename(folder / "kept", entries[1]);
    ShaderCompiler compiler{folder};
    EXPECT_EQ(compiler.compile(empty).value(), right[0]);
    EXPECT_EQ(compiler.compile(other).value(), right[1]);
    EXPECT_EQ(compiler.from_cache, 0U);
    // What is no regular file is passed over, and nobody waits for it.
    std::filesystem::remove(entries[0]);
    ASSERT_EQ(::mkfifo(entries[0].c_str(), 0600), 0);
    std::filesystem::resize_file(entries[1], std::uintmax_t{1} << 33);
    ShaderCompiler again{folder};
    EXPECT_EQ(again.compile(empty).value(), right[0]);
    EXPECT_EQ(again.compile(other).value(), right[1]);
    EXPECT_EQ(again.from_cache, 0U);
}

TEST_F(GpuShaderCache, GivesTheSameWordsWithoutTheCompiler) {
    ShaderCompiler first(folder);
    const Result<Words> made = first.compile(empty);
    ASSERT_TRUE(made) << made.error().text;
    EXPECT_EQ(made->front(), spirv_magic);
    ShaderCompiler second(folder);
    const Result<Words> found = second.compile(empty);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, *made);
    EXPECT_EQ(second.compiled, 0U);
    EXPECT_EQ(second.from_cache, 1U);
    EXPECT_TRUE(second.compile(source("layout(local_size_x = 2) in;\nvoid main() {}\n")));
    EXPECT_EQ(second.compiled, 1U);
}

TEST_F(GpuShaderCache, DoesNotTrustADamagedEntry) {
    const Result<Words> made = ShaderCompiler(folder).compile(empty);
    ASSERT_TRUE(made);
    std::vector<std::byte> bytes = read_file(only_entry()).value();
    const std::vector<std::byte> whole = bytes;
    bytes[bytes.size() / 2] ^= std::byte{1};
    ASSERT_TRUE(write_file(only_entry(), bytes));
    ShaderCompiler compiler(folder);
    EXPECT_EQ(compiler.compile(empty).value(), *made);
    EXPECT_EQ(compiler.compiled, 1U);
    EXPECT_EQ(read_file(only_entry()).value(), whole) << "the entry is mended";
    for (const std::size_t size : {std::size_t{0}, std::size_t{15}, std::size_t{16}, whole.size() - 4}) {
        ASSERT_TRUE(write_file(only_entry(), std::span(whole).first(size)));
        EXPECT_EQ(compiler.compile(empty).value(), *made) << size;
    }
    EXPECT_EQ(compiler.from_cache, 0U);
}

TEST_F(GpuShaderCache, DoesNotTrustWhatOthersMayWrite) {
    if (!is_of_this_user_alone(std::filesystem::temp_directory_path().root_path()))
        GTEST_SKIP() << "everything here may be written by others";
    using enum std::filesystem::perms;
    const Result<Words> made = ShaderCompiler(folder).compile(empty);
    ASSERT_TRUE(made);
    for (const std::filesystem::path& path : {only_entry(), folder}) {
        std::filesystem::permissions(path, others_write, std::filesystem::perm_options::add);
        ShaderCompiler compiler(folder);
        EXPECT_EQ(compiler.compile(empty).value(), *made);
        EXPECT_EQ(compiler.from_cache, 0U) << path;
        std::filesystem::permissions(path, others_write, std::filesystem::perm_options::remove);
        if (path == folder) continue;
        ShaderCompiler again(folder);
        EXPECT_EQ(again.compile(empty).value(), *made);
        EXPECT_EQ(again.from_cache, 1U) << "what was written anew is its own";
    }
}

TEST_F(GpuShaderCache, ForgetsWhatWasNotUsedForLongest) {
    const auto numbered = [](int index) {
        return source("layout(local_size_x = " + std::to_string(index + 2) + ") in;\nvoid main() {}\n");
    };
    ASSERT_TRUE(ShaderCompiler(folder).compile(numbered(0)));
    const std::uintmax_t entry_size = std::filesystem::file_size(only_entry());
    ShaderCompiler compiler(folder, 4 * entry_size + entry_size / 2);
    for (int index = 1; index < 4; ++index) ASSERT_TRUE(compiler.compile(numbered(index)));
    EXPECT_EQ(bytes_in_folder(), 4 * entry_size) << "as many as there is room for";
    // Hours apart, so that no clock's steps matter; then the oldest is used again.
    make_older(24);
    ASSERT_TRUE(compiler.compile(numbered(0)));
    ASSERT_TRUE(compiler.compile(numbered(4)));
    EXPECT_LE(bytes_in_folder(), 4 * entry_size);
    EXPECT_GE(bytes_in_folder(), 2 * entry_size);
    ShaderCompiler next(folder);
    ASSERT_TRUE(next.compile(numbered(0)));
    ASSERT_TRUE(next.compile(numbered(4)));
    EXPECT_EQ(next.from_cache, 2U) << "what was used last stays";
    int missing = 0;
    for (int index = 1; index < 4; ++index) {
        const std::uint64_t before = next.compiled;
        ASSERT_TRUE(next.compile(numbered(index)));
        missing += next.compiled > before ? 1 : 0;
    }
    EXPECT_GE(missing, 1);
}

TEST_F(GpuShaderCache, CompilersThatShareAFolderKeepItsBound) {
    constexpr std::uintmax_t most = 1500;
    std::vector<ShaderSource> sources;
    for (int index = 0; index < 12; ++index) {
        sources.push_back(source("layout(local_size_x = " + std::to_string(index + 1) + ") in;\nvoid main() {}\n"));
    }
    ShaderCompiler one(folder, most), other(folder, most);
    std::vector<Result<Words>> results(2 * sources.size());
    parallel_for(results.size(), 4, [&](std::size_t index) {
        ShaderCompiler& compiler = index % 2 == 0 ? one : other;
        results[index] = compiler.compile(sources[index / 2]);
    });
    ShaderCompiler without({});
    for (std::size_t index = 0; index < results.size(); ++index) {
        ASSERT_TRUE(results[index]) << results[index].error().text;
        if (index % 2 == 0) continue;
        EXPECT_EQ(*results[index], *results[index - 1]);
        EXPECT_EQ(*results[index], without.compile(sources[index / 2]).value());
    }
    // Each looks at the folder again after `most` bytes of its own, so together they may be over by one bound.
    EXPECT_LE(bytes_in_folder(), 2 * most);
}

TEST(GpuShader, MakesWhatAVulkan12DeviceLoads) {
    ShaderCompiler compiler({});
    const Result<Words> words = compiler.compile(source("layout(local_size_x = 1) in;\nvoid main() {}\n"));
    ASSERT_TRUE(words);
    constexpr std::uint32_t spirv_1_5 = 0x00010500;
    EXPECT_EQ((*words)[1], spirv_1_5);
}

TEST(GpuShader, WorksWithoutAFolder) {
    ShaderCompiler compiler({});
    EXPECT_TRUE(compiler.compile(source("layout(local_size_x = 1) in;\nvoid main() {}\n")));
    EXPECT_EQ(compiler.compiled, 1U);
}

TEST(GpuShader, ErrorsNameFileAndLine) {
    ShaderCompiler compiler({});
    const Result<Words> result =
        compiler.compile(source("#line 12 \"effects/bloom/bloom.glsl\"\nvoid main() { x = 1; }\n"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text, "effects/bloom/bloom.glsl:12: 'x' : undeclared identifier");
    EXPECT_EQ(result.error().fault, Fault::User);
    const Result<Words> control = compiler.compile(source("void main() { \x13; }\n"));
    ASSERT_FALSE(control);
    EXPECT_NE(control.error().text.find("'\\x13'"), std::string::npos) << control.error().text;
}

TEST(GpuShader, CompilesManyInOrder) {
    ShaderCompiler compiler({});
    std::vector<ShaderSource> sources;
    for (int index = 0; index < 8; ++index) {
        sources.push_back(source("layout(local_size_x = " + std::to_string(index + 1) + ") in;\nvoid main() {}\n"));
    }
    sources[5].text = "#version 460\nno\n";
    const std::vector<Result<Words>> results = compiler.compile_all(sources);
    ASSERT_EQ(results.size(), sources.size());
    for (std::size_t index = 0; index < sources.size(); ++index) {
        ASSERT_EQ(results[index].has_value(), index != 5);
        if (index == 5) continue;
        EXPECT_EQ(results[index].value(), compiler.compile(sources[index]).value()) << index;
    }
}

}  // namespace

}  // namespace darkroom::gpu
