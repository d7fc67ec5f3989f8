// SPDX-License-Identifier: MIT
#pragma once
// What scripts may call beside Lua's own: `engine`, `game` and `print`. Between Lua and C++ lies an interface of plain
// values, so that no object with a destructor lives where Lua raises an error.

#include <array>
#include <cstddef>
#include <string_view>

#include "script/sandbox.hpp"

namespace darkroom::script {

/// What the bindings ask of whoever runs scripts. All functions answer at once and throw nothing; texts are good until
/// the next call.
class Host {
  public:
    virtual ~Host() = default;
    /// False: there is no such variable.
    virtual bool cvar_get(std::string_view name, std::string_view& text, double& number) noexcept = 0;
    virtual void cvar_set(std::string_view name, std::string_view value) noexcept = 0;
    virtual void cvar_set(std::string_view name, double value) noexcept = 0;
    virtual void exec(std::string_view commands) noexcept = 0;
    virtual void fire(std::string_view event) noexcept = 0;
    virtual void print(std::string_view text) noexcept = 0;
    /// Of the script that is being loaded. False: none is.
    virtual bool state_pre_roll(double seconds) noexcept = 0;
    /// Of an element of the interface's document. False: it has no such names.
    virtual bool set_class(std::string_view id, std::string_view name, bool is_on) noexcept = 0;
    /// `function`: a reference in the registry, which the host owns from now on. False: refused, and not taken.
    virtual bool on_frame(std::string_view slot, int function) noexcept = 0;
    [[nodiscard]] virtual double time() const noexcept = 0;
    [[nodiscard]] virtual bool is_hud_visible() const noexcept = 0;
    /// Pushes the field of the game, nil if there is none.
    virtual void push_game(lua_State* lua, std::string_view name) = 0;
    /// The name behind this one, in alphabetical order; nothing behind the last.
    [[nodiscard]] virtual std::string_view next_of_game(std::string_view name) const noexcept = 0;
};

/// Offers them to all scripts of the sandbox. In protected mode.
void offer_bindings(Sandbox& sandbox, Host& host);

}  // namespace darkroom::script
