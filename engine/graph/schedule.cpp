// SPDX-License-Identifier: MIT
// Barriers of one frame. Every mip level of every slot has a small state; the passes of a round state what they want of
// it; the difference is a barrier.
#include <algorithm>

#include "graph/schedule.hpp"
#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

/// Where a mip level stands. A layout transition counts as a write that the stages after it have seen.
struct MipState {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 write_stages = 0;  ///< to wait for, to come after the last write
    VkAccessFlags2 write_access = 0;         ///< of that write, 0 if already made available
    VkPipelineStageFlags2 read_stages = 0;   ///< that have read since
    VkAccessFlags2 read_access = 0;          ///< by which the write was made visible to them
    std::uint32_t seen_by = 0;               ///< uses that see the last write, see sight_of
    bool is_touched = false;
};

/// What the passes of a round want of a mip level.
struct Wanted {
    std::uint32_t uses = 0;  ///< see sight_of; 0: nothing
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool is_write = false;
};

bool is_alike(const Barrier& a, const Barrier& b) {
    return a.slot == b.slot && a.source_stages == b.source_stages && a.target_stages == b.target_stages &&
           a.source_access == b.source_access && a.target_access == b.target_access && a.old_layout == b.old_layout &&
           a.new_layout == b.new_layout;
}

/// Adds a barrier of one mip level, or widens the last one by it. `first`: where the batch begins.
void append(std::vector<Barrier>& barriers, std::size_t first, const Barrier& barrier) {
    if (barriers.size() > first && is_alike(barriers.back(), barrier) &&
        barriers.back().mips.first + barriers.back().mips.count == barrier.mips.first) {
        ++barriers.back().mips.count;
        return;
    }
    barriers.push_back(barrier);
}

/// The source half of a barrier after everything that happened to the level.
void wait_for_all(const MipState& state, Barrier& barrier) {
    const bool was_read = state.read_stages != 0;
    // Whoever read it since waited for the write, so waiting for the readers is enough. A kernel may read less than its
    // pass says; by the readers' access the barrier still follows from the one that they waited at.
    barrier.source_stages = was_read ? state.read_stages : state.write_stages;
    barrier.source_access = was_read ? state.read_access : state.write_access;
}

/// Moves `state` on to what `wanted` makes of it; true if that takes `barrier`.
bool advance(MipState& state, const Wanted& wanted, Barrier& barrier) {
    const bool changes_layout = state.layout != wanted.layout;
    const bool has_past = state.write_stages != 0 || state.read_stages != 0;
    const bool is_unseen = state.write_stages != 0 && (wanted.uses & ~state.seen_by) != 0;
    const bool is_needed = changes_layout || (wanted.is_write ? has_past : is_unseen);
    barrier.target_stages = wanted.stages;
    barrier.target_access = wanted.access;
    barrier.old_layout = state.layout;
    barrier.new_layout = wanted.layout;
    if (wanted.is_write || changes_layout) {
        wait_for_all(state, barrier);
        // The host has waited for it, by a barrier that these stages come after.
        if (!has_past) barrier.source_stages = wanted.stages;
    } else {
        barrier.source_stages = state.write_stages;
        barrier.source_access = state.write_access;
    }
    if (wanted.is_write) {
        state = {.layout = wanted.layout,
                 .write_stages = wanted.stages,
                 .write_access = wanted.access & all_writes,
                 .is_touched = true};
    } else if (changes_layout) {
        state = {.layout = wanted.layout,
                 .write_stages = wanted.stages,
                 .read_stages = wanted.stages,
                 .read_access = wanted.access,
                 .seen_by = wanted.uses,
                 .is_touched = true};
    } else {
        state.read_stages |= wanted.stages;
        state.read_access |= wanted.access;
        state.seen_by |= wanted.uses;
        state.is_touched = true;
    }
    return is_needed;
}

/// Uses that find a slot in Schedule::read_layout.
bool is_sampled(Use use) { return layout_of(use) == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; }

