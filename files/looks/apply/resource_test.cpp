// SPDX-License-Identifier: MIT
// Files that parameters of looks name.
#include <gtest/gtest.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <filesystem>
#include <fstream>

#include "image/test_files.hpp"

namespace darkroom {
namespace {

class LookResources : public WithFolder {
  protected:
    void SetUp() override {
        WithFolder::SetUp();
        if (find_effect("lut") == nullptr) GTEST_SKIP() << "an effect that this test names is not in the tree";
        std::filesystem::create_directory(file("tables"));
        put(file("tables/a.cube"), "LUT_1D_SIZE 2\n0.25 0 0\n1 1 1\n");
        put(file("tables/bad.cube"), "LUT_1D_SIZE 2\n0 0 0\n1 nan 1\n");
    }
    Result<Look> read(const std::string& text, const LookOptions& options = {}) {
        put(file("look.toml"), text);
        return read_look(file("look.toml"), options);
    }
    [[nodiscard]] std::string error_of(const std::string& text, const LookOptions& options = {}) {
        const Result<Look> look = read(text, options);
        return look ? "accepted" : look.error().text;
    }
    static const ColorTable* table_of(Look& look, std::string_view entry = "lut") {
        const LookEntry* const found = find_entry(look, entry);
        if (found == nullptr || found->resources.empty()) return nullptr;
        return std::get_if<ColorTable>(found->resources.front().data.get());
    }
};

const std::string stack_of_two = R"(
[[stack]]
effect = "lut"
lut = "tables/a.cube"
strength = 0.5
[[stack]]
effect = "lut"
fade_to = "tables/a.cube"
lut = "tables/../tables/a.cube"
)";

TEST_F(LookResources, AreFilesBesideTheLook) {
    Result<Look> look = read("[post_process]\nlut = \"tables/a.cube\"\n");
    ASSERT_TRUE(look) << look.error().text;
    const ColorTable* const table = table_of(*look);
    ASSERT_NE(table, nullptr);
    EXPECT_EQ(table->shaper.front(), 0.25f);
    EXPECT_TRUE(find_entry(*look, "lut")->state.enabled) << "a table turns its effect on";
    const std::string text = write_look(*look);
    EXPECT_NE(text.find("\nlut = \"tables/a.cube\"\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nlut_fade_to = \"\"\n"), std::string::npos) << text;
    const Result<Look> again = read(text);
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_EQ(write_look(*again), text);
}

TEST_F(LookResources, AreReadOnceAndGivenToTheComposer) {
    int reads = 0;
    const LookOptions options{
        .load_resource = [&](const std::filesystem::path& path, FileUse use) -> Result<ResourceData> {
            ++reads;
            EXPECT_EQ(path, file("tables/a.cube"));
            EXPECT_EQ(use, FileUse::Table);
            return ResourceData(ColorTable{.shaper_size = 2, .shaper = {0, 0, 0, 1, 1, 1}});
        }};
    const Result<Look> look = read(stack_of_two, options);
    ASSERT_TRUE(look) << look.error().text;
    EXPECT_EQ(reads, 1);
    Composer composer(Device::assumed());
    const Result<> applied = apply(*look, composer);
    ASSERT_TRUE(applied) << applied.error().text;
    EXPECT_EQ(composer.resources().size(), 1u) << "named three times, defined once";
    for (std::size_t i = 0; i < 2; ++i) {
        const Handle entry = composer.entry(i);
        const ParamInfo* const row = composer.info(entry)->parameters.find("lut");
        EXPECT_TRUE(composer.resources().contains(composer.words(entry)[row->word])) << i;
    }
    const Result<Plan> plan = composer.plan({.max_extent = {64, 64}});
    EXPECT_TRUE(plan) << plan.error().text;
    EXPECT_EQ(write_look(*read(write_look(*look), options)), write_look(*look));
}

TEST_F(LookResources, AHostMayReadNoneAndBringAll) {
    const Result<Look> refused = read(stack_of_two, {.reads_tables = false});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("a.cube: this program reads no tables for looks"), std::string::npos)
        << refused.error().text;
    const Result<Look> brought =
        read(stack_of_two, {.load_resource = [](const std::filesystem::path&, FileUse) -> Result<ResourceData> {
                                return ResourceData(ColorTable{.shaper_size = 2, .shaper = {0, 0, 0, 1, 1, 1}});
                            },
                            .reads_tables = false});
    EXPECT_TRUE(brought) << brought.error().text;
}

