// SPDX-License-Identifier: MIT
#pragma once
// Controllers: scripts in Lua that move a stack's parameters with the game. What they set in a frame is an override
// under the name of their slot; base values stay what they are, and an unloaded script leaves nothing behind. Scripts
// are hostile until the opposite is shown: they reach no file and no process, and their time and memory are bounded.
//
//     auto controllers = darkroom::Controllers::create(console, {.print = print});
//     if (auto loaded = controllers->load("controllers/combat.lua"); !loaded) return report(loaded.error());
//     controllers->frame({.time = seconds, .is_hud_visible = !is_menu_open, .game = &game});   // every frame
//
// Part of the optional target Darkroom::script. docs/controllers.md has what scripts may call. Used by one thread at a
// time, that of the Composer.

#include <cstdint>
#include <darkroom/console.hpp>
#include <darkroom/game_table.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

struct ControllersDesc {
    LogSink print{};  ///< errors with their traceback, at most one a second for a slot; what scripts print
    /// Of one frame, all callbacks together; what C functions do counts, too. Who is over gets an error, and the next
    /// frame another chance.
    std::uint32_t instructions_per_frame = 100'000;
    /// CPU time of the same, for instructions that take longer than others.
    double milliseconds_per_frame = 2;
    bool allows_files = false;  ///< may `engine.exec` run files of the console's folder?
    /// Gives an element of the interface's document a class, or takes it away; false: it has no such names. None:
    /// `engine.set_class` is false.
    std::function<bool(std::string_view id, std::string_view name, bool is_on)> set_class{};
};

struct ControllerFrame {
    double time = 0;  ///< seconds
    bool is_hud_visible = true;
    const GameTable* game = nullptr;  ///< null: empty
};

class Controllers {
  public:
    /// The Console must outlive it.
    [[nodiscard]] static Result<Controllers> create(Console& console, ControllersDesc desc = {});
    Controllers(Controllers&&) noexcept;
    Controllers& operator=(Controllers&&) noexcept;
    /// Drops all overrides.
    ~Controllers();

    /// Runs a script, which registers callbacks. One that was loaded from there before is replaced, but not if the new
    /// one fails. Errors: it cannot be read, does not parse, or raises an error; files over 256 KiB.
    Result<> load(const std::filesystem::path& file);
    /// The same for a text, under a name.
    Result<> load_text(std::string name, std::string_view text);
    /// By file or name; also from within `print`, while callbacks run.
    void unload(std::string_view name);
    /// Loads those anew whose files have changed. What fails is printed, and stays as it was.
    void reload_changed();
    /// Loads all anew: after another look was applied, which took their overrides away.
    void restart();

    /// Calls every callback once, in the order in which their slots were registered first.
    void frame(const ControllerFrame& frame);

    [[nodiscard]] std::vector<std::string> slots() const;
    /// How far back what scripts do depends on frames before, in seconds, as they state it (engine.pre_roll): the
    /// largest of all. Nothing: one does not say, and may depend on all. A run that begins in the middle calls frame()
    /// for those frames first, without pictures.
    [[nodiscard]] std::optional<double> pre_roll() const;
    /// How often a callback has set a variable. Without news of the game a good controller sets none.
    [[nodiscard]] std::uint64_t writes() const;
    /// Memory that scripts hold, at most 16 MiB.
    [[nodiscard]] std::size_t bytes() const;
    /// CPU time of the last frame().
    [[nodiscard]] double microseconds() const;

    struct State;

  private:
    explicit Controllers(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