bool can_sample_in(VkImageLayout layout) {
    switch (layout) {
        case VK_IMAGE_LAYOUT_GENERAL:
        case VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL:
        case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
        case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
        case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL:
        case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL:
            return true;
        default:
            return false;
    }
}

/// Layouts of the depth aspect: the stencil has one of its own.
bool is_of_depth_alone(VkImageLayout layout) {
    return layout == VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL || layout == VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
}

ImportState state_of(const Slot& slot, std::span<const ImportState> imports) {
    return slot.import_index < imports.size() ? imports[slot.import_index] : ImportState{};
}

}  // namespace

std::optional<Barrier> barrier_of_unused(const ImportState& host, const ImageUses& uses) {
    const bool stays = host.final_layout == VK_IMAGE_LAYOUT_UNDEFINED || host.final_layout == host.layout;
    // What the host wrote may be seen by the stages that it waited for, and by no others: we go on from those.
    const bool is_seen = host.stages == VK_PIPELINE_STAGE_2_NONE;
    const VkPipelineStageFlags2 seen_by = uses.stages != 0 ? uses.stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    // Texels that nobody wrote since wait for nobody who only reads them.
    const bool is_waited_for = host.final_stages != VK_PIPELINE_STAGE_2_NONE &&
                               (is_seen || ((host.access | host.final_access) & all_writes) != 0);
    if (host.layout == VK_IMAGE_LAYOUT_UNDEFINED ? stays : stays && !is_waited_for) return std::nullopt;
    return Barrier{.source_stages = is_seen ? seen_by : host.stages,
                   .target_stages = host.final_stages,
                   .source_access = host.access & all_writes,
                   .target_access = host.final_access,
                   .old_layout = host.layout,
                   .new_layout = stays ? host.layout : host.final_layout,
                   .is_depth_alone = is_of_depth_alone(host.layout) || is_of_depth_alone(host.final_layout)};
}

struct Schedule::State {
    const Solution* solution = nullptr;
    std::vector<std::uint8_t> gates;
    std::uint64_t frame = 0;
    std::vector<std::uint32_t> resolved;       ///< per version
    std::vector<std::uint32_t> read_versions;  ///< per read of all passes: what it resolves to
    std::vector<std::uint32_t> first_read;     ///< per pass: where its reads begin there
    std::vector<VkImageLayout> read_layouts;   ///< per slot
    std::vector<std::uint8_t> is_depth_alone;  ///< per slot
    std::vector<MipMask> needed;               ///< per version
    std::vector<std::uint8_t> is_live;         ///< per pass
    std::vector<std::uint8_t> is_history_read;
    std::vector<MipState> mips;
    std::vector<Wanted> wanted;
    std::vector<std::uint32_t> touched;  ///< slots the round in hand uses
    std::vector<Step> steps;
    std::vector<Barrier> barriers, final_barriers;

    explicit State(const Solution& compiled);
    bool is_on(std::int32_t gate) const { return gate < 0 || gates[static_cast<std::size_t>(gate)] != 0; }
    std::uint32_t slot_of(std::uint32_t resolved_version) const;
    std::uint32_t resolve(std::uint32_t version, std::uint32_t instead = none) const;
    std::span<const std::uint32_t> reads_of(std::uint32_t pass) const;
    void need(std::uint32_t resolved_version, MipRange range);
    void resolve_all();
    void find_live();
    void find_read_layouts(std::span<const ImportState> imports);
    void walk(std::uint32_t pass);
    std::uint32_t last_of(std::uint32_t history) const;
    bool writes_history(std::uint32_t history) const;
    bool mark_histories();
    void start(std::span<const ImportState> imports);
    void want(std::uint32_t slot, MipMask mask, Use use);
    void want_all(std::uint32_t pass);
    void add_round(std::uint32_t first, std::uint32_t last);
    void finish(std::span<const ImportState> imports);
};

