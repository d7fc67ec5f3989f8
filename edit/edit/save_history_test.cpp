// SPDX-License-Identifier: MIT
// What is saved depends on the look alone: whatever was saved on the way to it, and on whichever way it was reached.

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "edit/document.hpp"
#include "edit/edits.hpp"
#include "edit/test_random_edits.hpp"
#include "tests/places.hpp"

namespace darkroom::edit {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A document in a file of its own, with a number for each state that its steps go through.
class Saved {
  public:
    explicit Saved(const std::string& text, const std::string& name = "my.toml") : first_(text) {
        const fs::path folder =
            fs::path(testing::TempDir()) /
            fmt::format("darkroom_saved_{}", testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder);
        file_ = folder / name;
        std::ofstream(file_, std::ios::binary) << text;
        if (auto opened = LookDocument::open(file_, {})) document_.emplace(std::move(*opened));
        bytes_[0] = text;
    }
    [[nodiscard]] bool is_open() const { return document_.has_value(); }
    LookDocument& document() { return *document_; }

    void edit(const std::function<Result<>(Look&)>& change) {
        const std::uint64_t version = document_->version();
        (void)document_->edit("Something", change);
        if (document_->version() == version) return;
        undo_.push_back(std::exchange(state_, ++last_));
        redo_.clear();
    }
    void undo() {
        document_->undo();
        if (undo_.empty()) return;
        redo_.push_back(std::exchange(state_, undo_.back()));
        undo_.pop_back();
    }
    void redo() {
        document_->redo();
        if (redo_.empty()) return;
        undo_.push_back(std::exchange(state_, redo_.back()));
        redo_.pop_back();
    }
    /// The bytes are those that this state had before.
    testing::AssertionResult save() {
        if (Result<> done = document_->save(); !done) return testing::AssertionFailure() << done.error().text;
        const std::string now = text_of(file_);
        const auto [known, is_first] = bytes_.emplace(state_, now);
        if (known->second == now) return testing::AssertionSuccess();
        return testing::AssertionFailure() << "state " << state_ << " was\n" << known->second << "=====\n" << now;
    }
    [[nodiscard]] bool has_undo() const { return !undo_.empty(); }
    [[nodiscard]] const std::string& first() const { return first_; }
    [[nodiscard]] std::string text() const { return text_of(file_); }

  private:
    std::string first_;
    fs::path file_;
    std::optional<LookDocument> document_;
    std::vector<std::size_t> undo_, redo_;
    std::size_t state_ = 0, last_ = 0;
    std::map<std::size_t, std::string> bytes_;
};

constexpr const char* flat =
    "# mine\n\n[post_process]\nbloom_intensity = 0.20  # it glows\n\n# far away\nfog_density = 0.05\n\n\n"
    "exposure = 1.5\n\n[ui]\n# the visor\nui_warp_strength = -0.1\n";
constexpr const char* stack =
    "# mine\n[[stack]]\neffect = \"bloom\"   # first\nintensity = 0.20\n\n\n[[stack]]\neffect = \"exposure\"\n"
    "exposure = 1.50\n# then\n[[stack]]\neffect = \"tonemap\"\n";

constexpr const char* moved =
    "[post_process]\nvignette_intensity = 0.2\nfog_density = 0.05\n\n# when it hurts\n[[pulse]] # hits\n"
    "event = \"hit\"\nparameter = \"vignette.intensity\"\namount = 0.25 # strong\n# and red\n[[pulse]]\n"
    "event = \"hit\"\nparameter = \"fog.color\"\namount = [0.1, 0.0, 0.0]\n\n\n[[layer]]\nname = \"cave\"\n"
    "distance = { near = 4, far = 12, point = [0, 1, -8] } # of the cave\n"
    "values = { exposure = 0.5, \"fog.enabled\" = true } # dark\n\n"
    "[[layer]]\nname = 'night'\nweight = 0.5\n[layer.values]\nvignette.intensity = 0.75\n";
constexpr const char* moved_inline =
    "pulse = [ { event = \"hit\", parameter = \"exposure\", amount = 1 } ]\n[[stack]]\neffect = \"exposure\"\n"
    "[[layer]]\nname = \"dark\"\n[layer.values.exposure]\nexposure = 0.1\n[[stack]]\neffect = \"tonemap\"\n";

class DocumentHistory : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "fog", "exposure", "tonemap", "blend", "ui_warp", "vignette"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

TEST_F(DocumentHistory, UndoBehindASaveGivesTheBytesBack) {
    Saved saved(flat);
    ASSERT_TRUE(saved.is_open());
    const std::array words{std::bit_cast<std::uint32_t>(0.4f)};
    saved.edit([&](Look& look) { return set_value(look, "bloom", "intensity", words); });
    saved.edit([](Look& look) -> Result<> {
        const auto added = add_effect(look, *find_effect("blend"));
        return added ? Result<>() : failure(added.error());
    });
    saved.edit([](Look& look) { return move_entry(look, "fog", "bloom"); });
    ASSERT_TRUE(saved.save());
    EXPECT_NE(saved.text().find("[[stack]]"), std::string::npos);
    for (int i = 0; i < 3; ++i) saved.undo();
    ASSERT_FALSE(saved.has_undo());
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), flat);
}

