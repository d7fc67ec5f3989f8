// SPDX-License-Identifier: MIT
// What scripts ask Controllers for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text/param_text.hpp"
#include "script/controllers_state.hpp"

namespace darkroom {

bool RateLimit::allows(double now) {
    if (!(now - since_ < 1 && now >= since_)) {
        since_ = now;
        count_ = 0;
    }
    const bool is_allowed = count_ < most_;
    count_ += is_allowed ? 1 : 0;
    refused_ += is_allowed ? 0 : 1;
    return is_allowed;
}

bool Controllers::State::Script::look() {
    const FileStamp now = stamp_of(name);
    const bool is_changed = now != stamp;
    stamp = now;
    return is_changed;
}

void Controllers::State::remark(Severity severity, std::string_view text) {
    if (!remarks.allows(frame.time)) return;
    if (const std::uint64_t refused = remarks.take_refused(); refused > 0)
        desc.print(Severity::Warning, fmt::format("{} more messages of scripts were left out", refused));
    desc.print(severity, text);
}

bool Controllers::State::cvar_get(std::string_view name, std::string_view& text, double& number) noexcept try {
    const auto found = console->get(name);
    if (!found) return false;
    reply = *found;
    text = reply;
    number = parse_number(reply).value_or(0);
    return true;
} catch (...) {
    return false;
}

void Controllers::State::cvar_set(std::string_view name, std::string_view value) noexcept try {
    if (!console->has(name)) return remark(Severity::Warning, fmt::format("variable {} not found", printable(name)));
    writes += owner.empty() ? 0 : 1;
    const auto set = owner.empty() ? console->set(name, value) : console->set_override(name, owner, value);
    if (!set) remark(Severity::Warning, set.error().text);
    if (set && !set->empty()) remark(Severity::Warning, *set);
} catch (...) {
    lose();
}

void Controllers::State::cvar_set(std::string_view name, double value) noexcept try {
    cvar_set(name, fmt::format("{}", value));
} catch (...) {
    lose();
}

void Controllers::State::exec(std::string_view commands) noexcept try {
    console->execute(commands, {.allows_files = desc.allows_files,
                                .suggests = false,
                                .print = [this](Severity severity, std::string_view line) { remark(severity, line); },
                                .max_commands = max_commands});
} catch (...) {
    lose();
}

bool Controllers::State::state_pre_roll(double seconds) noexcept {
    if (loading == nullptr) return false;
    stated_pre_roll = seconds;
    return true;
}

bool Controllers::State::set_class(std::string_view id, std::string_view name, bool is_on) noexcept try {
    return desc.set_class && desc.set_class(id, name, is_on);
} catch (...) {
    return false;
}

void Controllers::State::print(std::string_view text) noexcept try {
    remark(Severity::Info, printable(text));
} catch (...) {
    lose();
}

// An exception may not go through Lua, which is C.
void Controllers::State::lose() const { desc.print(Severity::Error, "scripts: out of memory"); }

bool Controllers::State::on_frame(std::string_view slot_name, int function) noexcept try {
    const auto is_same = [&](const Slot& slot) { return slot.name == slot_name; };
    const bool is_new = std::ranges::none_of(slots, is_same) && std::ranges::none_of(pending, is_same);
    if (is_new && slots.size() + pending.size() >= max_slots) return false;
    Slot slot{.name = std::string(slot_name), .function = function};
    if (loading != nullptr) {
        slot.script = *loading;
        pending.push_back(std::move(slot));
        return true;
    }
    // A callback registers for the script that it is of.
    const auto running = std::ranges::find_if(slots, [&](const Slot& other) { return other.owner == owner; });
    if (running == slots.end() || running->is_dead) return false;
    slot.script = running->script;
    add_slot(std::move(slot));
    return true;
} catch (...) {
    return false;
}

void Controllers::State::push_game(lua_State* lua, std::string_view name) {
    const GameValue* value = nullptr;
    if (frame.game != nullptr)
        if (const auto found = frame.game->find(name); found != frame.game->end()) value = &found->second;
    if (value == nullptr) return lua_pushnil(lua);
    if (const bool* const is_true = std::get_if<bool>(value)) return lua_pushboolean(lua, *is_true ? 1 : 0);
    if (const double* const number = std::get_if<double>(value)) return lua_pushnumber(lua, *number);
    const std::string& text = std::get<std::string>(*value);
    lua_pushlstring(lua, text.data(), text.size());
}

std::string_view Controllers::State::next_of_game(std::string_view name) const noexcept {
    if (frame.game == nullptr) return {};
    const auto found = frame.game->upper_bound(name);
    return found == frame.game->end() ? std::string_view() : found->first;
}

}  // namespace darkroom
