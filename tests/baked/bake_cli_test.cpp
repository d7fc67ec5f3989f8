// SPDX-License-Identifier: MIT
// `darkroom bake`: its flags, what it refuses, and that the same looks give the same file.
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "gpu/shader/baked_shaders.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using Words = std::vector<std::string>;

class CliBake : public test::CliFixture {
  protected:
    void make_files() override {
        write("grey.toml", "format = 1\n[[stack]]\neffect = \"grayscale\"\n");
        write("dark.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\nexposure = 0.5\n");
    }
    [[nodiscard]] Words bake(const Words& more) const {
        Words typed{"bake", path("grey.toml"), "-o", path("out.dkb"), "--profile", "gpu", "--size", "64x64"};
        typed.insert(typed.end(), more.begin(), more.end());
        return typed;
    }
    struct File {
        std::vector<std::byte> bytes;
        gpu::BakedShaders shaders;
    };
    /// The file that this makes; empty: it made none.
    [[nodiscard]] File baked(const Words& more) const {
        const test::Outcome outcome = run(bake(more));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        auto bytes = read_file(path("out.dkb"));
        if (!bytes) return {};
        auto read = gpu::BakedShaders::read(*bytes);
        EXPECT_TRUE(read) << read.error().text;
        EXPECT_NE(outcome.out.find(std::to_string(bytes->size()) + " bytes"), std::string::npos) << outcome.out;
        return read ? File{std::move(*bytes), std::move(*read)} : File{};
    }
};

TEST_F(CliBake, TheSameLookGivesTheSameFileAndMoreLooksOrImagesGiveMore) {
    const File one = baked({});
    EXPECT_GE(one.shaders.size(), 2U);
    EXPECT_EQ(one.shaders.profile(), DeviceProfile::Gpu);
    EXPECT_EQ(baked({}).bytes, one.bytes);
    EXPECT_EQ(baked({"--size", "128x128"}).shaders.size(), one.shaders.size())
        << "a look whose kernels do not ask for the size";
    EXPECT_GT(baked({path("dark.toml")}).shaders.size(), one.shaders.size());
    const File other = baked({"--color-format", "b10g11r11_ufloat_pack32:storage", "--target-format", "B8G8R8A8_SRGB"});
    EXPECT_NE(baked({"--output-space", "pq", "--target-format", "A2B10G10R10_UNORM_PACK32"}).bytes,
              baked({"--target-format", "A2B10G10R10_UNORM_PACK32"}).bytes)
        << "a target that takes other numbers";
    EXPECT_NE(other.bytes, one.bytes) << "an image that is loaded, and a target that is rasterised";
}

TEST_F(CliBake, AFolderIsAllItsLooks) {
    const File both = baked({path("dark.toml")});
    std::filesystem::create_directory(path("looks"));
    write("looks/no_look.txt", "");
    EXPECT_NE(run(bake({path("looks")})).err.find("no .toml is in this folder"), std::string::npos);
    write("looks/dark.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\nexposure = 0.5\n");
    EXPECT_EQ(baked({path("looks")}).bytes, both.bytes);
}

TEST_F(CliBake, EveryImageOfAFrameHasAFlag) {
    write("all.toml", "format = 1\n[post_process]\norder = \"scene_linear\"\nssao_enabled = true\n");
    const Words typed{"bake", path("all.toml"), "-o", path("all.dkb"), "--profile", "software", "--size", "64x64"};
    Words with = typed;
    for (const char* const word :
         {"--depth-format", "R32_SFLOAT", "--planar-depth", "--normals-format", "R16G16B16A16_SFLOAT",
          "--velocity-format", "R16G16_SFLOAT", "--plain-velocity", "--ui-format", "R8G8B8A8_UNORM",
          "--reactive-format", "R8_UNORM", "--transparency-format", "R16G16B16A16_SFLOAT", "--exposure-format",
          "R32_SFLOAT", "--shadows"})
        with.emplace_back(word);
    ASSERT_EQ(run(typed).code, 0);
    const auto without = read_file(path("all.dkb"));
    const test::Outcome outcome = run(with);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto all = read_file(path("all.dkb"));
    ASSERT_TRUE(without && all);
    EXPECT_GT(all->size(), without->size());
}

TEST_F(CliBake, EffectsThatAreOffHaveAPlaceIfAsked) {
    write("flat.toml", "format = 1\n[post_process]\nbloom_enabled = false\nssao_enabled = false\n");
    const Words typed{"bake", path("flat.toml"), "-o", path("flat.dkb"), "--profile", "gpu", "--size", "64x64"};
    ASSERT_EQ(run(typed).code, 0);
    const auto without = read_file(path("flat.dkb"));
    Words with = typed;
    with.emplace_back("--keep-off");
    ASSERT_EQ(run(with).code, 0);
    const auto all = read_file(path("flat.dkb"));
    ASSERT_TRUE(without && all);
    EXPECT_GT(all->size(), without->size());
}

TEST_F(CliBake, RefusesWhatItCannotBake) {
    expect_refused({"bake", path("grey.toml"), "-o", path("out.dkb")}, 1, "--profile");
    expect_refused({"bake", path("grey.toml"), "-o", path("out.dkb"), "--profile", "cpu"}, 1,
                   "--profile cpu: allowed is gpu or software");
    expect_refused({"bake", path("none.toml"), "-o", path("out.dkb"), "--profile", "gpu"}, 1, "none.toml");
    expect_refused({"bake", path(""), "-o", path("grey.toml"), "--profile", "gpu"}, 1,
                   "grey.toml: is also an input, and would be overwritten");
    expect_refused(
        {"bake", path("grey.toml"), "--layer", path("dark.toml"), "-o", path("dark.toml"), "--profile", "gpu"}, 1,
        "dark.toml: is also an input, and would be overwritten");
    expect_refused(bake({"--depth-format", "D32"}), 1, "--depth-format D32: not a format of images");
    expect_refused(bake({"--target-format", ":storage"}), 1, "--target-format :storage");
    expect_refused(bake({"--output-space", "pq", "--target-format", "R32G32B32A32_SFLOAT"}), 1,
                   "--output-space pq: a target of R32G32B32A32_SFLOAT cannot hold it");
    expect_refused(bake({"--size", "0x4"}), 1, "--size 0x4");
    expect_refused(bake({"--size", "99999x4"}), 1, "grey.toml: size 99999x4: this device allows 1x1 to 16384x16384");
}

}  // namespace
}  // namespace darkroom
