// SPDX-License-Identifier: MIT
#include "script/sandbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string_view>

namespace darkroom::script {

namespace {

constexpr int hook_interval = 50;
constexpr std::size_t bytes_of_an_instruction = 64;  // that are copied in the time of one, roughly
constexpr const char *over_instructions = "over its budget of instructions", *over_time = "over its budget of time",
                     *over_memory = "over its budget of memory",
                     *over_block = "a table, a string or the stack is too large";
constexpr const char* environment_key = "darkroom environment";

std::uint64_t sizes_of_arguments(lua_State* lua) {
    std::uint64_t sum = 0;
    for (int i = 1; i <= lua_gettop(lua); ++i) sum += lua_rawlen(lua, i);
    return sum;
}

/// The number of elements in [first, last], as optional arguments at `index` and behind it.
std::uint64_t span_of_arguments(lua_State* lua, int index, lua_Integer last_default) {
    const lua_Integer first = luaL_optinteger(lua, index, 1), last = luaL_optinteger(lua, index + 1, last_default);
    return last < first ? 0 : static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first) + 1;
}

// What a call costs in instructions, by its arguments. Only for functions whose work these bound.
std::uint64_t cost_of_sizes(lua_State* lua) { return sizes_of_arguments(lua) / 8; }
/// Of so many elements of tables, each looked up where other keys may collide with it.
std::uint64_t cost_of_elements(lua_State* lua, std::uint64_t count) {
    return count * Sandbox::of(lua).cost_of_element();
}
std::uint64_t cost_of_shifting(lua_State* lua) { return cost_of_elements(lua, sizes_of_arguments(lua) / 8); }
std::uint64_t cost_of_sort(lua_State* lua) { return cost_of_elements(lua, lua_rawlen(lua, 1) * 32); }
std::uint64_t cost_of_move(lua_State* lua) { return cost_of_elements(lua, span_of_arguments(lua, 2, 0)); }
std::uint64_t cost_of_concat(lua_State* lua) {
    luaL_checktype(lua, 1, LUA_TTABLE);
    return cost_of_elements(lua, span_of_arguments(lua, 3, static_cast<lua_Integer>(lua_rawlen(lua, 1))));
}
std::uint64_t cost_of_unpack(lua_State* lua) {
    luaL_checktype(lua, 1, LUA_TTABLE);
    const std::uint64_t count = span_of_arguments(lua, 2, static_cast<lua_Integer>(lua_rawlen(lua, 1)));
    return count <= 256 ? cost_of_elements(lua, count)
                        : static_cast<std::uint64_t>(luaL_error(lua, "unpack: allowed are at most 256 values"));
}
std::uint64_t cost_of_rep(lua_State* lua) {
    std::size_t size = 0, separator = 0;
    luaL_checklstring(lua, 1, &size);
    luaL_optlstring(lua, 3, "", &separator);
    const auto count = static_cast<std::uint64_t>(std::max<lua_Integer>(luaL_checkinteger(lua, 2), 0));
    const std::uint64_t step = std::max<std::uint64_t>(size + separator, 1);
    if (count > Sandbox::longest_string / step)
        luaL_error(lua, "rep: allowed are at most %d bytes", static_cast<int>(Sandbox::longest_string));
    return count * step / 8;
}

// Texts of what has an address, by which a script would learn where the program lies: the type's name stands for them.
void hide_addresses(lua_State* lua, int first) {
    for (int i = first; i <= lua_gettop(lua); ++i) {
        const int type = lua_type(lua, i);
        if (type < LUA_TTABLE && type != LUA_TLIGHTUSERDATA) continue;
        lua_pushstring(lua, lua_typename(lua, type));
        lua_replace(lua, i);
    }
}
std::uint64_t cost_of_tostring(lua_State* lua) {
    hide_addresses(lua, 1);
    return 0;
}
std::uint64_t cost_of_format(lua_State* lua) {
    const std::uint64_t cost = cost_of_sizes(lua);
    hide_addresses(lua, 2);
    std::size_t size = 0;
    const char* const text = luaL_checklstring(lua, 1, &size);
    const std::string_view format(text, size);
    // Flags, a width and a precision may stand between the two characters.
    for (std::size_t at = format.find('%'); at != std::string_view::npos; at = format.find('%', at + 1)) {
        at = std::min(format.find_first_not_of("-+ #0123456789.", at + 1), format.size() - 1);
        if (format[at] == 'p') luaL_error(lua, "format: '%%p' is not allowed");
    }
    return cost;
}

struct Offered {
    const char* name;
    std::uint64_t (*cost)(lua_State*) = nullptr;
};
// What is not here is not there: find, match, gmatch and gsub may take exponential time, load and coroutines would need
// budgets of their own.
constexpr Offered base_functions[] = {{"assert"},
                                      {"error"},
                                      {"ipairs"},
                                      {"next"},
                                      {"pairs"},
                                      {"pcall"},
                                      {"rawequal"},
                                      {"rawget"},
                                      {"rawlen"},
                                      {"rawset"},
                                      {"select"},
                                      {"tonumber"},
                                      {"tostring", cost_of_tostring},
                                      {"type"}};
constexpr Offered math_functions[] = {
    {"abs"},  {"acos"},      {"asin"}, {"atan"}, {"ceil"}, {"cos"},        {"deg"},        {"exp"}, {"floor"},
    {"fmod"}, {"log"},       {"max"},  {"min"},  {"modf"}, {"rad"},        {"random"},     {"sin"}, {"sqrt"},
    {"tan"},  {"tointeger"}, {"type"}, {"ult"},  {"huge"}, {"maxinteger"}, {"mininteger"}, {"pi"}};
constexpr Offered string_functions[] = {
    {"byte", cost_of_sizes},  {"char", cost_of_sizes}, {"format", cost_of_format}, {"len"},
    {"lower", cost_of_sizes}, {"rep", cost_of_rep},    {"reverse", cost_of_sizes}, {"sub", cost_of_sizes},
    {"upper", cost_of_sizes}};
constexpr Offered table_functions[] = {
    {"concat", cost_of_concat},   {"insert", cost_of_shifting}, {"move", cost_of_move},    {"pack"},
    {"remove", cost_of_shifting}, {"sort", cost_of_sort},       {"unpack", cost_of_unpack}};

/// Upvalues: the real function, and what it costs.
int call_bounded(lua_State* lua) {
    const auto cost = reinterpret_cast<std::uint64_t (*)(lua_State*)>(lua_touserdata(lua, lua_upvalueindex(2)));
    Sandbox::of(lua).spend(cost(lua));
    return lua_tocfunction(lua, lua_upvalueindex(1))(lua);
}

/// Copies what the table at `from` holds into the one on the top of the stack.
void copy_entries(lua_State* lua, int from) {
    const int to = lua_gettop(lua), source = lua_absindex(lua, from);
    lua_pushnil(lua);
    while (lua_next(lua, source) != 0) {
        lua_pushvalue(lua, -2);
        lua_insert(lua, -2);
        lua_rawset(lua, to);
    }
}

/// Opens a library and copies `functions` of it into the table on the top of the stack.
void copy_library(lua_State* lua, lua_CFunction opens, std::span<const Offered> functions) {
    lua_pushcfunction(lua, opens);
    lua_call(lua, 0, 1);
    // The same random numbers in every run.
    if (lua_getfield(lua, -1, "randomseed") == LUA_TFUNCTION) {
        lua_pushinteger(lua, 1);
        lua_call(lua, 1, 0);
    } else {
        lua_pop(lua, 1);
    }
    for (const Offered& function : functions) {
        lua_getfield(lua, -1, function.name);
        if (function.cost != nullptr) {
            lua_pushlightuserdata(lua, reinterpret_cast<void*>(function.cost));
            lua_pushcclosure(lua, call_bounded, 2);
        }
        lua_setfield(lua, -3, function.name);
    }
    lua_pop(lua, 1);
}

void offer_library(lua_State* lua, const char* name, lua_CFunction opens, std::span<const Offered> functions) {
    lua_newtable(lua);
    copy_library(lua, opens, functions);
    lua_setfield(lua, -2, name);
}

}  // namespace

