// SPDX-License-Identifier: MIT
// Steps of undo, and what comes from and goes to files.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <fstream>

#include "edit/document.hpp"
#include "edit/edits.hpp"
#include "edit/follow/compare.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::edit {
namespace {

namespace fs = std::filesystem;

class Document : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "bloom", "vignette", "lut", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("darkroom_document_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    /// Each text gets another time, however fast the test is.
    fs::path write(const std::string& name, const std::string& text) {
        const fs::path path = folder_ / name;
        std::ofstream(path, std::ios::binary) << text;
        fs::last_write_time(path, fs::file_time_type::clock::now() + std::chrono::seconds(++writes_));
        return path;
    }
    static std::string text_of(const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    static LookDocument open(const fs::path& path, const LookOptions& options = {}) {
        Result<LookDocument> out = LookDocument::open(path, options);
        EXPECT_TRUE(out) << out.error().text;
        return out ? std::move(*out) : LookDocument();
    }
    static Result<> expose(LookDocument& document, float value, std::string_view merge = {}) {
        const std::array words{std::bit_cast<std::uint32_t>(value)};
        return document.edit(
            "Exposure", [&](Look& look) { return set_value(look, "exposure", "exposure", words); }, merge);
    }
    static float exposure(const Look& look) {
        Look copy = look;
        return std::bit_cast<float>(find_entry(copy, "exposure")->words[0]);
    }
    static void must(const Result<>& done) { ASSERT_TRUE(done) << done.error().text; }
    static std::string error_of(const auto& result) { return result ? std::string("none") : result.error().text; }

    /// "new", "same", or the error.
    static std::string reloaded(LookDocument& document) {
        const auto is_new = document.reload_if_changed();
        if (!is_new) return is_new.error().text;
        return *is_new ? "new" : "same";
    }

    fs::path folder_;
    int writes_ = 0;
};

TEST_F(Document, UndoTakesStepsBackAndRedoDoesThemAgain) {
    LookDocument document;
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.is_changed());
    must(expose(document, 2));
    must(expose(document, 3));
    EXPECT_EQ(document.undo_name(), "Exposure");
    EXPECT_TRUE(document.is_changed());
    const std::uint64_t version = document.version();
    document.undo();
    EXPECT_NE(document.version(), version);
    EXPECT_EQ(exposure(document.look()), 2);
    document.undo();
    EXPECT_EQ(exposure(document.look()), 1);
    EXPECT_FALSE(document.is_changed());
    EXPECT_FALSE(document.can_undo());
    document.redo();
    document.redo();
    document.redo();
    EXPECT_EQ(exposure(document.look()), 3);
    EXPECT_FALSE(document.can_redo());
    document.undo();
    must(expose(document, 4));
    EXPECT_FALSE(document.can_redo());
    document.undo();
    EXPECT_EQ(exposure(document.look()), 2);
}

TEST_F(Document, DraggingIsOneStep) {
    LookDocument document;
    for (int i = 2; i < 50; ++i) must(expose(document, static_cast<float>(i) / 10, "exposure"));
    document.end_merge();
    must(expose(document, 9, "exposure"));
    document.undo();
    EXPECT_FLOAT_EQ(exposure(document.look()), 4.9f);
    document.undo();
    EXPECT_EQ(exposure(document.look()), 1);
    EXPECT_FALSE(document.can_undo());
    must(expose(document, 1));  // nothing changes
    EXPECT_FALSE(document.can_undo());
}

TEST_F(Document, AnEditBehindAnUndoIsAStepOfItsOwn) {
    LookDocument document;
    must(expose(document, 2));
    must(expose(document, 3, "exposure"));
    document.undo();
    must(expose(document, 4, "exposure"));
    document.undo();
    EXPECT_EQ(exposure(document.look()), 2) << "not merged with what was undone";
    document.redo();
    must(expose(document, 5, "exposure"));
    document.undo();
    EXPECT_EQ(exposure(document.look()), 4) << "nor with what was done again";
}

TEST_F(Document, WhatFailsOrCannotBeHasNotHappened) {
    LookDocument document;
    const std::uint64_t version = document.version();
    EXPECT_FALSE(expose(document, -5));
    const auto half = [](Look& look) -> Result<> {
        look.entries.clear();
        return user_error("no");
    };
    EXPECT_EQ(error_of(document.edit("Half", half)), "no");
    const auto nameless = [&](Look& look) { return set_wire(look, "encode", "input", "nobody", {}); };
    EXPECT_NE(error_of(document.edit("Wire", nameless)).find("no entry has this output"), std::string::npos);
    EXPECT_EQ(document.version(), version);
    EXPECT_FALSE(document.can_undo());
}

TEST_F(Document, HistoryIsBounded) {
    LookDocument document;
    for (std::size_t i = 0; i < LookDocument::max_steps + 50; ++i) must(expose(document, i % 2 == 0 ? 2 : 3));
    std::size_t steps = 0;
    for (; document.can_undo(); ++steps) document.undo();
    EXPECT_EQ(steps, LookDocument::max_steps);
}

// 32 tables of 16 MiB, each seen once.
TEST_F(Document, HistoryOfTablesIsBounded) {
    const LookOptions options{.load_resource = [](const fs::path&, FileUse) -> Result<ResourceData> {
        return ResourceData(ResourceImage{1024, 1024, std::vector<float>(std::size_t{4} << 20)});
    }};
    LookDocument document(default_look(), options);
    const EffectInfo& lut = *find_effect("lut");
    const auto row = std::ranges::find(lut.parameters.rows, Kind::Resource, &ParamInfo::kind);
    for (int i = 0; i < 32; ++i)
        must(document.edit("Table", [&](Look& look) {
            return set_file(look, "lut", row->name, std::to_string(i) + ".cube", options);
        }));
    std::size_t steps = 0;
    for (; document.can_undo(); ++steps) document.undo();
    EXPECT_GE(steps, 10u);
    EXPECT_LE(steps, 18u);
}

TEST_F(Document, SaveWritesTheEditedValuesAlone) {
    const fs::path path = write("a.toml", "# mine\n[post_process]  # all\nexposure = 1.0 # bright\n");
    LookDocument document = open(path);
    must(expose(document, 2.5f));
    must(document.save());
    EXPECT_EQ(text_of(path), "# mine\n[post_process]  # all\nexposure = 2.5 # bright\n");
    EXPECT_FALSE(document.is_changed());
    EXPECT_EQ(reloaded(document), "same");
    document.undo();
    EXPECT_TRUE(document.is_changed());
    must(document.save());
    EXPECT_EQ(text_of(path), "# mine\n[post_process]  # all\nexposure = 1.0 # bright\n");
}

TEST_F(Document, WhatACameraSaysStandsInTheLookWhereItIsChanged) {
    if (find_effect("depth_of_field") == nullptr) GTEST_SKIP() << "this build has no effect depth_of_field";
    const std::string camera = "[camera]\nfocus = 3\naperture = 4\n";
    const auto focus = [](LookDocument& document, float value) {
        const std::array words{std::bit_cast<std::uint32_t>(value)};
        return document.edit("Focus",
                             [&](Look& look) { return set_value(look, "depth_of_field", "focus_distance", words); });
    };
    const fs::path path = write("a.scene.toml", camera + "[post_process]\nexposure = 1.0\n");
    LookDocument document = open(path, {.is_scene = true});
    must(expose(document, 2.5f));
    must(document.save());
    EXPECT_EQ(text_of(path), camera + "[post_process]\nexposure = 2.5\n");
    must(focus(document, 5));
    must(document.save());
    EXPECT_EQ(text_of(path), camera + "[post_process]\nexposure = 2.5\ndepth_of_field_focus_distance = 5.0\n");

    const fs::path stack = write("b.scene.toml", camera + "[[stack]]\neffect = \"exposure\"\n");
    LookDocument other = open(stack, {.is_scene = true});
    must(other.edit("Add", [](Look& look) {
        look.entries.push_back(flat_entry(*find_effect("depth_of_field"), LookOrder::SceneLinear));
        return Result<>{};
    }));
    must(other.save());
    const std::string text = text_of(stack);
    EXPECT_TRUE(text.find("focus_distance = 5.0\n") != std::string::npos) << text;
    EXPECT_TRUE(text.find("f_stop = 2.8") != std::string::npos) << text;
    EXPECT_TRUE(text.find("sensor_height") == std::string::npos) << text;
}

TEST_F(Document, ALookMayBeForACameraOfAnotherFile) {
    if (find_effect("depth_of_field") == nullptr) GTEST_SKIP() << "this build has no effect depth_of_field";
    const auto value = [](const LookDocument& document, std::string_view row) {
        Look copy = document.look();
        const LookEntry& entry = *find_entry(copy, "depth_of_field");
        return std::bit_cast<float>(entry.words[entry.effect->parameters.find(row)->word]);
    };
    const auto set = [](LookDocument& document, std::string_view row, float to) {
        const std::array words{std::bit_cast<std::uint32_t>(to)};
        return document.edit("Lens", [&](Look& look) { return set_value(look, "depth_of_field", row, words); });
    };
    const float usual = value(LookDocument(), "f_stop");
    const std::string text = "[post_process]\nexposure = 1.0\n";
    const fs::path path = write("a.toml", text);
    Result<LookDocument> opened = LookDocument::open(path, {}, {.aperture = 4.0f, .focus = 3.0f});
    ASSERT_TRUE(opened) << opened.error().text;
    LookDocument& document = *opened;
    EXPECT_EQ(value(document, "f_stop"), 4);
    EXPECT_EQ(value(document, "focus_distance"), 3);
    EXPECT_FALSE(document.is_changed());
    must(expose(document, 2.5f));
    must(document.save());
    EXPECT_EQ(text_of(path), "[post_process]\nexposure = 2.5\n") << "what the camera says is not the look's";
    write("a.toml", text);
    EXPECT_EQ(reloaded(document), "new");
    EXPECT_EQ(value(document, "f_stop"), 4);

    // Another camera: what was changed, and what the file says, stays.
    must(set(document, "focus_distance", 7));
    document.follow_lens({.aperture = 8.0f, .focus = 2.0f});
    EXPECT_EQ(value(document, "f_stop"), 8);
    EXPECT_EQ(value(document, "focus_distance"), 7);
    document.undo();
    EXPECT_EQ(value(document, "f_stop"), 8);
    EXPECT_EQ(value(document, "focus_distance"), 2);
    document.redo();
    must(document.save());
    EXPECT_EQ(text_of(path), text + "depth_of_field_focus_distance = 7.0\n");

    // What is the effect's default stays so where the camera says otherwise.
    must(set(document, "f_stop", usual));
    fs::create_directories(folder_ / "other");
    must(document.save_as(folder_ / "other" / "b.toml"));
    const Result<LookDocument> again =
        LookDocument::open(folder_ / "other" / "b.toml", {}, {.aperture = 8.0f, .focus = 2.0f});
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_TRUE(says_same(again->look(), document.look()));
}

TEST_F(Document, WhatOthersWroteIsNotOverwritten) {
    const fs::path path = write("a.toml", "[post_process]\nexposure = 1.0\n");
    LookDocument document = open(path);
    must(expose(document, 2));
    write("a.toml", "[post_process]\nexposure = 1.5\n");
    EXPECT_NE(error_of(document.save()).find("changed by others"), std::string::npos);
    EXPECT_EQ(text_of(path), "[post_process]\nexposure = 1.5\n");
    EXPECT_EQ(reloaded(document), "new");
    EXPECT_EQ(exposure(document.look()), 1.5f);
    document.undo();  // nothing was lost
    EXPECT_EQ(exposure(document.look()), 2);
    EXPECT_TRUE(document.is_changed());
    must(document.save());
    EXPECT_EQ(text_of(path), "[post_process]\nexposure = 2.0\n");
}

TEST_F(Document, AFileThatIsGoneIsWrittenAgain) {
    const fs::path path = write("a.toml", "# mine\n[post_process]\nexposure = 1.0\n");
    LookDocument document = open(path);
    must(expose(document, 2));
    fs::remove(path);
    must(document.save());
    EXPECT_EQ(text_of(path), "# mine\n[post_process]\nexposure = 2.0\n");
    EXPECT_FALSE(document.is_changed());
}

TEST_F(Document, SaveAsKeepsTheTextOrWritesAnew) {
    const fs::path path = write("a.toml", "# mine\n[post_process]\nexposure = 1.0\n");
    LookDocument document = open(path);
    must(expose(document, 2));
    must(document.save_as(folder_ / "b.toml"));
    EXPECT_EQ(text_of(folder_ / "b.toml"), "# mine\n[post_process]\nexposure = 2.0\n");
    EXPECT_EQ(text_of(path), "# mine\n[post_process]\nexposure = 1.0\n");
    EXPECT_EQ(document.file(), folder_ / "b.toml");

    LookDocument fresh;
    must(expose(fresh, 3));
    EXPECT_NE(error_of(fresh.save()).find("no file"), std::string::npos);
    must(fresh.save_as(folder_ / "c.toml"));
    const auto read = read_look(folder_ / "c.toml");
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_TRUE(says_same(*read, fresh.look()));
    EXPECT_EQ(text_of(folder_ / "c.toml"), "format = 1\n\n[post_process]\norder = \"scene_linear\"\nexposure = 3.0\n")
        << "no default";
    EXPECT_FALSE(fresh.save_as(folder_ / "nowhere" / "c.toml"));
    EXPECT_EQ(fresh.file(), folder_ / "c.toml");
}

// Whoever reads a file says when that began: what was saved meanwhile may not be what was read.
TEST_F(Document, WhatIsSavedWhileItIsReadIsAChange) {
    const fs::path before = write("before", "1"), meanwhile = write("meanwhile", "1");
    const auto read = Watch::Clock::now();
    fs::last_write_time(before, fs::file_time_type::clock::now() - std::chrono::seconds(1));
    fs::last_write_time(meanwhile, fs::file_time_type::clock::now() + std::chrono::seconds(1));
    Watch watch;
    watch.add(before, read);
    watch.add(meanwhile, read);
    EXPECT_EQ(watch.take_changes(), std::vector{meanwhile});
    EXPECT_EQ(watch.take_changes(), std::vector<fs::path>{});
}

TEST_F(Document, AWrongFileIsToldOnceAndKeepsTheLook) {
    const fs::path path = write("a.toml", "[post_process]\nexposure = 1.5\n");
    LookDocument document = open(path);
    write("a.toml", "[post_process]\nexposure = \n");
    const std::string error = reloaded(document);
    EXPECT_NE(error.find("a.toml:2:"), std::string::npos) << error;
    EXPECT_EQ(exposure(document.look()), 1.5f);
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_TRUE(document.is_broken());
    EXPECT_NE(error_of(document.save()).find("changed by others"), std::string::npos);
    write("a.toml", "[post_process]\nexposure = 1.5\n");
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_FALSE(document.is_broken());
    write("a.toml", "");  // an editor that is about to write
    EXPECT_EQ(reloaded(document), "same");
    fs::remove(path);
    EXPECT_EQ(reloaded(document), "same");
    write("a.toml", "[post_process]\nexposure = 4.0\n");
    EXPECT_EQ(reloaded(document), "new");
    EXPECT_EQ(exposure(document.look()), 4);
}

TEST_F(Document, NamedFilesAreReadAgain) {
    const std::string identity = "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
    const std::string effect = "// @effect tint: Tints.\n// @param float amount = 1 in [0, 1]: How much.\n";
    const std::string body = "vec4 tint(vec4 color, Pixel pixel, Tint parameters) { return color; }\n";
    const fs::path table = write("a.cube", identity);
    write("tint.glsl", effect + body);
    const EffectInfo& lut = *find_effect("lut");
    const auto row = std::ranges::find(lut.parameters.rows, Kind::Resource, &ParamInfo::kind);
    const fs::path path = write("a.toml",
                                "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"tint.glsl\"\namount = 0.25\n"
                                "[[stack]]\neffect = \"lut\"\n" +
                                    std::string(row->name) + " = \"a.cube\"\n");
    LookDocument document = open(path, {.allows_custom_effects = true});
    must(expose(document, 2));  // not saved
    const auto data = [&] { return document.look().entries[2].resources.at(0).data; };
    const auto before = data();

    write("a.cube", identity);  // the same again
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_EQ(data(), before);

    write("a.cube", "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n0.5 1 1\n");
    EXPECT_EQ(reloaded(document), "new");
    EXPECT_NE(data(), before);
    EXPECT_EQ(exposure(document.look()), 2);
    EXPECT_TRUE(document.is_changed());

    write("tint.glsl", effect + "// @param float more = 0.5 in [0, 1]: More.\n" + body);
    EXPECT_EQ(reloaded(document), "new");
    ASSERT_EQ(document.look().entries[1].words.size(), 2u);
    EXPECT_EQ(std::bit_cast<float>(document.look().entries[1].words[0]), 0.25f);
    EXPECT_EQ(std::bit_cast<float>(document.look().entries[1].words[1]), 0.5f);

    write("tint.glsl", "// @effect\n");
    EXPECT_NE(reloaded(document).find("tint.glsl"), std::string::npos);
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_EQ(document.look().entries[1].words.size(), 2u);
    must(document.save());  // the effect is wrong just now, the look is not
    EXPECT_NE(text_of(path).find("exposure = 2.0\n"), std::string::npos);
}

TEST_F(Document, StepsKeepTheEffectThatItsFileHoldsNow) {
    const std::string head = "// @effect tint: Tints.\n// @param float amount = 1 in [0, 1]: How much.\n";
    const std::string more = "// @param float more = 0.5 in [0, 1]: More.\n";
    const std::string body = "vec4 tint(vec4 color, Pixel pixel, Tint parameters) { return color; }\n";
    write("tint.glsl", head + body);
    const fs::path path = write("a.toml",
                                "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"tint.glsl\"\n"
                                "amount = 0.25\n");
    LookDocument document = open(path, {.allows_custom_effects = true});
    must(expose(document, 2));
    const auto words = [&] { return document.look().entries.at(1).words.size(); };
    const auto amount = [&] { return std::bit_cast<float>(document.look().entries.at(1).words[0]); };

    write("tint.glsl", head + more + body);
    EXPECT_EQ(reloaded(document), "new");
    EXPECT_EQ(words(), 2U);
    EXPECT_NE(document.undo_name(), "Reload") << "what the look says has not changed";
    document.undo();
    EXPECT_EQ(exposure(document.look()), 1);
    EXPECT_EQ(words(), 2U) << "the file's present effect";
    EXPECT_EQ(amount(), 0.25F);
    EXPECT_FALSE(document.is_changed());
    document.redo();
    EXPECT_EQ(words(), 2U);

    // While no entry is of it, nobody looks at its file.
    must(document.edit("remove", [](Look& look) { return remove_entry(look, "tint"); }));
    write("tint.glsl", head + body);
    EXPECT_EQ(reloaded(document), "same");
    document.undo();
    EXPECT_EQ(words(), 1U);
    EXPECT_EQ(amount(), 0.25F);
}

TEST_F(Document, TellsWhatItsFilePassedOver) {
    const fs::path path = write("a.toml", "[post_process]\nexposure = 2\nbogus = 3\n");
    LookDocument document = open(path);
    ASSERT_EQ(document.warnings().size(), 1U);
    EXPECT_NE(document.warnings()[0].find("a.toml:3:1: unknown key 'bogus'"), std::string::npos);
    write("a.toml", "[post_process]\nexposure = 2\n");
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_TRUE(document.warnings().empty());
    EXPECT_EQ(document.changed_files(), std::vector{path});
    write("a.toml", "[post_process]\nnothing = 1\nbogus = 1\nexposure = 2\n");
    EXPECT_EQ(reloaded(document), "same");
    EXPECT_EQ(document.warnings().size(), 2U);
}

}  // namespace
}  // namespace darkroom::edit
