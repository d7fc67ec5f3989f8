// SPDX-License-Identifier: MIT
#pragma once
// What Controllers are made of, for controllers.cpp (scripts come and go, callbacks run) and controllers_host.cpp (what
// scripts ask for).

#include <array>
#include <cstddef>
#include <darkroom/controllers.hpp>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/files.hpp"
#include "script/sandbox.hpp"

namespace darkroom {

namespace script {

// What scripts may call beside Lua's own: `engine`, `game` and `print`. Between Lua and C++ lies an interface of plain
// values, so that no object with a destructor lives where Lua raises an error.

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

}  // namespace script

/// At most so many in a second, by a clock that may stand still or jump.
class RateLimit {
  public:
    explicit RateLimit(std::uint32_t most) : most_(most) {}
    /// Counts what it refuses.
    [[nodiscard]] bool allows(double now);
    /// How many were refused since the last call.
    [[nodiscard]] std::uint64_t take_refused() { return std::exchange(refused_, 0); }

  private:
    std::uint32_t most_, count_ = 0;
    std::uint64_t refused_ = 0;
    double since_ = -std::numeric_limits<double>::infinity();
};

struct Controllers::State final : script::Host {
    struct Script {
        std::string name;  ///< a file's path as it was given
        bool is_file = false;
        std::string text{};  ///< of scripts without a file
        std::optional<double> pre_roll{};
        FileStamp stamp;
        /// Has the file changed since the last look?
        bool look();
    };
    struct Slot {
        std::string name;
        int function = LUA_NOREF;
        std::string owner = "slot " + name;
        std::string script{};
        bool is_dead = false;
        bool has_reserve = true;  ///< of memory, until it was short of it: one that hoards leaves some to the others
        RateLimit errors{1};
    };
    static constexpr std::size_t max_slots = 64, longest_text = std::size_t{256} << 10;
    static constexpr std::uint32_t max_remarks = 20;    // in a second
    static constexpr std::uint32_t max_commands = 200;  // in one exec

    ~State() override;

    // Scripts and callbacks.
    Result<> run_text(const std::string& name, std::string_view text);
    Result<> run_file(const std::string& name);
    Result<> run(Script& script);
    void keep(Script script);
    /// Those that are meant, anew. What fails is printed, and stays as it was.
    void run_again(bool (*is_meant)(Script&));
    /// The last registration wins, in the place of the first.
    void add_slot(Slot slot);
    void run_slot(std::size_t index, script::Allowance& left, std::size_t slots_left);
    void free_dead_slots();
    /// Calls the function below the arguments on the top of the stack, with the one below that as handler of its
    /// errors, and pops all. `allowance` becomes what is left of it. Nothing: all went well.
    std::optional<std::string> call(int arguments, script::Allowance& allowance);

    // Host.
    bool cvar_get(std::string_view name, std::string_view& text, double& number) noexcept override;
    void cvar_set(std::string_view name, std::string_view value) noexcept override;
    void cvar_set(std::string_view name, double value) noexcept override;
    void exec(std::string_view commands) noexcept override;
    void fire(std::string_view event) noexcept override { console->composer().fire(event, frame.time); }
    void print(std::string_view text) noexcept override;
    bool on_frame(std::string_view slot, int function) noexcept override;
    bool state_pre_roll(double seconds) noexcept override;
    bool set_class(std::string_view id, std::string_view name, bool is_on) noexcept override;
    [[nodiscard]] double time() const noexcept override { return frame.time; }
    [[nodiscard]] bool is_hud_visible() const noexcept override { return frame.is_hud_visible; }
    void push_game(lua_State* lua, std::string_view name) override;
    [[nodiscard]] std::string_view next_of_game(std::string_view name) const noexcept override;
    void remark(Severity severity, std::string_view text);
    /// Says that there was no memory for what a script did.
    void lose() const;

    Console* console = nullptr;
    ControllersDesc desc;
    std::vector<Script> scripts;
    std::vector<Slot> slots;
    std::vector<Slot> pending;  ///< of the script that is being run
    const std::string* loading = nullptr;
    std::optional<double> stated_pre_roll;  ///< by the script that was run last
    std::string owner;                      ///< of the callback that runs; empty: none does
    bool is_running = false;
    ControllerFrame frame;
    std::string reply;  ///< what the last answer to a script refers to
    RateLimit remarks{max_remarks};
    std::uint64_t writes = 0;
    double microseconds = 0;
    std::unique_ptr<script::Sandbox> sandbox;
};

}  // namespace darkroom
