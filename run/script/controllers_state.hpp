// SPDX-License-Identifier: MIT
#pragma once
// What Controllers are made of, for controllers.cpp (scripts come and go, callbacks run) and controllers_host.cpp (what
// scripts ask for).

#include <darkroom/controllers.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "core/files.hpp"
#include "script/bindings.hpp"

namespace darkroom {

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
