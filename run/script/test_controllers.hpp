// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a stack, its console and controllers whose messages are kept. Not part of the library.

#include <gtest/gtest.h>

#include <bit>
#include <darkroom/controllers.hpp>
#include <string>
#include <vector>

#include "script/test_stack.hpp"

namespace darkroom::test {

struct ControllersBed : ConsoleBed {
    /// Without a limit to time: sanitizers take ten times as long.
    explicit ControllersBed(ControllersDesc desc = {.milliseconds_per_frame = 1e4}) {
        desc.print = [this](Severity, std::string_view text) {
            said.emplace_back(text);
            if (on_print) on_print(text);
        };
        auto created = Controllers::create(*console, std::move(desc));
        EXPECT_TRUE(created);
        controllers.emplace(std::move(*created));
    }
    /// Runs a script; its error, or nothing.
    std::string load(std::string_view text, const std::string& name = "test") {
        const auto done = controllers->load_text(name, text);
        return done ? std::string() : done.error().text;
    }
    void frame(double time = 0, bool is_hud_visible = true) {
        controllers->frame({.time = time, .is_hud_visible = is_hud_visible, .game = &game});
    }
    /// The value that the next record would use.
    [[nodiscard]] float now(const char* entry, std::size_t word = 0) const {
        return std::bit_cast<float>(composer.current(*composer.find(entry))[word]);
    }
    /// What a script's expression is, as text.
    std::string value(const std::string& expression) {
        said.clear();
        const std::string error = load("print(" + expression + ")", "value");
        return error.empty() ? said.empty() ? "" : said.back() : "error: " + error;
    }

    GameTable game;
    std::vector<std::string> said;
    std::function<void(std::string_view)> on_print;
    std::optional<Controllers> controllers;
};

}  // namespace darkroom::test
