// SPDX-License-Identifier: MIT
// A second opinion on barriers. It shares no code with schedule.cpp: it plays the commands on a model of the memory
// dependencies of the Vulkan specification ("Execution and Memory Dependencies") and follows, for every access, after
// which stages' work it has happened, whether it was made available, and to which accesses it is visible.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "graph/solution.hpp"
#include "graph_check/check.hpp"

namespace darkroom::graph {
namespace {

// The stages that matter here, one by one; stage masks that stand for several are spelt out in these.
constexpr std::array stage_list = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                   VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                                   VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                   VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_PIPELINE_STAGE_2_COPY_BIT,
                                   VK_PIPELINE_STAGE_2_BLIT_BIT,
                                   VK_PIPELINE_STAGE_2_RESOLVE_BIT,
                                   VK_PIPELINE_STAGE_2_CLEAR_BIT,
                                   VK_PIPELINE_STAGE_2_HOST_BIT};
using StageSet = std::uint32_t;  ///< one bit an entry of stage_list

StageSet stage_set(VkPipelineStageFlags2 mask) {
    StageSet set = 0;
    for (std::size_t i = 0; i < stage_list.size(); ++i) {
        const VkPipelineStageFlags2 stage = stage_list[i];
        const bool is_transfer = i >= 5 && i <= 8;
        const bool is_graphics = i >= 1 && i <= 4;
        const bool is_host = i == 9;
        const bool is_in = (mask & stage) != 0 || (!is_host && (mask & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0) ||
                           (is_transfer && (mask & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) != 0) ||
                           (is_graphics && (mask & VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) != 0);
        if (is_in) set |= 1u << i;
    }
    return set;
}

constexpr VkAccessFlags2 read_bits = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                     VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                                     VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                                     VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
constexpr VkAccessFlags2 write_bits = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                      VK_ACCESS_2_HOST_WRITE_BIT;

VkAccessFlags2 access_set(VkAccessFlags2 mask) {
    VkAccessFlags2 set = mask & (read_bits | write_bits);
    if ((mask & VK_ACCESS_2_MEMORY_READ_BIT) != 0) set |= read_bits;
    if ((mask & VK_ACCESS_2_MEMORY_WRITE_BIT) != 0) set |= write_bits;
    if ((mask & VK_ACCESS_2_SHADER_READ_BIT) != 0) {
        set |= VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    }
    if ((mask & VK_ACCESS_2_SHADER_WRITE_BIT) != 0) set |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    return set;
}

/// What one stage of one command did to a mip level. A layout transition is a write of no stage, available at once.
struct Event {
    std::string who;
    StageSet stage = 0;
    VkAccessFlags2 written = 0;  ///< 0: only read
    bool is_transition = false;
    bool is_available = false;
    StageSet happened_before = 0;                             ///< stages whose later work comes after this
    std::array<VkAccessFlags2, stage_list.size()> visible{};  ///< per stage

    bool is_write() const { return is_transition || written != 0; }
};

/// Who put the content there.
struct Content {
    enum class Kind : std::uint8_t { Nothing, Host, Reset, Pass } kind = Kind::Nothing;
    std::uint64_t frame = 0;
    std::uint32_t pass = 0;
    friend bool operator==(const Content&, const Content&) = default;
};

struct Level {
    std::vector<Event> events;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    Content content;
};

class Checker {
  public:
    Checker(const Solution& solution, std::span<const ImportState> imports) : solution_(solution), imports_(imports) {
        for (const Slot& slot : solution_.slots) {
            Level level;
            if (slot.kind == Slot::Kind::Constant) level.content.kind = Content::Kind::Host;
            if (slot.kind == Slot::Kind::History) level.layout = slot.rest_layout;
            const bool lasts = slot.kind == Slot::Kind::History || slot.kind == Slot::Kind::Lasting;
            if (lasts) level.content.kind = Content::Kind::Reset;
            levels_.emplace_back(slot.desc.mip_levels, level);
        }
    }

    Result<> play(const Recording& recording) {
        recording_ = recording;
        ran_.assign(solution_.passes.size(), false);
        take_from_host();
        for (const Step& step : recording.steps) {
            DARKROOM_TRY(play_step(step));
        }
        for (const Barrier& barrier : recording.final_barriers) {
            DARKROOM_TRY(apply(barrier, "the end of the frame"));
        }
        DARKROOM_TRY(check_kept());
        return give_to_host();
    }

  private:
    const std::string& name(std::uint32_t slot) const { return solution_.slots[slot].desc.name; }
    std::string place(std::uint32_t slot, std::uint32_t mip) const {
        return solution_.slots[slot].desc.mip_levels > 1 ? fmt::format("'{}' mip {}", name(slot), mip)
                                                         : fmt::format("'{}'", name(slot));
    }
    ImportState host_state(const Slot& slot) const {
        return slot.import_index < imports_.size() ? imports_[slot.import_index] : ImportState{};
    }
    bool is_off(std::int32_t gate) const {
        return gate >= 0 && static_cast<std::size_t>(gate) < recording_.gates.size() &&
               recording_.gates[static_cast<std::size_t>(gate)] == 0;
    }

    void take_from_host() {
        for (std::uint32_t index = 0; index < solution_.slots.size(); ++index) {
            const Slot& slot = solution_.slots[index];
            if (slot.kind != Slot::Kind::Import) continue;
            const ImportState host = host_state(slot);
            Level level;
            level.layout = host.layout;
            if (host.layout != VK_IMAGE_LAYOUT_UNDEFINED) level.content.kind = Content::Kind::Host;
            add_events(level, "the host", host.stages, access_set(host.access) & write_bits);
            if (host.stages == VK_PIPELINE_STAGE_2_NONE) level.events.push_back(barrier_of_host(slot));
            levels_[index].assign(slot.desc.mip_levels, level);
        }
    }

    /// One that the host has placed, behind something that it wrote, for what the plan tells.
    static Event barrier_of_host(const Slot& slot) {
        const VkPipelineStageFlags2 told =
            slot.uses.stages != 0 ? slot.uses.stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        Event event{.who = "the host's barrier", .is_transition = true, .is_available = true};
        event.happened_before = stage_set(told);
        for (std::size_t i = 0; i < stage_list.size(); ++i)
            if ((event.happened_before >> i & 1u) != 0) event.visible[i] = access_set(slot.uses.access);
        return event;
    }

    static void add_events(Level& level, const std::string& who, VkPipelineStageFlags2 stages, VkAccessFlags2 written) {
        const StageSet set = stage_set(stages);
        for (std::size_t i = 0; i < stage_list.size(); ++i) {
            if ((set >> i & 1u) != 0) level.events.push_back({.who = who, .stage = 1u << i, .written = written});
        }
    }

    static bool covers(const Barrier& barrier, const Event& event) {
        const StageSet source = stage_set(barrier.source_stages);
        return (source & (event.stage | event.happened_before)) != 0;
    }
    static bool makes_available(const Barrier& barrier, const Event& event) {
        return event.is_available || ((stage_set(barrier.source_stages) & event.stage) != 0 &&
                                      (event.written & ~access_set(barrier.source_access)) == 0);
    }

    static void make_known(const Barrier& barrier, Event& event) {
        if (!covers(barrier, event)) return;
        event.is_available = makes_available(barrier, event);
        const StageSet target = stage_set(barrier.target_stages);
        event.happened_before |= target;
        for (std::size_t i = 0; event.is_available && i < stage_list.size(); ++i) {
            if ((target >> i & 1u) != 0) event.visible[i] |= access_set(barrier.target_access);
        }
    }

    /// A transition writes the level: everything before it must have happened, and writes must be available.
    Result<> check_transition(const Barrier& barrier, const Level& level, const std::string& where,
                              const std::string& who) const {
        for (const Event& event : level.events) {
            if (covers(barrier, event) && (!event.is_write() || makes_available(barrier, event))) continue;
            return user_error(fmt::format("before {}: the layout transition of {} does not wait for what {} did", who,
                                          where, event.who));
        }
        return {};
    }

    Result<> apply(const Barrier& barrier, const std::string& who) {
        const Slot& slot = solution_.slots[barrier.slot];
        for (std::uint32_t mip = barrier.mips.first; mip < barrier.mips.first + barrier.mips.count; ++mip) {
            if (mip >= slot.desc.mip_levels)
                return user_error(fmt::format("before {}: '{}' has no mip {}", who, slot.desc.name, mip));
            Level& level = levels_[barrier.slot][mip];
            const std::string where = place(barrier.slot, mip);
            const bool discards = barrier.old_layout == VK_IMAGE_LAYOUT_UNDEFINED;
            if (!discards && barrier.old_layout != level.layout) {
                return user_error(fmt::format("before {}: the barrier expects {} in layout {}, but it is in {}", who,
                                              where, static_cast<int>(barrier.old_layout),
                                              static_cast<int>(level.layout)));
            }
            if (barrier.old_layout == barrier.new_layout) {
                for (Event& event : level.events) make_known(barrier, event);
                continue;
            }
            DARKROOM_TRY(check_transition(barrier, level, where, who));
            if (discards) {
                DARKROOM_TRY(take_memory(barrier, where, who));
                level.content = {};
            }
            Event transition{.who = "the transition before " + who, .is_transition = true, .is_available = true};
            transition.happened_before = stage_set(barrier.target_stages);
            for (std::size_t i = 0; i < stage_list.size(); ++i) {
                if ((transition.happened_before >> i & 1u) != 0)
                    transition.visible[i] = access_set(barrier.target_access);
            }
            level.events.assign(1, std::move(transition));
            level.layout = barrier.new_layout;
        }
        return {};
    }

    /// A transient image begins: whatever else lies in its bytes must be done with, and is lost.
    Result<> take_memory(const Barrier& barrier, const std::string& where, const std::string& who) {
        const Slot& slot = solution_.slots[barrier.slot];
        if (slot.kind != Slot::Kind::Transient) return {};
        for (std::uint32_t other = 0; other < solution_.slots.size(); ++other) {
            const Slot& rival = solution_.slots[other];
            if (other == barrier.slot || rival.kind != Slot::Kind::Transient || rival.desc.is_buffer()) continue;
            if (rival.offset >= slot.offset + slot.size || slot.offset >= rival.offset + rival.size) continue;
            for (Level& level : levels_[other]) {
                DARKROOM_TRY(check_transition(barrier, level, where, who));
                level.layout = VK_IMAGE_LAYOUT_UNDEFINED;
                level.content = {};
            }
        }
        return {};
    }

    Result<> access(std::uint32_t slot, std::uint32_t mip, const std::string& who, VkPipelineStageFlags2 stages,
                    VkAccessFlags2 mask, VkImageLayout layout) const {
        const Level& level = levels_[slot][mip];
        if (level.layout != layout && solution_.slots[slot].kind != Slot::Kind::Constant) {
            return user_error(fmt::format("{} uses {} in layout {}, but it is in {}", who, place(slot, mip),
                                          static_cast<int>(layout), static_cast<int>(level.layout)));
        }
        const StageSet set = stage_set(stages);
        const VkAccessFlags2 wanted = access_set(mask);
        for (const Event& event : level.events) {
            if (!event.is_write() && (wanted & write_bits) == 0) continue;
            if ((set & ~event.happened_before) != 0) {
                return user_error(
                    fmt::format("{} does not wait for what {} did to {}", who, event.who, place(slot, mip)));
            }
            if (!event.is_write()) continue;
            for (std::size_t i = 0; i < stage_list.size(); ++i) {
                if ((set >> i & 1u) == 0 || (wanted & ~event.visible[i]) == 0) continue;
                return user_error(fmt::format("{} does not see what {} did to {}", who, event.who, place(slot, mip)));
            }
        }
        return {};
    }

    bool holds_nothing(std::uint32_t version) const {
        return solution_.versions[version].replaced == none && !solution_.image_of(version).starts_defined();
    }

    /// What a reader of `version` is to get in this frame, found by trying one fall-back after the other. `own`: the
    /// reader's own fall-back, or none.
    std::uint32_t version_for_reader(std::uint32_t version, std::uint32_t own = none) const {
        while (version != none && is_off(solution_.versions[version].gate)) {
            const VersionRecord& record = solution_.versions[version];
            const bool has_older = record.instead == none && (record.keeps_content || record.is_partial);
            if (own != none && (!has_older || holds_nothing(record.replaced))) return version_for_reader(own);
            version = has_older ? record.replaced : record.instead;
        }
        return version;
    }

    /// Where a descriptor says that a sampled image is, or the one layout that another use needs.
    Result<VkImageLayout> layout_for(std::uint32_t slot, Use use, const std::string& who) const {
        const bool is_sampled = use == Use::SampledCompute || use == Use::SampledFragment;
        if (!is_sampled || slot >= recording_.read_layouts.size()) return layout_of(use);
        constexpr std::array sampled_layouts{VK_IMAGE_LAYOUT_GENERAL,
                                             VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL,
                                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                             VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                             VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
                                             VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
        const VkImageLayout layout = recording_.read_layouts[slot];
        if (std::ranges::find(sampled_layouts, layout) != sampled_layouts.end()) return layout;
        return user_error(fmt::format("{} samples '{}' in layout {}, which does not allow it", who, name(slot),
                                      static_cast<int>(layout)));
    }

    /// Fails unless `mip` holds what version `version` stands for.
    Result<> check_content(std::uint32_t version, std::uint32_t slot, std::uint32_t mip, const std::string& who) const {
        if (version == none) return user_error(fmt::format("{} reads an image whose producer is off", who));
        const Content& content = levels_[slot][mip].content;
        while (solution_.versions[version].replaced != none) {
            const VersionRecord& record = solution_.versions[version];
            const bool writes = (record.mips >> mip & 1u) != 0 && !is_off(record.gate);
            if (writes && record.producer == none) {
                return user_error(fmt::format("{} needs {} from a pass that was culled", who, place(slot, mip)));
            }
            if (writes && !ran_[record.producer]) {
                return user_error(fmt::format("{} needs {} from pass '{}', which did not run", who, place(slot, mip),
                                              solution_.passes[record.producer].name));
            }
            if (writes) {
                if (content == Content{Content::Kind::Pass, recording_.frame, record.producer}) return {};
                return user_error(fmt::format("{} does not find in {} what pass '{}' wrote", who, place(slot, mip),
                                              solution_.passes[record.producer].name));
            }
            version = record.replaced;
        }
        const bool is_current =
            solution_.slots[slot].kind == Slot::Kind::History && !solution_.image_of(version).is_previous;
        const bool is_transient = solution_.slots[slot].kind == Slot::Kind::Transient;
        const bool is_import = solution_.slots[slot].kind == Slot::Kind::Import;
        const bool is_older = solution_.slots[slot].kind == Slot::Kind::Lasting && content.frame != recording_.frame;
        const bool lasts = is_import || solution_.slots[slot].kind == Slot::Kind::Lasting;
        const bool is_overwritten = lasts && content.kind == Content::Kind::Pass && !is_older;
        if (is_current || is_transient || is_overwritten || content.kind == Content::Kind::Nothing) {
            return user_error(fmt::format("{} reads {}, which holds nothing it may read", who, place(slot, mip)));
        }
        return {};
    }

    static MipMask levels_of(MipRange range, std::uint32_t count) {
        MipMask mask = 0;
        for (std::uint32_t mip = 0; mip < count; ++mip) {
            const bool is_in = mip >= range.first && (range.count == none || mip - range.first < range.count);
            if (is_in) mask |= 1u << mip;
        }
        return mask != 0 ? mask : 1u << (count - 1);
    }

    Result<> play_step(const Step& step) {
        const PassDesc& pass = solution_.passes[step.pass];
        const std::string who = fmt::format("pass '{}'", pass.name);
        if (is_off(pass.gate)) return user_error(who + " is recorded although its gate is off");
        for (std::uint32_t i = 0; i < step.barrier_count; ++i) {
            DARKROOM_TRY(apply(recording_.barriers[step.first_barrier + i], who));
        }
        for (const Read& read : pass.reads) {
            DARKROOM_TRY(play_read(read, who));
        }
        for (std::size_t i = 0; i < pass.writes.size(); ++i) {
            const std::uint32_t made = solution_.made[step.pass][i].index;
            DARKROOM_TRY(play_write(pass.writes[i], made, step.pass, who));
        }
        ran_[step.pass] = true;
        return {};
    }

    Result<> play_read(const Read& read, const std::string& who) {
        const std::uint32_t version = version_for_reader(read.version.index, read.instead.index);
        if (version == none) return user_error(who + " reads an image whose producer is off");
        const std::uint32_t slot = solution_.image_of(version).slots[recording_.frame % 2];
        const MipMask mips = levels_of(read.mips, solution_.slots[slot].desc.mip_levels);
        const auto layout = layout_for(slot, read.use, who);
        if (!layout) return user_error(layout.error().text);
        for (std::uint32_t mip = 0; mip < solution_.slots[slot].desc.mip_levels; ++mip) {
            if ((mips >> mip & 1u) == 0) continue;
            DARKROOM_TRY(check_content(version, slot, mip, who));
            DARKROOM_TRY(access(slot, mip, who, stages_of(read.use), access_of(read.use), *layout));
            add_events(levels_[slot][mip], who, stages_of(read.use), 0);
        }
        return {};
    }

    Result<> play_write(const Write& write, std::uint32_t made, std::uint32_t pass, const std::string& who) {
        const VersionRecord& record = solution_.versions[made];
        const std::uint32_t slot = solution_.images[record.image].slots[recording_.frame % 2];
        for (std::uint32_t mip = 0; mip < solution_.slots[slot].desc.mip_levels; ++mip) {
            if ((record.mips >> mip & 1u) == 0) continue;
            Level& level = levels_[slot][mip];
            if (record.keeps_content) {
                DARKROOM_TRY(check_content(version_for_reader(record.replaced), slot, mip, who));
            }
            DARKROOM_TRY(access(slot, mip, who, stages_of(write.use), access_of(write.use), layout_of(write.use)));
            level.events.clear();
            add_events(level, who, stages_of(write.use), access_set(access_of(write.use)) & write_bits);
            level.content = {Content::Kind::Pass, recording_.frame, pass};
        }
        return {};
    }

    Result<> check_kept() const {
        for (std::uint32_t index = 0; index < solution_.versions.size(); ++index) {
            if (!solution_.versions[index].is_kept) continue;
            const std::uint32_t version = version_for_reader(index);
            if (version == none || solution_.image_of(version).kind == Slot::Kind::History) continue;
            const std::uint32_t slot = solution_.image_of(version).slots[recording_.frame % 2];
            for (std::uint32_t mip = 0; mip < solution_.slots[slot].desc.mip_levels; ++mip) {
                DARKROOM_TRY(check_content(version, slot, mip, "after the frame, the host"));
            }
        }
        return {};
    }

    /// Whatever the next frame switches on: every use that a history was compiled for must see what this frame wrote.
    Result<> check_rest(std::uint32_t slot, std::uint32_t mip) const {
        for (std::uint8_t index = 0; index < use_count; ++index) {
            const Use use{index};
            if ((solution_.past[slot].reads >> index & 1u) == 0) continue;
            DARKROOM_TRY(
                access(slot, mip, "the next frame", stages_of(use), access_of(use), solution_.slots[slot].rest_layout));
        }
        return {};
    }

    Result<> give_to_host() const {
        for (std::uint32_t index = 0; index < solution_.slots.size(); ++index) {
            const Slot& slot = solution_.slots[index];
            const ImportState host = host_state(slot);
            for (std::uint32_t mip = 0; mip < slot.desc.mip_levels; ++mip) {
                const Level& level = levels_[index][mip];
                if (slot.kind == Slot::Kind::History && level.layout != slot.rest_layout) {
                    return user_error(fmt::format("after the frame, history {} is in layout {}, not at rest in {}",
                                                  place(index, mip), static_cast<int>(level.layout),
                                                  static_cast<int>(slot.rest_layout)));
                }
                if (slot.kind == Slot::Kind::History || slot.kind == Slot::Kind::Lasting) {
                    DARKROOM_TRY(check_rest(index, mip));
                }
                const VkImageLayout wanted =
                    host.final_layout == VK_IMAGE_LAYOUT_UNDEFINED ? level.layout : host.final_layout;
                if (slot.kind != Slot::Kind::Import || wanted == VK_IMAGE_LAYOUT_UNDEFINED) continue;
                const bool is_read_alone = (access_set(host.final_access) & write_bits) == 0 &&
                                           std::ranges::all_of(level.events, [](const Event& event) {
                                               return event.who == "the host" && event.written == 0;
                                           });
                if (is_read_alone && level.layout == wanted) continue;
                // The host may do anything after its stages, so they come after reads, too.
                const StageSet final_stages = stage_set(host.final_stages);
                for (const Event& event : level.events) {
                    if ((final_stages & ~event.happened_before) == 0) continue;
                    return user_error(fmt::format("after the frame, the host does not wait for what {} did to {}",
                                                  event.who, place(index, mip)));
                }
                DARKROOM_TRY(
                    access(index, mip, "after the frame, the host", host.final_stages, host.final_access, wanted));
            }
        }
        return {};
    }

    const Solution& solution_;
    std::span<const ImportState> imports_;
    Recording recording_;
    std::vector<std::vector<Level>> levels_;  ///< slot, mip
    std::vector<bool> ran_;
};

}  // namespace

Result<> check_frames(const Compiled& compiled, std::span<const Recording> frames,
                      std::span<const ImportState> imports) {
    Checker checker(compiled.solution(), imports);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (auto result = checker.play(frames[i]); !result) {
            return frames.size() == 1 ? result : user_error(fmt::format("frame {}: {}", i, result.error().text));
        }
    }
    return {};
}

Result<> check(const Compiled& compiled, const Schedule& schedule, std::span<const ImportState> imports) {
    const Recording recording = schedule.recording();
    return check_frames(compiled, {&recording, 1}, imports);
}

}  // namespace darkroom::graph