Schedule::State::State(const Solution& compiled) : solution(&compiled) {
    std::int32_t last_gate = -1;
    std::size_t barrier_bound = 0;
    std::uint32_t max_mips = 1;
    for (const Slot& slot : solution->slots) max_mips = std::max(max_mips, slot.desc.mip_levels);
    for (const PassDesc& pass : solution->passes) {
        first_read.push_back(static_cast<std::uint32_t>(read_versions.size()));
        read_versions.resize(read_versions.size() + pass.reads.size(), none);
        last_gate = std::max(last_gate, pass.gate);
        barrier_bound += (pass.reads.size() + pass.writes.size()) * max_mips;
    }
    for (const VersionRecord& record : solution->versions) last_gate = std::max(last_gate, record.gate);
    gates.resize(static_cast<std::size_t>(last_gate + 1), 1);
    resolved.resize(solution->versions.size(), none);
    needed.resize(solution->versions.size());
    is_live.resize(solution->passes.size());
    is_history_read.resize(solution->history_count);
    read_layouts.resize(solution->slots.size());
    is_depth_alone.resize(solution->slots.size());
    mips.resize(solution->mip_count);
    wanted.resize(solution->mip_count);
    touched.reserve(solution->slots.size());
    steps.reserve(solution->passes.size());
    barriers.reserve(barrier_bound);
    final_barriers.reserve(solution->mip_count);
}

std::uint32_t Schedule::State::slot_of(std::uint32_t resolved_version) const {
    return resolved_version == none ? none : solution->image_of(resolved_version).slots[frame & 1];
}

std::span<const std::uint32_t> Schedule::State::reads_of(std::uint32_t pass) const {
    return std::span(read_versions).subspan(first_read[pass], solution->passes[pass].reads.size());
}

std::uint32_t Schedule::State::resolve(std::uint32_t version, std::uint32_t instead) const {
    while (version != none) {
        const VersionRecord& record = solution->versions[version];
        if (!is_on(record.gate)) {
            version = record.next(instead);
        } else if (record.is_culled()) {
            version = record.replaced;  // Nobody needs what the culled pass would have written over it.
        } else {
            return version;
        }
    }
    return none;
}

void Schedule::State::need(std::uint32_t resolved_version, MipRange range) {
    if (resolved_version == none) return;
    needed[resolved_version] |= mip_mask(range, solution->image_of(resolved_version).desc.mip_levels);
}

void Schedule::State::resolve_all() {
    for (std::uint32_t version = 0; version < resolved.size(); ++version) resolved[version] = resolve(version);
    for (std::uint32_t pass = 0; pass < solution->passes.size(); ++pass) {
        const std::vector<Read>& reads = solution->passes[pass].reads;
        for (std::size_t i = 0; i < reads.size(); ++i) {
            read_versions[first_read[pass] + i] = resolve(reads[i].version.index, reads[i].instead.index);
        }
    }
}

void Schedule::State::walk(std::uint32_t pass) {
    const PassDesc& desc = solution->passes[pass];
    bool is_needed = desc.has_side_effect;
    for (const Version made : solution->made[pass]) {
        is_needed |= (needed[made.index] & solution->versions[made.index].mips) != 0;
    }
    is_live[pass] = is_needed;
    for (const Version made : solution->made[pass]) {
        const VersionRecord& record = solution->versions[made.index];
        const MipMask rest =
            (needed[made.index] & ~record.mips) | (is_needed && record.keeps_content ? record.mips : 0);
        const std::uint32_t before = resolved[record.replaced];
        if (rest != 0 && before != none && solution->versions[before].image == record.image) needed[before] |= rest;
    }
    if (!is_needed) return;
    for (std::size_t i = 0; i < desc.reads.size(); ++i) need(reads_of(pass)[i], desc.reads[i].mips);
}

