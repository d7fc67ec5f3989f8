// SPDX-License-Identifier: MIT
#pragma once
// The tables behind the frame graph: what was declared (Declaration) and what compile() made of it (Solution). For the
// files of this folder only; everybody else uses graph.hpp.

#include <array>
#include <utility>

#include "graph/graph.hpp"

namespace darkroom::graph {

inline constexpr std::uint32_t none = ~0u;

/// Bit i: mip level i.
using MipMask = std::uint32_t;
inline constexpr std::uint32_t max_mip_levels = 32;

[[nodiscard]] constexpr MipMask all_mips(std::uint32_t levels) {
    return levels >= max_mip_levels ? ~MipMask{0} : (MipMask{1} << levels) - 1;
}
/// The levels of `range` in an image of `levels` levels. A range that begins after the last level becomes the last one.
[[nodiscard]] constexpr MipMask mip_mask(MipRange range, std::uint32_t levels) {
    const std::uint32_t first = range.first < levels ? range.first : levels - 1;
    const std::uint32_t count = range.count < levels - first ? range.count : levels - first;
    return all_mips(count) << first;
}
[[nodiscard]] constexpr bool has_mip(MipMask mask, std::uint32_t level) { return (mask >> level & 1u) != 0; }

/// What a version lives in. A history is two of these: the current and the previous image.
struct Image {
    ImageDesc desc;
    Slot::Kind kind = Slot::Kind::Transient;
    VkImageUsageFlags allowed_usage = 0;  ///< imports only
    std::uint32_t import_index = none;
    std::uint32_t history_index = none;
    HistoryKey history_key{};
    bool is_previous = false;

    /// Is what a frame reads of it wanted of the frame before?
    [[nodiscard]] bool carries_over() const { return is_previous || kind == Slot::Kind::Lasting; }
    std::vector<std::uint32_t> versions;             ///< in the order they were made
    std::array<std::uint32_t, 2> slots{none, none};  ///< histories: in even and in odd frames; else twice the same

    [[nodiscard]] bool starts_defined() const {
        return kind == Slot::Kind::Import || kind == Slot::Kind::Constant || kind == Slot::Kind::Lasting || is_previous;
    }
};

struct VersionRecord {
    std::uint32_t image = none;
    std::uint32_t producer = none;  ///< pass, or none: none, or a culled one
    std::int32_t gate = -1;         ///< of the producer
    std::uint32_t replaced = none;  ///< none: the image as the frame finds it
    std::uint32_t killer = none;    ///< the pass that replaced it
    std::uint32_t instead = none;   ///< explicit fall-back
    MipMask mips = 0;               ///< what the producer writes
    bool keeps_content = false;     ///< the producer needs the replaced version, in `mips`
    bool is_partial = false;        ///< the producer leaves some mip levels alone
    bool is_first = false;          ///< what the producer replaced holds nothing
    bool is_kept = false;

    [[nodiscard]] bool is_culled() const { return producer == none && replaced != none; }
    /// What a reader gets while the producer is off. `own`: what that reader asked for, or none; taken once.
    [[nodiscard]] std::uint32_t next(std::uint32_t& own) const {
        const bool leaves_older = instead == none && (keeps_content || is_partial);
        if (leaves_older && (own == none || !is_first)) return replaced;
        return own != none ? std::exchange(own, none) : instead;
    }
    [[nodiscard]] std::uint32_t next() const {
        std::uint32_t own = none;
        return next(own);
    }
};

struct PassRecord {
    PassDesc desc;
    std::vector<Version> made;
};

/// Whenever `gate` is on, `implied` is.
struct Implication {
    std::int32_t gate = -1, implied = -1;
};

/// What the user of Graph said.
struct Declaration {
    std::vector<Image> images;
    std::vector<VersionRecord> versions;
    std::vector<PassRecord> passes;
    std::vector<Implication> implications;
    std::uint32_t import_count = 0;
    std::uint32_t history_count = 0;
    std::string first_error;

    [[nodiscard]] const Image& image_of(std::uint32_t version) const { return images[versions[version].image]; }
    void complain(std::string text) {
        if (first_error.empty()) first_error = std::move(text);
    }
};

/// One bit for what a use sees of a write: uses of the same stage and access see the same.
[[nodiscard]] constexpr std::uint32_t sight_of(Use use) { return 1u << static_cast<std::uint32_t>(use); }

/// Everything that may have touched the memory of a slot before a frame's first use of it.
struct Past {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    std::uint32_t reads = 0;  ///< uses that only read, see sight_of
};

/// Result of compile(). Versions keep their declared numbers; passes are numbered anew, without the culled ones and
/// round by round (rounds.cpp).
struct Solution {
    std::vector<Image> images;
    std::vector<VersionRecord> versions;
    std::vector<PassDesc> passes;
    std::vector<std::uint32_t> rounds;       ///< per pass, ascending: those of one round wait for none of each other
    std::vector<std::vector<Version>> made;  ///< per pass
    std::vector<std::string> culled;
    std::vector<std::uint32_t> kept_pass;  ///< declared -> kept, or none
    std::vector<Slot> slots;
    std::vector<Past> past;                ///< per slot
    std::vector<std::uint32_t> first_mip;  ///< per slot: where its mip levels begin in a table of all
    std::uint32_t mip_count = 0;           ///< of all slots
    std::uint32_t import_count = 0;
    std::uint32_t history_count = 0;
    std::vector<std::uint32_t> final_history_version;  ///< per history: what the next frame gets as previous
    std::vector<MipMask> history_mips;                 ///< per history: levels that must be written; those read, if any
    VkDeviceSize transient_bytes = 0;
    VkDeviceSize transient_bytes_unaliased = 0;
    VkDeviceSize buffer_bytes = 0;
    std::uint32_t memory_type_bits = none;
    VkDeviceSize memory_alignment = 1;

    [[nodiscard]] const Image& image_of(std::uint32_t version) const { return images[versions[version].image]; }
};

inline constexpr VkAccessFlags2 all_writes =
    VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;

/// What is taken for granted while looking at one possible frame: a gate is on, or off.
struct Assumption {
    std::int32_t gate = -1;
    bool is_on = false;
};
/// One version that a reader may get, and what must hold for that. `version` none: there is no fall-back.
struct Alternative {
    std::uint32_t version = none;
    std::uint32_t last = none;  ///< the last version tried: names the producer that lacks a fall-back
    std::vector<Assumption> assumptions;
};
/// All versions that a read of `version` may resolve to, given the reader's own gate (-1: none) and fall-back.
[[nodiscard]] std::vector<Alternative> alternatives(const Declaration& declaration, std::uint32_t version,
                                                    std::int32_t reader_gate, std::uint32_t instead = none);

/// All errors of a declaration that need no device.
[[nodiscard]] Result<> validate(const Declaration& declaration, const Extents& largest);

/// What a pass does to a slot.
struct Touch {
    std::uint32_t pass = 0, slot = 0;
    Use use = Use::SampledCompute;
};
/// The round of each of `pass_count` passes, from all that each may do, pass by pass in declared order.
[[nodiscard]] std::vector<std::uint32_t> rounds_of(std::span<const Touch> touches, std::uint32_t pass_count,
                                                   std::uint32_t slot_count);

struct Interval {
    VkDeviceSize size = 0, alignment = 1;
    std::uint32_t first = 0, last = 0;  ///< inclusive
    VkDeviceSize offset = 0;            ///< result
};
/// Gives intervals that live at the same time disjoint bytes; returns the size of the whole.
[[nodiscard]] VkDeviceSize pack(std::span<Interval> intervals);

}  // namespace darkroom::graph
