// SPDX-License-Identifier: MIT
// Scripts come and go, and their callbacks run. What they ask for is in controllers_host.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/caught.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "script/controllers_state.hpp"

namespace darkroom {

namespace fs = std::filesystem;

namespace {

/// To load a script may take as much as so many frames.
constexpr std::uint32_t frames_to_load = 20;
constexpr int max_trace_levels = 10, max_trace_lines = 30;

// The functions that Lua calls hold no objects with destructors: see sandbox.hpp.
// The innermost levels alone; luaL_traceback, which tells the outermost, too, walks a deep stack many times. Lines
// become one at once: a function of Lua's may push LUA_MINSTACK values, and nothing checks that it does not push more.
int trace(lua_State* lua) {
    const char* text = lua_tostring(lua, 1);
    if (text == nullptr) text = lua_pushfstring(lua, "the error is a %s", luaL_typename(lua, 1));
    const int first = lua_gettop(lua);
    lua_pushfstring(lua, "%s\nstack traceback:", text);
    lua_Debug level{};
    for (int i = 1; i <= max_trace_levels && lua_getstack(lua, i, &level) != 0; ++i) {
        lua_getinfo(lua, "Sln", &level);
        lua_pushfstring(lua, "\n    %s:", level.short_src);
        if (level.currentline > 0) lua_pushfstring(lua, "%d:", level.currentline);
        lua_pushfstring(lua, level.name == nullptr ? " in function" : " in function '%s'", level.name);
        lua_concat(lua, lua_gettop(lua) - first);
    }
    return 1;
}

struct Chunk {
    script::Sandbox* sandbox;
    const char *text, *name;
    std::size_t size;
};

int run_chunk(lua_State* lua) {
    const Chunk& chunk = *static_cast<const Chunk*>(lua_touserdata(lua, 1));
    if (luaL_loadbufferx(lua, chunk.text, chunk.size, chunk.name, "t") != LUA_OK) return lua_error(lua);
    chunk.sandbox->push_environment();
    lua_setupvalue(lua, -2, 1);
    lua_call(lua, 0, 0);
    return 0;
}

int offer_all(lua_State* lua) {
    script::Sandbox& sandbox = script::Sandbox::of(lua);
    script::offer_bindings(sandbox, *static_cast<script::Host*>(lua_touserdata(lua, 1)));
    return 0;
}

}  // namespace

Controllers::State::~State() {
    for (const Slot& slot : slots) console->composer().drop_overrides(slot.owner);
}

std::optional<std::string> Controllers::State::call(int arguments, script::Allowance& allowance) {
    lua_State* const lua = sandbox->lua();
    const int handler = lua_gettop(lua) - arguments - 1;
    sandbox->begin(allowance);
    const int status = lua_pcall(lua, arguments, 0, handler);
    allowance = sandbox->end();
    std::optional<std::string> out;
    if (status != LUA_OK) try {
            const char* const text = status == LUA_ERRRUN ? lua_tostring(lua, -1) : sandbox->why_stopped();
            out.emplace();
            std::string_view rest = text == nullptr ? "not enough memory" : text;
            for (int line = 0; line < max_trace_lines && !rest.empty(); ++line) {
                const std::size_t end = std::min(rest.find('\n'), rest.size());
                out->append(out->empty() ? "" : "\n").append(printable(rest.substr(0, end)));
                rest.remove_prefix(std::min(end + 1, rest.size()));
            }
        } catch (...) {
            out = "out of memory";  // no longer than a string holds in place
        }
    lua_settop(lua, handler - 1);
    return out;
}

Result<> Controllers::State::run_text(const std::string& name, std::string_view text) {
    if (is_running) return user_error(fmt::format("{}: scripts are not loaded while others run", printable(name)));
    if (text.size() > longest_text)
        return user_error(
            fmt::format("{}: {} bytes, allowed are at most {}", printable(name), text.size(), longest_text));
    const std::string chunk_name = "@" + name;
    Chunk chunk{sandbox.get(), text.data(), chunk_name.c_str(), text.size()};
    script::Allowance allowance{std::int64_t{desc.instructions_per_frame} * frames_to_load,
                                desc.milliseconds_per_frame * frames_to_load};
    lua_State* const lua = sandbox->lua();
    lua_pushcfunction(lua, trace);
    lua_pushcfunction(lua, run_chunk);
    lua_pushlightuserdata(lua, &chunk);
    pending.clear();
    is_running = true;
    loading = &name;
    stated_pre_roll.reset();
    const std::optional<std::string> error = call(1, allowance);
    loading = nullptr;
    is_running = false;
    if (error) {
        for (const Slot& slot : pending) luaL_unref(lua, LUA_REGISTRYINDEX, slot.function);
    } else {
        // What the script before registered, and this one does not, goes.
        for (Slot& slot : slots) slot.is_dead = slot.is_dead || slot.script == name;
        for (Slot& slot : pending) add_slot(std::move(slot));
    }
    pending.clear();
    free_dead_slots();
    sandbox->tidy();
    if (!error) return {};
    const std::string line = error->substr(0, error->find('\n'));
    return user_error(line.starts_with(name) ? line : fmt::format("{}: {}", printable(name), line));
}

Result<> Controllers::State::run_file(const std::string& name) {
    DARKROOM_TRY_VALUE(const auto content, read_file(name, {.max_size = longest_text}));
    return run_text(name, {reinterpret_cast<const char*>(content.data()), content.size()});
}

Result<> Controllers::State::run(Script& script) {
    auto done = script.is_file ? run_file(script.name) : run_text(script.name, script.text);
    if (done) script.pre_roll = stated_pre_roll;
    return done;
}

void Controllers::State::run_again(bool (*is_meant)(Script&)) try {
    if (is_running) return;
    for (Script script : std::vector(scripts)) {
        if (!is_meant(script)) continue;
        const auto done = run(script);
        if (!done) desc.print(Severity::Error, done.error().text);
        keep(std::move(script));
    }
} catch (...) {
    lose();
}

void Controllers::State::keep(Script script) {
    const auto same = std::ranges::find(scripts, script.name, &Script::name);
    if (same == scripts.end())
        scripts.push_back(std::move(script));
    else
        *same = std::move(script);
}

void Controllers::State::add_slot(Slot slot) {
    console->composer().drop_overrides(slot.owner);
    const auto same = std::ranges::find(slots, slot.name, &Slot::name);
    if (same == slots.end()) return slots.push_back(std::move(slot));
    luaL_unref(sandbox->lua(), LUA_REGISTRYINDEX, same->function);
    *same = std::move(slot);
}

void Controllers::State::free_dead_slots() {
    for (const Slot& slot : slots) {
        if (!slot.is_dead) continue;
        luaL_unref(sandbox->lua(), LUA_REGISTRYINDEX, slot.function);
        console->composer().drop_overrides(slot.owner);
    }
    std::erase_if(slots, [](const Slot& slot) { return slot.is_dead; });
}

// Each may take its share of what is left, so one that never ends leaves time to those behind it.
void Controllers::State::run_slot(std::size_t index, script::Allowance& left, std::size_t slots_left) {
    const auto count = static_cast<std::int64_t>(slots_left);
    const script::Allowance share{left.instructions / count, left.milliseconds / static_cast<double>(count),
                                  slots[index].has_reserve};
    script::Allowance unused = share;
    owner = slots[index].owner;
    lua_pushcfunction(sandbox->lua(), trace);
    lua_rawgeti(sandbox->lua(), LUA_REGISTRYINDEX, slots[index].function);
    const std::optional<std::string> error = call(0, unused);
    owner.clear();
    left.instructions -= share.instructions - unused.instructions;
    left.milliseconds -= share.milliseconds - unused.milliseconds;
    Slot& slot = slots[index];
    slot.has_reserve = slot.has_reserve && !sandbox->is_short_of_memory();
    if (!error || !slot.errors.allows(frame.time)) return;
    const std::uint64_t refused = slot.errors.take_refused();
    desc.print(Severity::Error, fmt::format("slot '{}': {}{}", printable(slot.name), *error,
                                            refused > 0 ? fmt::format("\n({} more since the last)", refused) : ""));
}

Controllers::Controllers(std::unique_ptr<State> state) : state_(std::move(state)) {}
Controllers::Controllers(Controllers&&) noexcept = default;
Controllers& Controllers::operator=(Controllers&&) noexcept = default;
Controllers::~Controllers() = default;

Result<Controllers> Controllers::create(Console& console, ControllersDesc desc) try {
    auto state = std::make_unique<State>();
    state->console = &console;
    state->desc = std::move(desc);
    if (!state->desc.print) state->desc.print = [](Severity, std::string_view) {};
    DARKROOM_TRY_VALUE(auto sandbox, script::Sandbox::create());
    lua_State* const lua = sandbox->lua();
    lua_pushcfunction(lua, offer_all);
    lua_pushlightuserdata(lua, static_cast<script::Host*>(state.get()));
    if (lua_pcall(lua, 1, 0, 0) != LUA_OK) return machine_error("no memory for what scripts may call");
    state->sandbox = std::move(sandbox);
    return Controllers(std::move(state));
} catch (...) {
    return caught("scripts");
}

Result<> Controllers::load(const fs::path& file) try {
    State::Script script{.name = file.string(), .is_file = true};
    script.look();
    auto done = state_->run(script);
    if (done) state_->keep(std::move(script));
    return done;
} catch (...) {
    return caught("load");
}

Result<> Controllers::load_text(std::string name, std::string_view text) try {
    State::Script script{.name = std::move(name), .text = std::string(text)};
    auto done = state_->run(script);
    if (done) state_->keep(std::move(script));
    return done;
} catch (...) {
    return caught("load_text");
}

void Controllers::unload(std::string_view name) {
    std::erase_if(state_->scripts, [&](const State::Script& script) { return script.name == name; });
    for (State::Slot& slot : state_->slots) slot.is_dead = slot.is_dead || slot.script == name;
    if (!state_->is_running) state_->free_dead_slots();
}

void Controllers::reload_changed() {
    state_->run_again([](State::Script& script) { return script.is_file && script.look(); });
}

void Controllers::restart() {
    state_->run_again([](State::Script&) { return true; });
}

void Controllers::frame(const ControllerFrame& frame) {
    State& state = *state_;
    if (state.is_running) return;
    const double start = script::cpu_milliseconds();
    state.is_running = true;
    state.frame = frame;
    script::Allowance left{state.desc.instructions_per_frame, state.desc.milliseconds_per_frame};
    const std::size_t count = state.slots.size();  // what is registered now runs from the next frame on
    for (std::size_t i = 0; i < count; ++i) try {
            if (!state.slots[i].is_dead) state.run_slot(i, left, count - i);
        } catch (...) {
            state.lose();
        }
    state.frame.game = nullptr;
    state.is_running = false;
    state.free_dead_slots();
    state.sandbox->tidy();
    state.microseconds = (script::cpu_milliseconds() - start) * 1e3;
}

std::vector<std::string> Controllers::slots() const {
    std::vector<std::string> out;
    for (const State::Slot& slot : state_->slots) out.push_back(slot.name);
    return out;
}

std::optional<double> Controllers::pre_roll() const {
    double most = 0;
    for (const State::Script& script : state_->scripts) {
        if (!script.pre_roll) return std::nullopt;
        most = std::max(most, *script.pre_roll);
    }
    return most;
}

std::size_t Controllers::bytes() const { return state_->sandbox->bytes(); }
std::uint64_t Controllers::writes() const { return state_->writes; }
double Controllers::microseconds() const { return state_->microseconds; }

}  // namespace darkroom