/// What this frame leaves in a history; none: nothing. What stands in for an image that is not written belongs to its
/// readers in this frame, not to the next.
std::uint32_t Schedule::State::last_of(std::uint32_t history) const {
    std::uint32_t version = solution->final_history_version[history];
    while (version != none) {
        const VersionRecord& record = solution->versions[version];
        if (is_on(record.gate) && !record.is_culled()) break;
        const bool leaves_older = is_on(record.gate) || record.keeps_content || record.is_partial;
        version = leaves_older ? record.replaced : none;
    }
    return version;
}

bool Schedule::State::writes_history(std::uint32_t history) const {
    MipMask missing = solution->history_mips[history];
    for (std::uint32_t version = last_of(history); version != none && missing != 0;
         version = solution->versions[version].replaced) {
        const VersionRecord& record = solution->versions[version];
        if (record.producer == none || !is_on(record.gate) || (record.mips & missing) == 0) continue;
        if (is_live[record.producer] == 0) return false;
        if (!record.keeps_content) missing &= ~record.mips;
    }
    return missing == 0;
}

/// A history whose previous image is read needs its current one written. True if that is news.
bool Schedule::State::mark_histories() {
    bool is_changed = false;
    for (std::uint32_t pass = 0; pass < solution->passes.size(); ++pass) {
        if (!is_live[pass]) continue;
        for (const std::uint32_t found : reads_of(pass)) {
            if (found == none || !solution->image_of(found).carries_over()) continue;
            const std::uint32_t history = solution->image_of(found).history_index;
            if (is_history_read[history] != 0) continue;
            is_history_read[history] = 1;
            is_changed = true;
            const std::uint32_t final_version = last_of(history);
            if (final_version != none) needed[final_version] |= all_mips(solution->image_of(found).desc.mip_levels);
        }
    }
    return is_changed;
}

void Schedule::State::find_live() {
    std::fill(needed.begin(), needed.end(), MipMask{0});
    std::fill(is_history_read.begin(), is_history_read.end(), std::uint8_t{0});
    for (std::uint32_t version = 0; version < resolved.size(); ++version) {
        if (solution->versions[version].is_kept) need(resolved[version], {});
    }
    do {
        for (auto pass = static_cast<std::uint32_t>(solution->passes.size()); pass-- > 0;) {
            if (is_on(solution->passes[pass].gate)) {
                walk(pass);
            } else {
                is_live[pass] = 0;
            }
        }
    } while (mark_histories());
}

/// A host's image that is only read stays where it is, if every read can be done there.
void Schedule::State::find_read_layouts(std::span<const ImportState> imports) {
    constexpr VkImageLayout usual = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    for (std::uint32_t index = 0; index < solution->slots.size(); ++index) {
        const Slot& slot = solution->slots[index];
        read_layouts[index] = usual;
        is_depth_alone[index] = 0;
        if (slot.kind != Slot::Kind::Import) continue;
        const ImportState host = state_of(slot, imports);
        if (can_sample_in(host.layout)) read_layouts[index] = host.layout;
        is_depth_alone[index] = is_of_depth_alone(host.layout) || is_of_depth_alone(host.final_layout) ? 1 : 0;
    }
    for (std::uint32_t pass = 0; pass < solution->passes.size(); ++pass) {
        if (is_live[pass] == 0) continue;
        const PassDesc& desc = solution->passes[pass];
        for (std::size_t i = 0; i < desc.reads.size(); ++i) {
            const std::uint32_t slot = slot_of(reads_of(pass)[i]);
            const Use use = desc.reads[i].use;
            if (slot != none && !is_sampled(use) && layout_of(use) != read_layouts[slot]) read_layouts[slot] = usual;
        }
        for (const Version made : solution->made[pass]) {
            read_layouts[solution->image_of(made.index).slots[frame & 1]] = usual;
        }
    }
}