void hide_address(lua_State* lua, int index) {
    lua_pushvalue(lua, index);
    hide_addresses(lua, lua_gettop(lua));
}

double cpu_milliseconds() {
    std::timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

// Never fails short of what one instruction can ask for: an allocation that fails makes Lua collect all garbage at
// once. Instead the next instruction is the last.
void* Sandbox::allocate(void* self, void* block, std::size_t old_size, std::size_t size) {
    Sandbox& sandbox = *static_cast<Sandbox*>(self);
    const bool is_string = block == nullptr && old_size == LUA_TSTRING;
    const std::size_t before = block == nullptr ? 0 : old_size;
    if (size == 0) {
        std::free(block);
        sandbox.bytes_ -= before;
        sandbox.blocks_ -= block == nullptr ? 0 : 1;
        return nullptr;
    }
    if (sandbox.is_bounded_ && size > before) {
        const bool is_large = size > largest_block || (is_string && size > longest_string + 64);
        if (is_large || sandbox.bytes_ - before + size > max_bytes) {
            sandbox.stop(is_large ? over_block : over_memory);
            return nullptr;
        }
        const std::int64_t cost = block == nullptr && old_size == 0 ? sandbox.cost_of_filling(size) : 0;
        if (cost > sandbox.left_) {
            sandbox.stop(over_instructions);
            return nullptr;
        }
        sandbox.left_ -= cost;
        if (cost > 0) sandbox.max_nodes_ = std::max(sandbox.max_nodes_, size / sandbox.node_bytes_);
    }
    void* const out = std::realloc(block, size);
    if (out == nullptr) return nullptr;
    sandbox.bytes_ += size - before;
    sandbox.blocks_ += block == nullptr ? 1 : 0;
    if (sandbox.is_bounded_ && size > before) {
        sandbox.left_ -= static_cast<std::int64_t>((size - before) / bytes_of_an_instruction);
        if (sandbox.left_ < 0) sandbox.stop(over_instructions);
        if (sandbox.bytes_ > sandbox.bytes_limit_ || sandbox.blocks_ > sandbox.blocks_limit_) {
            sandbox.is_short_ = true;
            sandbox.stop(over_memory);
        }
    }
    return out;
}

std::uint64_t Sandbox::cost_of_element() const { return std::max<std::uint64_t>(max_nodes_ / 32, 1); }

// A table that is full is filled anew, key by key, into a block of new nodes, before the next instruction. Keys may be
// chosen so that all collide, and then it takes the square of their number, at some 2 ns each.
std::int64_t Sandbox::cost_of_filling(std::size_t size) const {
    const std::size_t nodes = node_bytes_ == 0 ? 0 : size / node_bytes_;
    return nodes * node_bytes_ == size && std::has_single_bit(nodes) ? static_cast<std::int64_t>(nodes * nodes / 32)
                                                                     : 0;
}

void Sandbox::stop(const char* why) {
    if (why_ != nullptr) return;
    why_ = why;
    lua_sethook(lua_, hook, LUA_MASKCOUNT, 1);
}

// CPU time is asked for only where wall time is over: that takes longer.
void Sandbox::check_clock() {
    const auto now = std::chrono::steady_clock::now();
    if (now < deadline_) return;
    const double left = milliseconds_ - (cpu_milliseconds() - cpu_start_);
    if (left <= 0) return stop(over_time);
    deadline_ = now + std::chrono::nanoseconds(static_cast<std::int64_t>(left * 1e6) + 1);
}

void Sandbox::hook(lua_State* lua, lua_Debug*) {
    Sandbox& sandbox = of(lua);
    if (sandbox.why_ == nullptr) {
        sandbox.left_ -= hook_interval;
        if (sandbox.left_ < 0) sandbox.stop(over_instructions);
        sandbox.check_clock();
    }
    if (sandbox.why_ == nullptr) return;
    luaL_where(lua, 0);
    lua_pushstring(lua, sandbox.why_);
    lua_concat(lua, 2);
    lua_error(lua);
}

void Sandbox::spend(std::uint64_t instructions) {
    if (!is_bounded_) return;
    const bool is_over = left_ < 0 || instructions > static_cast<std::uint64_t>(left_);
    left_ -= is_over ? 0 : static_cast<std::int64_t>(instructions);
    if (is_over) stop(over_instructions);
    check_clock();
    if (why_ != nullptr) luaL_error(lua_, "%s", why_);
}

void Sandbox::begin(const Allowance& allowance) {
    left_ = allowance.instructions;
    milliseconds_ = allowance.milliseconds;
    cpu_start_ = cpu_milliseconds();
    deadline_ =
        std::chrono::steady_clock::now() + std::chrono::nanoseconds(static_cast<std::int64_t>(milliseconds_ * 1e6));
    why_ = nullptr;
    is_short_ = false;
    // Who fills the state stops short of the reserve. Those that come to a full one may each take a little of it.
    const std::size_t bytes = max_bytes - 4 * largest_block, blocks = max_blocks;
    const bool is_full = bytes_ + reserved_bytes * 3 / 2 > bytes || blocks_ + reserved_blocks * 3 / 2 > blocks;
    const bool takes_reserve = allowance.has_reserve && is_full;
    bytes_limit_ = takes_reserve ? std::min(bytes, bytes_ + reserved_bytes / 4) : bytes - reserved_bytes;
    blocks_limit_ = takes_reserve ? std::min(blocks, blocks_ + reserved_blocks / 4) : blocks - reserved_blocks;
    is_bounded_ = true;
    lua_sethook(lua_, hook, LUA_MASKCOUNT, hook_interval);
}

Allowance Sandbox::end() {
    is_bounded_ = false;
    lua_sethook(lua_, nullptr, 0, 0);
    return {std::max<std::int64_t>(left_, 0), std::max(milliseconds_ - (cpu_milliseconds() - cpu_start_), 0.0)};
}

void Sandbox::tidy() {
    if (bytes_ > max_bytes / 2 || blocks_ > max_blocks / 2) lua_gc(lua_, LUA_GCCOLLECT);
}

int Sandbox::open(lua_State* lua) {
    luaL_checkstack(lua, 32, nullptr);
    lua_newtable(lua);
    copy_library(lua, luaopen_base, base_functions);
    offer_library(lua, "math", luaopen_math, math_functions);
    offer_library(lua, "string", luaopen_string, string_functions);
    offer_library(lua, "table", luaopen_table, table_functions);
    // Methods of strings are those that are offered, in a table that no script can reach.
    lua_pushliteral(lua, "");
    lua_getmetatable(lua, -1);
    lua_newtable(lua);
    lua_getfield(lua, -4, "string");
    lua_insert(lua, -2);
    copy_entries(lua, -2);
    lua_setfield(lua, -3, "__index");
    lua_pop(lua, 3);
    lua_setfield(lua, LUA_REGISTRYINDEX, environment_key);
    // No global table: a script's is its own.
    lua_newtable(lua);
    lua_rawseti(lua, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_gc(lua, LUA_GCINC, 120, 200, 12);
    return 0;
}

Result<std::unique_ptr<Sandbox>> Sandbox::create() {
    std::unique_ptr<Sandbox> sandbox(new Sandbox);
    sandbox->lua_ = lua_newstate(allocate, sandbox.get());
    if (sandbox->lua_ == nullptr) return machine_error("no memory for a state of Lua");
    *static_cast<Sandbox**>(lua_getextraspace(sandbox->lua_)) = sandbox.get();
    lua_pushcfunction(sandbox->lua_, open);
    if (lua_pcall(sandbox->lua_, 0, 0, 0) != LUA_OK)
        return machine_error(fmt::format("opening the libraries of Lua: {}", lua_tostring(sandbox->lua_, -1)));
    // What a node takes is not said by Lua's headers: a table of 1024 is that and itself more than one of none.
    const auto bytes_of_table = [&](int nodes) {
        const std::size_t before = sandbox->bytes_;
        lua_createtable(sandbox->lua_, 0, nodes);
        const std::size_t bytes = sandbox->bytes_ - before;
        lua_pop(sandbox->lua_, 1);
        return bytes;
    };
    lua_gc(sandbox->lua_, LUA_GCSTOP);
    sandbox->node_bytes_ = (bytes_of_table(1024) - bytes_of_table(0)) / 1024;
    lua_gc(sandbox->lua_, LUA_GCRESTART);
    return sandbox;
}

Sandbox::~Sandbox() {
    if (lua_ != nullptr) lua_close(lua_);
}

void Sandbox::push_environment() {
    lua_getfield(lua_, LUA_REGISTRYINDEX, environment_key);
    const int offered = lua_gettop(lua_);
    lua_newtable(lua_);
    copy_entries(lua_, offered);
    lua_pushnil(lua_);
    while (lua_next(lua_, offered) != 0) {
        if (lua_istable(lua_, -1)) {
            lua_pushvalue(lua_, -2);
            lua_newtable(lua_);
            copy_entries(lua_, -3);
            lua_rawset(lua_, offered + 1);
        }
        lua_pop(lua_, 1);
    }
    lua_pushvalue(lua_, -1);
    lua_setfield(lua_, -2, "_G");
    lua_remove(lua_, offered);
}

void Sandbox::offer(const char* name) {
    lua_getfield(lua_, LUA_REGISTRYINDEX, environment_key);
    lua_insert(lua_, -2);
    lua_setfield(lua_, -2, name);
    lua_pop(lua_, 1);
}

}  // namespace darkroom::script