TEST_F(DocumentHistory, RandomEditsSavesAndStepsBackGiveEachStateItsBytes) {
    std::mt19937 random(27);
    std::vector<std::string> texts{flat, stack, moved, moved_inline};
    for (const auto& shipped : fs::directory_iterator(std::string(darkroom::test::source_folder) + "/looks"))
        if (shipped.path().extension() == ".toml") texts.push_back(text_of(shipped.path()));
    std::size_t saves = 0;
    for (const std::string& text : texts) {
        Saved saved(text);
        if (!saved.is_open()) continue;  // it names what is not there
        for (int act = 0; act < 120; ++act) {
            const std::uint32_t what = test::below(random, 10);
            if (what < 3) {
                saved.edit([&](Look& look) {
                    return look.entries.empty() ? Result<>()
                                                : test::apply_edit(look, test::random_value_edit(random, look));
                });
            } else if (what < 5) {
                saved.edit([&](Look& look) { return test::random_restructuring(random, look); });
            } else if (what < 7) {
                saved.undo();
            } else if (what < 8) {
                saved.redo();
            } else {
                ASSERT_TRUE(saved.save()) << "of\n" << text;
                ++saves;
            }
        }
        while (saved.has_undo()) saved.undo();
        ASSERT_TRUE(saved.save());
        EXPECT_EQ(saved.text(), text);
        EXPECT_FALSE(saved.document().is_changed());
    }
    EXPECT_GE(saves, 100U);
}

TEST_F(DocumentHistory, PulsesAndLayersComeAndGoWithTheirText) {
    Saved saved(moved);
    ASSERT_TRUE(saved.is_open());
    const auto done = [](const Result<std::size_t>& made) { return made ? Result<>() : failure(made.error()); };
    const std::string text = moved;
    const auto without = [&](const std::string& begin, const std::string& end) {
        const std::size_t at = text.find(begin);
        return std::string(text).erase(at, text.find(end) - at);
    };
    saved.edit([](Look& look) { return remove_mover(look, {false, 1}); });
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), without("# and red", "\n\n[[layer]]"));
    saved.undo();
    saved.edit([](Look& look) { return remove_mover(look, {true, 0}); });
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), without("[[layer]]\nname = \"cave\"", "[[layer]]\nname = 'night'"));
    saved.undo();
    saved.edit([](Look& look) {
        const std::vector<MovedValue> values = values_of(look, {true, 0});
        const auto of_exposure = std::ranges::find(values, "exposure", &MovedValue::entry);
        return remove_layer_value(look, 0, static_cast<std::size_t>(of_exposure - values.begin()));
    });
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), without("exposure = 0.5, ", "\"fog.enabled\" = true"));
    saved.undo();
    saved.edit([&](Look& look) { return done(add_pulse(look, "jump", "exposure", "exposure")); });
    saved.edit([&](Look& look) { return done(add_layer(look, "day", "fog", "enabled")); });
    saved.edit([&](Look& look) { return add_layer_value(look, 1, "fog", "color"); });
    ASSERT_TRUE(saved.save());
    const std::string all = saved.text();
    EXPECT_NE(all.find("amount = [0.1, 0.0, 0.0]\n\n[[pulse]]\nevent = \"jump\"\nparameter = \"exposure.exposure\"\n"),
              std::string::npos)
        << all;
    EXPECT_NE(all.find("vignette.intensity = 0.75\n\"fog.color\" = "), std::string::npos) << all;
    EXPECT_NE(all.find("\n\n[[layer]]\nname = \"day\"\nweight = 1.0\nvalues = { \"fog.enabled\" = true }\n"),
              std::string::npos)
        << all;
    while (saved.has_undo()) saved.undo();
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), moved);
    const auto refused = [&](const std::function<Result<>(Look&)>& change) {
        Look look = saved.document().look();
        const Result<> made = change(look);
        return made ? std::string() : made.error().text;
    };
    EXPECT_NE(refused([&](Look& look) { return done(add_pulse(look, "a b", "fog", "density")); }).find("a b"),
              std::string::npos);
    EXPECT_NE(refused([&](Look& look) { return done(add_pulse(look, "hit", "fog", "enabled")); }).find("of numbers"),
              std::string::npos);
    EXPECT_NE(refused([&](Look& look) { return done(add_layer(look, "cave", "fog", "density")); }).find("two layers"),
              std::string::npos);
    EXPECT_NE(refused([](Look& look) { return remove_layer_value(look, 1, 1); }).find("only value"), std::string::npos);
}