TEST_F(LookResources, WiresNameFilesOfPictures) {
    std::vector<std::pair<std::string, FileUse>> asked;
    const LookOptions options{
        .load_resource = [&](const std::filesystem::path& path, FileUse use) -> Result<ResourceData> {
            asked.emplace_back(path.filename().string(), use);
            return ResourceData(ResourceImage{1, 1, {0.5f, 0.5f, 0.5f, 1}});
        }};
    const std::string text =
        "[[stack]]\neffect = \"blend\"\nsecond = \"over.png\"\nmask = \"shapes/over.png\"\n"
        "[[stack]]\neffect = \"blend\"\nsecond = \"over.png\"\ninput = \"under.exr\"\n";
    const Result<Look> look = read(text, options);
    ASSERT_TRUE(look) << look.error().text;
    using Asked = std::pair<std::string, FileUse>;
    std::ranges::sort(asked);
    EXPECT_EQ(asked,
              (std::vector<Asked>{
                  {"over.png", FileUse::Numbers}, {"over.png", FileUse::Picture}, {"under.exr", FileUse::Picture}}));
    Composer composer(Device::assumed());
    const Result<> applied = apply(*look, composer);
    ASSERT_TRUE(applied) << applied.error().text;
    const EntryDesc& first = *composer.desc(composer.entry(0));
    const EntryDesc& other = *composer.desc(composer.entry(1));
    for (const Handle handle : {first.second, first.mask, other.input})
        EXPECT_TRUE(composer.resources().contains(handle.id));
    EXPECT_EQ(first.second, other.second);
    EXPECT_NE(first.second, first.mask) << "a mask's numbers are not a picture's colours";
    const Result<Plan> plan = composer.plan({.max_extent = {64, 64}});
    EXPECT_TRUE(plan) << plan.error().text;
    EXPECT_EQ(write_look(*read(write_look(*look), options)), write_look(*look));

    Look flagged = *look;
    EXPECT_TRUE(override_look(flagged, std::vector<LookOverride>{{"blend.mask", "scene", "--set"}}, options));
    EXPECT_EQ(flagged.entries.front().mask, "scene");
    EXPECT_EQ(flagged.entries.front().resources.size(), 1u) << "the file goes with its wire";
    EXPECT_TRUE(override_look(flagged, std::vector<LookOverride>{{"blend#2.mask", "m.png", "--set"}}, options));
    EXPECT_EQ(flagged.entries.back().mask, "m.png");
    const std::string without = error_of("[[stack]]\neffect = \"negative\"\nmask = \"m.png\"\n");
    EXPECT_TRUE(without.ends_with("m.png: this program reads no pictures for looks")) << without;
}

TEST_F(LookResources, ErrorsNameTheLookTheFileAndItsLine) {
    const std::string look = file("look.toml").string(), folder = file("tables").string();
    EXPECT_EQ(error_of("[post_process]\nlut = \"tables/bad.cube\"\n"),
              look + ":2:7: lut = \"tables/bad.cube\": " + folder +
                  "/bad.cube:3: 'nan' is not a finite number of single precision");
    const std::string missing = error_of("[[stack]]\neffect = \"lut\"\nlut = \"none.cube\"\n");
    EXPECT_TRUE(missing.starts_with(look + ":3:7: lut = \"none.cube\": ")) << missing;
    EXPECT_EQ(error_of("[post_process]\nlut = 3\n"),
              look + ":2:7: lut = 3: expected the name of a file, empty for none");
    EXPECT_EQ(error_of(stack_of_two, {.max_resource_numbers = 5}).substr(0, look.size()), look);
    EXPECT_EQ(error_of(stack_of_two, {.max_resource_numbers = 6}), "accepted") << "each file counts once";
}

TEST_F(LookResources, BehindWhatIsTooMuchNothingIsRead) {
    std::string text;
    for (int i = 0; i < 9; ++i) text += "[[stack]]\neffect = \"lut\"\nlut = \"" + std::to_string(i) + ".cube\"\n";
    int reads = 0;
    const std::string error =
        error_of(text, {.load_resource = [&](const std::filesystem::path&, FileUse) -> Result<ResourceData> {
                            ++reads;
                            return ResourceData(ColorTable{.shaper_size = 2, .shaper = {0, 0, 0, 1, 1, 1}});
                        },
                        .max_resource_numbers = 12});
    EXPECT_EQ(reads, 3) << error;
    EXPECT_NE(error.find("2.cube: with it, the look's tables and pictures hold 18 numbers, at most 12 are allowed"),
              std::string::npos)
        << error;
    EXPECT_NE(error.find("8.cube: is not read"), std::string::npos) << error;
}

TEST_F(LookResources, FlagsNameFilesOfTheirOwn) {
    Look look = default_look();
    const std::string path = file("tables/a.cube").string();
    const auto override = [&](std::vector<LookOverride> values) {
        const Result<> done = override_look(look, values);
        return done ? std::string() : done.error().text;
    };
    EXPECT_EQ(override({{"lut", path, "--lut"}}), "");
    EXPECT_NE(table_of(look), nullptr);
    EXPECT_TRUE(find_entry(look, "lut")->state.enabled);
    EXPECT_EQ(override({{"lut_fade_to", path, "--lut-fade-to"}, {"lut", "", "--lut"}}), "");
    EXPECT_FALSE(find_entry(look, "lut")->state.enabled) << "an empty name takes it away, and turns it off";
    EXPECT_EQ(find_entry(look, "lut")->resources.size(), 1u);
    EXPECT_EQ(override({{"lut.lut", path, "--set"}, {"lut_enabled", "off", "--lut-enabled"}}), "");
    EXPECT_FALSE(find_entry(look, "lut")->state.enabled);
    EXPECT_TRUE(
        override({{"lut", file("no.cube").string(), "--lut"}}).starts_with("--lut: " + file("no.cube").string()));
}

}  // namespace
}  // namespace darkroom