void Schedule::State::start(std::span<const ImportState> imports) {
    for (std::uint32_t index = 0; index < solution->slots.size(); ++index) {
        const Slot& slot = solution->slots[index];
        MipState state{.write_stages = solution->past[index].stages,
                       .write_access = solution->past[index].access & all_writes};
        if (slot.kind == Slot::Kind::Import) {
            const ImportState host = state_of(slot, imports);
            state = {.layout = host.layout, .write_stages = host.stages, .write_access = host.access & all_writes};
        }
        const bool is_current = slot.kind == Slot::Kind::History && slot.history_parity == (frame & 1);
        if ((slot.kind == Slot::Kind::History && !is_current) || slot.kind == Slot::Kind::Lasting) {
            state.layout = slot.rest_layout;
            state.seen_by = none;  // finish() saw to that.
            // The last frame may have read it in any of these after it wrote it.
            state.read_stages = state.write_stages;
            // A buffer that no pass may only read came to no rest: who writes it next waits for the write itself.
            if (slot.kind == Slot::Kind::Lasting) state.read_access = state.write_access;
        }
        std::fill_n(mips.begin() + solution->first_mip[index], slot.desc.mip_levels, state);
    }
}

void Schedule::State::want(std::uint32_t slot, MipMask mask, Use use) {
    if (slot == none || solution->slots[slot].kind == Slot::Kind::Constant) return;
    if (std::find(touched.begin(), touched.end(), slot) == touched.end()) touched.push_back(slot);
    for (std::uint32_t level = 0; level < solution->slots[slot].desc.mip_levels; ++level) {
        if (!has_mip(mask, level)) continue;
        Wanted& all = wanted[solution->first_mip[slot] + level];
        all.uses |= sight_of(use);
        all.stages |= stages_of(use);
        all.access |= access_of(use);
        all.layout = is_sampled(use) ? read_layouts[slot] : layout_of(use);
        all.is_write |= is_write(use);
    }
}

void Schedule::State::want_all(std::uint32_t pass) {
    const PassDesc& desc = solution->passes[pass];
    for (std::size_t i = 0; i < desc.reads.size(); ++i) {
        const std::uint32_t slot = slot_of(reads_of(pass)[i]);
        if (slot == none) continue;
        want(slot, mip_mask(desc.reads[i].mips, solution->slots[slot].desc.mip_levels), desc.reads[i].use);
    }
    for (std::size_t i = 0; i < desc.writes.size(); ++i) {
        const VersionRecord& record = solution->versions[solution->made[pass][i].index];
        want(solution->images[record.image].slots[frame & 1], record.mips, desc.writes[i].use);
    }
}

/// The passes from `first` to before `last`. What they want of a mip level is one and the same, so one batch of
/// barriers before them is enough.
void Schedule::State::add_round(std::uint32_t first, std::uint32_t last) {
    const std::size_t first_barrier = barriers.size(), first_step = steps.size();
    touched.clear();
    for (std::uint32_t pass = first; pass < last; ++pass) {
        if (is_live[pass] == 0) continue;
        want_all(pass);
        steps.push_back({.pass = pass, .first_barrier = static_cast<std::uint32_t>(first_barrier)});
    }
    for (const std::uint32_t slot : touched) {
        for (std::uint32_t level = 0; level < solution->slots[slot].desc.mip_levels; ++level) {
            const std::uint32_t index = solution->first_mip[slot] + level;
            if (wanted[index].uses == 0) continue;
            Barrier barrier{.slot = slot, .mips = {level, 1}, .is_depth_alone = is_depth_alone[slot] != 0};
            if (advance(mips[index], wanted[index], barrier)) append(barriers, first_barrier, barrier);
            wanted[index] = {};
        }
    }
    if (first_step == steps.size()) return;
    steps[first_step].barrier_count = static_cast<std::uint32_t>(barriers.size() - first_barrier);
    for (std::size_t i = first_step + 1; i < steps.size(); ++i)
        steps[i].first_barrier = static_cast<std::uint32_t>(barriers.size());
}