TEST_F(DocumentHistory, ALayerMayBeTheLookOfAFileAndHaveADistance) {
    Saved saved("[post_process]\nbloom_intensity = 0.2\n");
    ASSERT_TRUE(saved.is_open());
    const fs::path folder = saved.document().file().parent_path();
    std::ofstream(folder / "night.toml", std::ios::binary) << "[post_process]\nbloom_intensity = 0.75\n";
    const LookOptions options{.folder = folder};
    const auto add = [&](const std::string& file) {
        Look look = saved.document().look();
        const Result<std::size_t> made = add_layer_of(look, "night", file, options);
        return made ? std::string() : made.error().text;
    };
    EXPECT_EQ(add("night.toml"), "");
    EXPECT_NE(add("none.toml").find("none.toml"), std::string::npos) << add("none.toml");
    saved.edit([&](Look& look) {
        const Result<std::size_t> made = add_layer_of(look, "night", "night.toml", options);
        return made ? Result<>() : Result<>(failure(made.error()));
    });
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), saved.first() + "\n[[layer]]\nname = \"night\"\nlook = \"night.toml\"\nweight = 1.0\n");
    const auto read_again = [&] {
        const Result<Look> read = read_look(saved.document().file(), {});
        return read ? *read : Look{};
    };
    EXPECT_TRUE(is_same(read_again(), saved.document().look()));
    for (const bool is_on : {true, false}) {
        saved.edit([&](Look& look) { return set_layer_distance(look, 0, is_on); });
        ASSERT_TRUE(saved.save());
        EXPECT_EQ(saved.text().find("distance = {") != std::string::npos, is_on) << saved.text();
        EXPECT_TRUE(is_same(read_again(), saved.document().look())) << saved.text();
    }
    while (saved.has_undo()) saved.undo();
    ASSERT_TRUE(saved.save());
    EXPECT_EQ(saved.text(), saved.first());
}

// What others write is the text from then on: their comments stay, on every way through the steps.
TEST_F(DocumentHistory, WhatOthersWroteStaysOnEveryWay) {
    Saved saved(flat);
    ASSERT_TRUE(saved.is_open());
    const std::array words{std::bit_cast<std::uint32_t>(0.4f)};
    const auto glow = [&](Look& look) { return set_value(look, "bloom", "intensity", words); };
    saved.edit(glow);
    ASSERT_TRUE(saved.save());
    const fs::path file = saved.document().file();
    const std::string more = saved.text() + "# and this\n";
    std::ofstream(file, std::ios::binary) << more;
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(5));
    ASSERT_TRUE(saved.document().reload_if_changed());
    saved.undo();
    ASSERT_TRUE(saved.document().save());
    EXPECT_EQ(saved.text(), std::string(flat).replace(std::string(flat).find("0.20"), 4, "0.2") + "# and this\n");
}

TEST_F(DocumentHistory, LooksThatShipTakeThePlaceOfEachOtherAndAreSaved) {
    const fs::path looks = fs::path(darkroom::test::source_folder) / "looks";
    for (const char* const name : {"night.toml", "plain_bloom.toml", "visor.toml", "daze.toml"}) {
        const std::string text = text_of(looks / name);
        Saved own(text, name);
        ASSERT_TRUE(own.is_open()) << name;
        LookDocument& document = own.document();
        for (const fs::directory_entry& file : fs::directory_iterator(looks)) {
            if (file.path().extension() != ".toml") continue;
            const Result<> taken = document.edit("look", [&](Look& look) -> Result<> {
                DARKROOM_TRY_VALUE(Look read, read_look(file.path()));
                take_look(look, std::move(read), looks, document.options().folder);
                return {};
            });
            ASSERT_TRUE(taken) << name << ": " << taken.error().text;
            // It reads what it has written.
            const Result<> saved = document.save();
            EXPECT_TRUE(saved) << name << ", " << file.path() << ": " << saved.error().text;
            document.undo();
            ASSERT_TRUE(!saved || document.save());
            EXPECT_EQ(text_of(document.file()), text) << file.path();
        }
    }
}

}  // namespace
}  // namespace darkroom::edit
