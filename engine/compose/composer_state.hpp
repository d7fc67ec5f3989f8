// SPDX-License-Identifier: MIT
#pragma once
// What a Composer is made of, for composer.cpp (the stack and its values) and composer_run.cpp (compiling, recording).

#include <darkroom/composer.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "compose/chain/chain.hpp"

namespace darkroom {

/// How its result goes over its input: a struct that a host filled may hold anything.
[[nodiscard]] Result<> check_mixing(const EntryDesc& desc);
/// All values of an entry, and what they are together: a struct that a host filled may hold anything.
[[nodiscard]] Result<> check_values(const plan::Entry& entry, std::span<const std::uint32_t> words);

struct Composer::State {
    State(std::shared_ptr<gpu::Context> device_context, const ComposerDesc& composer_desc);
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // The stack; composer.cpp.
    [[nodiscard]] std::size_t index_of(Handle handle) const;  ///< size() if it names no entry
    [[nodiscard]] plan::Entry* entry(Handle handle) const;    ///< null if it names no entry
    [[nodiscard]] Result<plan::Entry*> checked(Handle handle) const;
    [[nodiscard]] std::shared_ptr<plan::Entry> make_entry(const EffectInfo& info, const void* parameters,
                                                          const EntryDesc& entry_desc) const;
    /// The entry, and those that it replaced and plans still have.
    template <class Visit>
    static void for_all_of(plan::Entry& entry, const Visit& visit) {
        visit(entry);
        for (auto older = entry.replaced.lock(); older; older = older->replaced.lock()) visit(*older);
    }
    /// Which of the entry's rows; the error names the nearest.
    [[nodiscard]] static Result<const ParamInfo*> row(const plan::Entry& entry, std::string_view parameter);

    /// What was fired begins now; modulation.cpp.
    void start_pulses(double time);

    // Compiling; composer_run.cpp.
    /// Is there one to compile on?
    [[nodiscard]] Result<> check_device() const;
    struct Snapshot {
        CompileDesc desc;
        std::vector<plan::Entry> values;
        std::vector<std::shared_ptr<const plan::Entry>> entries;
    };
    [[nodiscard]] Result<Snapshot> snapshot(const CompileDesc& compile_desc) const;
    /// With compile_mutex held.
    [[nodiscard]] Result<std::unique_ptr<compose::Chain>> make_chain(Snapshot snapshot);
    [[nodiscard]] Result<Plan> compile(const CompileDesc& wanted);
    /// What a rebind compiles for: the plan that is on its way, else the one there is.
    [[nodiscard]] std::optional<CompileDesc> last_desc() const;
    /// May its opacity change, by the plan there is and by the one that is on its way?
    [[nodiscard]] bool is_mixable(const plan::Entry& entry) const;
    /// For the task of compile_later(): `number` is that of its request.
    void compile_now(Snapshot snapshot, std::uint64_t number);
    /// Ends what compile_later() began: with the lock, nothing runs, and nothing will be taken.
    [[nodiscard]] std::unique_lock<std::mutex> stop_compiling();

    // Recording.
    /// The plan that is ready, if this frame is for it. Never waits.
    void take_ready(const Frame& frame);
    void take(std::unique_ptr<compose::Chain> newer);
    /// Of those that no recording needs any more.
    void put_away_retired();
    /// For a plan that is about to be made, so that record() allocates nothing when it takes it.
    void make_room_for_retired();

    std::shared_ptr<gpu::Context> context;
    ComposerDesc desc;
    std::vector<std::shared_ptr<plan::Entry>> stack;
    std::shared_ptr<const Resources> resources = std::make_shared<Resources>();

    compose::Clock clock;
    std::unique_ptr<compose::Chain> chain;
    std::unique_ptr<compose::Chain> told;  ///< of a host that asks first: what coming_plan() showed it, for record()
    bool asks_first = false;
    /// A plan that a newer one replaced, until so many more recordings are made.
    struct Retired {
        std::unique_ptr<compose::Garbage> chain;
        std::uint32_t recordings_left = 0;
    };
    std::vector<Retired> retired;
    double record_microseconds = 0;
    plan::Moment last;            ///< of the last record
    bool is_any_waiting = false;  ///< has a pulse been fired that no record has seen?

    std::mutex compile_mutex;  ///< guards the next two; record() never takes it
    graph::HistoryPool histories;
    std::shared_ptr<compose::StackProgram> program;  ///< of the last compile

    mutable std::mutex pending_mutex;  ///< guards the next four; record() tries it and never waits
    std::uint64_t requests = 0;
    struct Later {
        CompileDesc desc;
        std::vector<std::uint32_t> unmixed{};  ///< entries whose result nobody merges
    };
    std::optional<Later> later;  ///< what compile_later() is making
    std::optional<Error> pending_error;
    std::unique_ptr<compose::Chain> ready;  ///< for record() to take

    std::unique_ptr<compose::Worker> worker;  ///< the last member, since its task works on all of this
};

}  // namespace darkroom