/// Leaves the host's images where the host wants them, and histories at rest: visible to all that may read them.
void Schedule::State::finish(std::span<const ImportState> imports) {
    for (std::uint32_t index = 0; index < solution->slots.size(); ++index) {
        const Slot& slot = solution->slots[index];
        const bool is_import = slot.kind == Slot::Kind::Import;
        if (!is_import && slot.kind != Slot::Kind::History && slot.kind != Slot::Kind::Lasting) continue;
        const ImportState host = is_import ? state_of(slot, imports) : ImportState{};
        for (std::uint32_t level = 0; level < slot.desc.mip_levels; ++level) {
            const MipState& state = mips[solution->first_mip[index] + level];
            Barrier barrier{.slot = index, .mips = {level, 1}, .is_depth_alone = is_depth_alone[index] != 0};
            if (is_import && !state.is_touched) {
                if (const auto left = barrier_of_unused(host, slot.uses)) {
                    barrier = *left;
                    barrier.slot = index;
                    barrier.mips = {level, 1};
                    append(final_barriers, 0, barrier);
                }
                continue;
            }
            if (!state.is_touched) continue;
            barrier.old_layout = state.layout;
            barrier.new_layout = is_import ? host.final_layout : slot.rest_layout;
            if (is_import && host.final_layout == VK_IMAGE_LAYOUT_UNDEFINED) barrier.new_layout = state.layout;
            barrier.target_stages = is_import ? host.final_stages : solution->past[index].stages;
            barrier.target_access = is_import ? host.final_access : solution->past[index].access & ~all_writes;
            const bool is_waited_for = is_import ? host.final_stages != VK_PIPELINE_STAGE_2_NONE
                                                 : (solution->past[index].reads & ~state.seen_by) != 0;
            if (!is_waited_for && barrier.old_layout == barrier.new_layout) continue;
            wait_for_all(state, barrier);
            append(final_barriers, 0, barrier);
        }
    }
}

Schedule::Schedule(const Compiled& compiled) : state_(std::make_unique<State>(compiled.solution())) {}
Schedule::~Schedule() = default;
Schedule::Schedule(Schedule&&) noexcept = default;
Schedule& Schedule::operator=(Schedule&&) noexcept = default;

void Schedule::derive(std::span<const bool> gates, std::span<const ImportState> imports, std::uint64_t frame) {
    State& state = *state_;
    for (std::size_t i = 0; i < state.gates.size(); ++i) state.gates[i] = i >= gates.size() || gates[i];
    state.frame = frame;
    state.steps.clear();
    state.barriers.clear();
    state.final_barriers.clear();
    state.resolve_all();
    state.find_live();
    state.find_read_layouts(imports);
    state.start(imports);
    const std::vector<std::uint32_t>& rounds = state.solution->rounds;
    for (std::uint32_t first = 0, last = 0; first < rounds.size(); first = last) {
        while (last < rounds.size() && rounds[last] == rounds[first]) ++last;
        state.add_round(first, last);
    }
    state.finish(imports);
}

std::span<const Step> Schedule::steps() const { return state_->steps; }
std::span<const Barrier> Schedule::barriers() const { return state_->barriers; }
std::span<const Barrier> Schedule::final_barriers() const { return state_->final_barriers; }
bool Schedule::runs(std::uint32_t pass) const { return pass < state_->is_live.size() && state_->is_live[pass] != 0; }
bool Schedule::reads_history(std::uint32_t history_index) const { return state_->is_history_read[history_index] != 0; }
bool Schedule::writes_history(std::uint32_t history_index) const { return state_->writes_history(history_index); }
std::uint32_t Schedule::slot_of(Version version, Version instead) const {
    if (version.index >= state_->resolved.size()) return none;
    const bool has_own = instead.index < state_->resolved.size();
    return state_->slot_of(has_own ? state_->resolve(version.index, instead.index) : state_->resolved[version.index]);
}
VkImageLayout Schedule::read_layout(std::uint32_t slot) const { return state_->read_layouts[slot]; }
Recording Schedule::recording() const {
    return {.steps = state_->steps,
            .barriers = state_->barriers,
            .final_barriers = state_->final_barriers,
            .gates = state_->gates,
            .read_layouts = state_->read_layouts,
            .frame = state_->frame};
}

}  // namespace darkroom::graph
