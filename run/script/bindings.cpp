// SPDX-License-Identifier: MIT
#include "controllers_state.hpp"

#include <algorithm>

namespace darkroom::script {

namespace {

constexpr double longest_pre_roll = 86400;
constexpr std::size_t longest_name = 256, longest_commands = 1024, longest_print = 512;
// In instructions, by what they take.
constexpr std::uint64_t cost_of_reading = 50, cost_of_setting = 200, cost_of_printing = 200, cost_of_commands = 10000;

Host& host_of(lua_State* lua) { return *static_cast<Host*>(Sandbox::of(lua).host); }

std::string_view text_argument(lua_State* lua, int index, std::size_t longest) {
    std::size_t size = 0;
    const char* const text = luaL_checklstring(lua, index, &size);
    luaL_argcheck(lua, size <= longest, index, "the text is too long");
    return {text, size};
}

int cvar_get(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_reading);
    std::string_view text;
    double number = 0;
    host_of(lua).cvar_get(text_argument(lua, 1, longest_name), text, number);
    lua_pushlstring(lua, text.data(), text.size());
    return 1;
}

int cvar_get_number(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_reading);
    std::string_view text;
    double number = 0;
    host_of(lua).cvar_get(text_argument(lua, 1, longest_name), text, number);
    lua_pushnumber(lua, number);
    return 1;
}

int cvar_set(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_setting);
    const std::string_view name = text_argument(lua, 1, longest_name);
    if (lua_type(lua, 2) == LUA_TNUMBER)
        host_of(lua).cvar_set(name, lua_tonumber(lua, 2));
    else if (lua_isboolean(lua, 2))
        host_of(lua).cvar_set(name, lua_toboolean(lua, 2) != 0 ? "1" : "0");
    else
        host_of(lua).cvar_set(name, text_argument(lua, 2, longest_commands));
    return 0;
}

int exec(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_commands);
    host_of(lua).exec(text_argument(lua, 1, longest_commands));
    return 0;
}

int fire(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_setting);
    host_of(lua).fire(text_argument(lua, 1, longest_name));
    return 0;
}

int on_frame(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_setting);
    const std::string_view slot = text_argument(lua, 1, longest_name);
    luaL_checktype(lua, 2, LUA_TFUNCTION);
    lua_pushvalue(lua, 2);
    const int function = luaL_ref(lua, LUA_REGISTRYINDEX);
    if (host_of(lua).on_frame(slot, function)) return 0;
    luaL_unref(lua, LUA_REGISTRYINDEX, function);
    return luaL_error(lua, "on_frame: there are as many slots as are allowed, or the script was unloaded");
}

int pre_roll(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_reading);
    const lua_Number seconds = luaL_checknumber(lua, 1);
    luaL_argcheck(lua, seconds >= 0 && seconds <= longest_pre_roll, 1, "[0, 86400] seconds are allowed");
    if (host_of(lua).state_pre_roll(seconds)) return 0;
    return luaL_error(lua, "pre_roll: a script states it while it is loaded, not in a callback");
}

int set_class(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_setting);
    const std::string_view id = text_argument(lua, 1, longest_name), name = text_argument(lua, 2, longest_name);
    luaL_checktype(lua, 3, LUA_TBOOLEAN);
    lua_pushboolean(lua, host_of(lua).set_class(id, name, lua_toboolean(lua, 3) != 0) ? 1 : 0);
    return 1;
}

int time(lua_State* lua) {
    lua_pushnumber(lua, host_of(lua).time());
    return 1;
}

int hud_visible(lua_State* lua) {
    lua_pushboolean(lua, host_of(lua).is_hud_visible() ? 1 : 0);
    return 1;
}

int print(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_printing);
    std::array<char, longest_print> line{};
    std::size_t size = 0;
    for (int i = 1; i <= lua_gettop(lua) && size < line.size(); ++i) {
        std::size_t length = 0;
        hide_address(lua, i);
        const char* const text = luaL_tolstring(lua, -1, &length);
        if (i > 1) line[size++] = ' ';
        const std::size_t count = std::min(length, line.size() - size);
        std::copy_n(text, count, line.data() + size);
        size += count;
        lua_pop(lua, 2);
    }
    host_of(lua).print({line.data(), size});
    return 0;
}

int game_index(lua_State* lua) {
    // Other keys than strings are no fields; a conversion would change the key.
    if (lua_type(lua, 2) != LUA_TSTRING) return 0;
    std::size_t size = 0;
    const char* const name = lua_tolstring(lua, 2, &size);
    host_of(lua).push_game(lua, {name, size});
    return 1;
}

int game_newindex(lua_State* lua) { return luaL_error(lua, "attempt to write to read-only 'game' table"); }

int game_next(lua_State* lua) {
    Sandbox::of(lua).spend(cost_of_reading);
    std::size_t size = 0;
    const char* const before = lua_isnil(lua, 2) ? "" : luaL_checklstring(lua, 2, &size);
    const std::string_view name = host_of(lua).next_of_game({before, size});
    if (name.empty()) return 0;
    lua_pushlstring(lua, name.data(), name.size());
    host_of(lua).push_game(lua, {lua_tostring(lua, -1), name.size()});
    return 2;
}

int game_pairs(lua_State* lua) {
    lua_pushcfunction(lua, game_next);
    lua_pushvalue(lua, 1);
    return 2;
}

constexpr luaL_Reg engine_functions[] = {{"cvar_get", cvar_get}, {"cvar_get_number", cvar_get_number},
                                         {"cvar_set", cvar_set}, {"exec", exec},
                                         {"fire", fire},         {"on_frame", on_frame},
                                         {"time", time},         {"hud_visible", hud_visible},
                                         {"pre_roll", pre_roll}, {"set_class", set_class},
                                         {nullptr, nullptr}};
constexpr luaL_Reg game_functions[] = {
    {"__index", game_index}, {"__newindex", game_newindex}, {"__pairs", game_pairs}, {nullptr, nullptr}};

}  // namespace

void offer_bindings(Sandbox& sandbox, Host& host) {
    sandbox.host = &host;
    lua_State* const lua = sandbox.lua();
    luaL_newlib(lua, engine_functions);
    sandbox.offer("engine");
    lua_pushcfunction(lua, print);
    sandbox.offer("print");
    // No table, which rawset could write to.
    lua_newuserdatauv(lua, 0, 0);
    luaL_newlib(lua, game_functions);
    lua_setmetatable(lua, -2);
    sandbox.offer("game");
}

}  // namespace darkroom::script
