// SPDX-License-Identifier: MIT
#pragma once
// A Lua state that scripts cannot get out of, with a budget of time and memory. It knows neither Composer nor game.
//
// Errors of Lua are longjmps: no function that calls Lua may hold an object with a destructor meanwhile. What is over
// budget raises an error at once, and then at every instruction, so that no pcall of a script keeps it alive. That
// error comes from a hook, during which no other hook runs: a handler in Lua would run unbounded, so scripts have no
// xpcall, and no metatables, whose __close would be called then.

#include <chrono>
#include <cstdint>
#include <darkroom/result.hpp>
#include <lua.hpp>
#include <memory>

namespace darkroom::script {

struct Allowance {
    std::int64_t instructions = 0;
    double milliseconds = 0;  ///< of CPU time
    bool has_reserve = true;  ///< of memory: where others have filled the state, some is left
};

class Sandbox {
  public:
    static constexpr std::size_t max_bytes = std::size_t{16} << 20, max_blocks = 16384;
    static constexpr std::size_t reserved_bytes = std::size_t{1} << 20, reserved_blocks = 1024;
    static constexpr std::size_t largest_block = std::size_t{256} << 10, longest_string = std::size_t{16} << 10;

    [[nodiscard]] static Result<std::unique_ptr<Sandbox>> create();
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;
    ~Sandbox();

    [[nodiscard]] lua_State* lua() const { return lua_; }
    [[nodiscard]] static Sandbox& of(lua_State* lua) { return **static_cast<Sandbox**>(lua_getextraspace(lua)); }

    /// What runs until end() has this to spend. Outside of that, nothing is bounded.
    void begin(const Allowance& allowance);
    /// Returns what is left.
    Allowance end();
    /// For functions in C whose work a script can scale: raises the error where it is too much.
    void spend(std::uint64_t instructions);
    /// In instructions: an element of a table is found behind all that collide with it, which the largest table bounds.
    [[nodiscard]] std::uint64_t cost_of_element() const;
    /// Frees what is garbage, if there is much. For between frames.
    void tidy();
    /// That its state holds.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Why the last call was stopped; null: it was not.
    [[nodiscard]] const char* why_stopped() const { return why_; }
    [[nodiscard]] bool is_short_of_memory() const { return is_short_; }

    /// Pushes a table with the functions that scripts may call, copies of their own; `_G` is the table itself.
    void push_environment();
    /// Adds the function or value on the top of the stack, which it pops, to all environments that come.
    void offer(const char* name);

    void* host = nullptr;  ///< for bindings

  private:
    Sandbox() = default;
    static void* allocate(void* self, void* block, std::size_t old_size, std::size_t size);
    static void hook(lua_State* lua, lua_Debug*);
    static int open(lua_State* lua);
    void stop(const char* why);
    void check_clock();
    [[nodiscard]] std::int64_t cost_of_filling(std::size_t size) const;

    lua_State* lua_ = nullptr;
    std::size_t node_bytes_ = 0;  ///< of a table's hash part
    std::size_t max_nodes_ = 0;   ///< of one of a script, so far
    std::size_t bytes_ = 0, blocks_ = 0, bytes_limit_ = 0, blocks_limit_ = 0;
    std::int64_t left_ = 0;
    double milliseconds_ = 0, cpu_start_ = 0;
    std::chrono::steady_clock::time_point deadline_;
    bool is_bounded_ = false, is_short_ = false;
    const char* why_ = nullptr;
};

/// Pushes the value at `index`, or the name of its type where its text would tell an address.
void hide_address(lua_State* lua, int index);

/// Of this thread.
[[nodiscard]] double cpu_milliseconds();

}  // namespace darkroom::script
