// SPDX-License-Identifier: MIT
// From a declaration to a solution: what can ever be needed, which physical images that takes, where they lie.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

std::string usage_names(VkImageUsageFlags usage) {
    struct Name {
        VkImageUsageFlags bit;
        const char* text;
    };
    constexpr Name usage_table[] = {{VK_IMAGE_USAGE_SAMPLED_BIT, "SAMPLED"},
                                    {VK_IMAGE_USAGE_STORAGE_BIT, "STORAGE"},
                                    {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "COLOR_ATTACHMENT"},
                                    {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "DEPTH_STENCIL_ATTACHMENT"},
                                    {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "TRANSFER_SRC"},
                                    {VK_IMAGE_USAGE_TRANSFER_DST_BIT, "TRANSFER_DST"}};
    std::string text;
    for (const Name& name : usage_table) {
        if ((usage & name.bit) == 0) continue;
        if (!text.empty()) text += " | ";
        text += name.text;
    }
    return text.empty() ? std::string("nothing") : text;
}

class Compiler {
  public:
    Compiler(const Declaration& declaration, const Extents& largest)
        : declaration_(declaration), largest_(largest), solution_(std::make_unique<Solution>()) {}

    Result<std::unique_ptr<const Solution>> run(const Measure& measure) {
        DARKROOM_TRY(find_final_history());
        cull();
        take_over();
        make_slots();
        order_by_rounds();
        DARKROOM_TRY(use_slots());
        DARKROOM_TRY(place(measure));
        find_past();
        return std::unique_ptr<const Solution>(std::move(solution_));
    }

  private:
    struct Needs {
        std::vector<MipMask> mips;  ///< per version
        std::vector<bool> passes;
    };

    /// A history that is read must be written, else "previous" never holds anything.
    Result<> find_final_history() {
        solution_->final_history_version.assign(declaration_.history_count, none);
        for (const Image& image : declaration_.images) {
            if ((image.kind != Slot::Kind::History && image.kind != Slot::Kind::Lasting) || image.is_previous) continue;
            solution_->final_history_version[image.history_index] = image.versions.back();
        }
        for (const PassRecord& pass : declaration_.passes) {
            for (const Read& read : pass.desc.reads) {
                const Image& image = declaration_.image_of(read.version.index);
                if (!image.is_previous) continue;
                if (declaration_.versions[solution_->final_history_version[image.history_index]].producer != none)
                    continue;
                return user_error(fmt::format("pass '{}' reads the previous '{}', but no pass writes the current one",
                                              pass.desc.name, image.desc.name));
            }
        }
        return {};
    }

    void need(Needs& needs, const Read& read, std::int32_t gate) const {
        for (const Alternative& found : alternatives(declaration_, read.version.index, gate, read.instead.index)) {
            if (found.version == none) continue;
            needs.mips[found.version] |= mip_mask(read.mips, declaration_.image_of(found.version).desc.mip_levels);
        }
    }

    /// Walks backwards from what is kept. A pass that reads a history makes its writers needed, and those may come
    /// later: hence the repetition.
    void cull() {
        needs_ = {std::vector<MipMask>(declaration_.versions.size()), std::vector<bool>(declaration_.passes.size())};
        for (std::uint32_t version = 0; version < declaration_.versions.size(); ++version) {
            if (declaration_.versions[version].is_kept) need(needs_, {.version = {version}}, -1);
        }
        std::vector<bool> is_read(declaration_.history_count);
        for (bool is_changed = true; is_changed;) {
            is_changed = false;
            for (std::size_t pass = declaration_.passes.size(); pass-- > 0;) walk(pass);
            for (std::size_t pass = 0; pass < declaration_.passes.size(); ++pass) {
                if (needs_.passes[pass]) is_changed |= mark_histories(declaration_.passes[pass].desc, is_read);
            }
        }
    }

    void walk(std::size_t pass) {
        const PassRecord& record = declaration_.passes[pass];
        bool is_needed = record.desc.has_side_effect;
        for (const Version made : record.made) {
            is_needed |= (needs_.mips[made.index] & declaration_.versions[made.index].mips) != 0;
        }
        needs_.passes[pass] = is_needed;
        for (const Version made : record.made) {
            const VersionRecord& version = declaration_.versions[made.index];
            MipMask rest = needs_.mips[made.index] & ~version.mips;
            if (is_needed && version.keeps_content) rest |= version.mips;
            for (const Alternative& found : alternatives(declaration_, version.replaced, record.desc.gate)) {
                if (found.version == none || declaration_.versions[found.version].image != version.image) continue;
                needs_.mips[found.version] |= rest;
            }
        }
        if (!is_needed) return;
        for (const Read& read : record.desc.reads) need(needs_, read, record.desc.gate);
    }

    bool mark_histories(const PassDesc& pass, std::vector<bool>& is_read) {
        bool is_changed = false;
        for (const Read& read : pass.reads) {
            for (const Alternative& found :
                 alternatives(declaration_, read.version.index, pass.gate, read.instead.index)) {
                if (found.version == none) continue;
                const Image& image = declaration_.image_of(found.version);
                if (!image.carries_over() || is_read[image.history_index]) continue;
                is_read[image.history_index] = is_changed = true;
                need(needs_, {.version = {solution_->final_history_version[image.history_index]}}, -1);
            }
        }
        return is_changed;
    }

    /// Copies the declaration, with passes numbered anew.
    void take_over() {
        Solution& solution = *solution_;
        solution.images = declaration_.images;
        solution.versions = declaration_.versions;
        solution.import_count = declaration_.import_count;
        solution.history_count = declaration_.history_count;
        solution.history_mips.resize(solution.history_count);
        for (const Image& image : solution.images) {
            if (!image.is_previous) continue;
            const MipMask read = needs_.mips[image.versions.front()];
            solution.history_mips[image.history_index] = read != 0 ? read : all_mips(image.desc.mip_levels);
        }
        for (std::size_t pass = 0; pass < declaration_.passes.size(); ++pass) {
            const PassRecord& record = declaration_.passes[pass];
            if (!needs_.passes[pass]) {
                solution.kept_pass.push_back(none);
                solution.culled.push_back(record.desc.name);
                continue;
            }
            solution.kept_pass.push_back(static_cast<std::uint32_t>(solution.passes.size()));
            solution.passes.push_back(record.desc);
            solution.made.push_back(record.made);
        }
        for (VersionRecord& record : solution.versions) {
            if (record.producer != none) record.producer = solution.kept_pass[record.producer];
            if (record.killer != none) record.killer = solution.kept_pass[record.killer];
        }
    }

    std::uint32_t add_slot(const Image& image, std::uint32_t parity) {
        Slot slot{.kind = image.kind,
                  .desc = image.desc,
                  .import_index = image.import_index,
                  .history_index = image.history_index,
                  .history_key = image.history_key,
                  .history_parity = parity,
                  .first_pass = none,
                  .extent = image.desc.size.of(largest_)};
        solution_->slots.push_back(std::move(slot));
        return static_cast<std::uint32_t>(solution_->slots.size() - 1);
    }

    /// Calls function(pass, use, image) for everything a kept pass may touch, fall-backs included.
    template <class Function>
    void for_each_use(const Function& function) const {
        for (std::size_t declared = 0; declared < declaration_.passes.size(); ++declared) {
            const std::uint32_t pass = solution_->kept_pass[declared];
            if (pass == none) continue;
            const PassDesc& desc = declaration_.passes[declared].desc;
            for (const Read& read : desc.reads) {
                for (const Alternative& found :
                     alternatives(declaration_, read.version.index, desc.gate, read.instead.index)) {
                    if (found.version != none) function(pass, read.use, declaration_.versions[found.version].image);
                }
            }
            for (const Write& write : desc.writes) {
                function(pass, write.use, declaration_.versions[write.version.index].image);
            }
        }
    }

    void make_slots() {
        std::vector<bool> is_used(solution_->images.size());
        for_each_use([&](std::uint32_t, Use, std::uint32_t image) { is_used[image] = true; });
        std::vector<bool> is_history_used(solution_->history_count);
        for (std::size_t i = 0; i < solution_->images.size(); ++i) {
            const Image& image = solution_->images[i];
            if (is_used[i] && image.kind == Slot::Kind::History) is_history_used[image.history_index] = true;
        }
        for (Image& image : solution_->images) {
            if (image.import_index != none) image.slots.fill(add_slot(image, 0));
        }
        for (std::size_t i = 0; i < solution_->images.size(); ++i) {
            Image& image = solution_->images[i];
            const bool is_single = image.kind == Slot::Kind::Transient || image.kind == Slot::Kind::Lasting;
            if (is_single && is_used[i]) image.slots.fill(add_slot(image, 0));
            if (image.kind != Slot::Kind::History || image.is_previous || !is_history_used[image.history_index])
                continue;
            image.slots = {add_slot(image, 0), add_slot(image, 1)};
            for (Image& other : solution_->images) {
                if (!other.is_previous || other.history_index != image.history_index) continue;
                other.slots = {image.slots[1], image.slots[0]};
            }
        }
        for (const Slot& slot : solution_->slots) {
            solution_->first_mip.push_back(solution_->mip_count);
            solution_->mip_count += slot.desc.mip_levels;
        }
    }

    void order_by_rounds() {
        Solution& solution = *solution_;
        const auto count = static_cast<std::uint32_t>(solution.passes.size());
        std::vector<Touch> touches;
        for_each_use([&](std::uint32_t pass, Use use, std::uint32_t image) {
            for (const std::uint32_t slot : solution.images[image].slots)
                if (solution.slots[slot].kind != Slot::Kind::Constant) touches.push_back({pass, slot, use});
        });
        const std::vector<std::uint32_t> rounds =
            rounds_of(touches, count, static_cast<std::uint32_t>(solution.slots.size()));
        std::vector<std::uint32_t> order(count), place_of(count);
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](std::uint32_t pass) { return rounds[pass]; });
        std::vector<PassDesc> passes;
        std::vector<std::vector<Version>> made;
        for (const std::uint32_t pass : order) {
            place_of[pass] = static_cast<std::uint32_t>(passes.size());
            solution.rounds.push_back(rounds[pass]);
            passes.push_back(std::move(solution.passes[pass]));
            made.push_back(std::move(solution.made[pass]));
        }
        solution.passes = std::move(passes);
        solution.made = std::move(made);
        const auto move = [&](std::uint32_t& pass) { pass = pass == none ? none : place_of[pass]; };
        std::ranges::for_each(solution.kept_pass, move);
        for (VersionRecord& record : solution.versions) {
            move(record.producer);
            move(record.killer);
        }
    }

    static void note(ImageUses& uses, Use use) {
        const VkImageLayout layout = layout_of(use);
        const bool is_first = uses.stages == 0, was_written = (uses.access & all_writes) != 0;
        uses.stages |= stages_of(use);
        uses.access |= access_of(use);
        if (is_first) {
            uses.first_layout = uses.last_layout = layout;
        } else if (was_written || is_write(use)) {
            uses.last_layout = layout;
        } else if (layout != uses.first_layout) {
            // What is loaded is in GENERAL, where it can be sampled as well.
            uses.first_layout = uses.last_layout = VK_IMAGE_LAYOUT_GENERAL;
        }
    }

    std::uint32_t first_of_round(std::uint32_t pass) const {
        const auto& rounds = solution_->rounds;
        return static_cast<std::uint32_t>(std::ranges::lower_bound(rounds, rounds[pass]) - rounds.begin());
    }
    std::uint32_t last_of_round(std::uint32_t pass) const {
        const auto& rounds = solution_->rounds;
        return static_cast<std::uint32_t>(std::ranges::upper_bound(rounds, rounds[pass]) - rounds.begin()) - 1;
    }

    /// Usage flags, lifetimes, and what passes do to each slot.
    Result<> use_slots() {
        own_past_.resize(solution_->slots.size());
        for_each_use([&](std::uint32_t pass, Use use, std::uint32_t image) {
            for (const std::uint32_t index : solution_->images[image].slots) {
                Slot& slot = solution_->slots[index];
                slot.usage |= usage_of(use);
                slot.first_pass = std::min(slot.first_pass, first_of_round(pass));
                slot.last_pass = std::max(slot.last_pass, last_of_round(pass));
                own_past_[index].stages |= stages_of(use);
                own_past_[index].access |= access_of(use);
                if (!is_write(use)) own_past_[index].reads |= sight_of(use);
                note(slot.uses, use);
            }
        });
        extend_kept();
        for (Slot& slot : solution_->slots) {
            if (slot.first_pass == none) slot.first_pass = 0;
            if (slot.kind != Slot::Kind::History) continue;
            // A reset clears, and other images of it are copied. What another plan makes of the history is not known
            // here, so all plans leave it in the layout that most readers want.
            slot.usage |=
                VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
            slot.rest_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        }
        return check_imports();
    }

    /// A kept transient is wanted after the frame, by somebody whose stage nobody knows.
    void extend_kept() {
        if (solution_->passes.empty()) return;
        for (std::uint32_t version = 0; version < declaration_.versions.size(); ++version) {
            if (!declaration_.versions[version].is_kept) continue;
            for (const Alternative& found : alternatives(declaration_, version, -1)) {
                if (found.version == none) continue;
                const Image& image = solution_->images[declaration_.versions[found.version].image];
                if (image.kind != Slot::Kind::Transient || image.slots[0] == none) continue;
                solution_->slots[image.slots[0]].last_pass = static_cast<std::uint32_t>(solution_->passes.size() - 1);
                own_past_[image.slots[0]].stages |= VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            }
        }
    }

    Result<> check_imports() const {
        Result<> result;
        for_each_use([&](std::uint32_t pass, Use use, std::uint32_t index) {
            const Image& image = solution_->images[index];
            const VkImageUsageFlags missing = usage_of(use) & ~image.allowed_usage;
            if (!result || image.import_index == none || missing == 0) return;
            result = user_error(fmt::format("pass '{}' uses the host's image '{}' as {}, but it was created for {}",
                                            solution_->passes[pass].name, image.desc.name, usage_names(missing),
                                            usage_names(image.allowed_usage)));
        });
        return result;
    }

    Result<> place(const Measure& measure) {
        std::vector<Interval> intervals;
        std::vector<std::uint32_t> owners;
        for (std::uint32_t index = 0; index < solution_->slots.size(); ++index) {
            Slot& slot = solution_->slots[index];
            if (slot.kind == Slot::Kind::History) {  // its memory is the pool's; whether there can be one is asked here
                DARKROOM_TRY(measure(slot.desc, slot.usage, largest_));
            }
            if (slot.kind != Slot::Kind::Transient) continue;
            if (slot.desc.is_buffer()) {
                // No device asks for more than 256 between storage or uniform buffers.
                slot.offset = solution_->buffer_bytes;
                slot.size = slot.desc.buffer_bytes;
                solution_->buffer_bytes += (slot.size + 255) / 256 * 256;
                continue;
            }
            DARKROOM_TRY_VALUE(auto measured, measure(slot.desc, slot.usage, largest_));
            solution_->memory_type_bits &= measured.memory_type_bits;
            solution_->memory_alignment = std::max(solution_->memory_alignment, measured.alignment);
            if (solution_->memory_type_bits == 0) {
                return machine_error(
                    fmt::format("image '{}' accepts the memory types {:#x}: none of them suits the other "
                                "transient images as well",
                                slot.desc.name, measured.memory_type_bits));
            }
            slot.size = measured.size;
            solution_->transient_bytes_unaliased += measured.size;
            intervals.push_back({.size = measured.size,
                                 .alignment = std::max<VkDeviceSize>(measured.alignment, 1),
                                 .first = slot.first_pass,
                                 .last = slot.last_pass});
            owners.push_back(index);
        }
        solution_->transient_bytes = pack(intervals);
        for (std::size_t i = 0; i < owners.size(); ++i) solution_->slots[owners[i]].offset = intervals[i].offset;
        return {};
    }

    void find_past() {
        solution_->past.resize(solution_->slots.size());
        for (std::size_t i = 0; i < solution_->slots.size(); ++i) {
            for (std::size_t j = 0; j < solution_->slots.size(); ++j) {
                const Slot &a = solution_->slots[i], &b = solution_->slots[j];
                const bool is_aliased = a.kind == Slot::Kind::Transient && b.kind == Slot::Kind::Transient &&
                                        !a.desc.is_buffer() && !b.desc.is_buffer() && a.offset < b.offset + b.size &&
                                        b.offset < a.offset + a.size;
                if (i != j && !is_aliased) continue;
                solution_->past[i].stages |= own_past_[j].stages;
                solution_->past[i].access |= own_past_[j].access;
                solution_->past[i].reads |= own_past_[j].reads;
            }
        }
    }

    const Declaration& declaration_;
    Extents largest_;
    std::unique_ptr<Solution> solution_;
    Needs needs_;
    std::vector<Past> own_past_;
};

}  // namespace

Result<Compiled> Graph::compile(const Extents& largest, const Measure& measure) const {
    DARKROOM_TRY(validate(*declaration_, largest));
    DARKROOM_TRY_VALUE(auto solution, Compiler(*declaration_, largest).run(measure));
    return Compiled(std::move(solution));
}

Compiled::Compiled(std::unique_ptr<const Solution> solution) : solution_(std::move(solution)) {}
Compiled::~Compiled() = default;
Compiled::Compiled(Compiled&&) noexcept = default;
Compiled& Compiled::operator=(Compiled&&) noexcept = default;

std::span<const PassDesc> Compiled::passes() const { return solution_->passes; }
std::span<const std::uint32_t> Compiled::rounds() const { return solution_->rounds; }
std::span<const std::string> Compiled::culled() const { return solution_->culled; }
std::span<const Slot> Compiled::slots() const { return solution_->slots; }
VkDeviceSize Compiled::transient_bytes() const { return solution_->transient_bytes; }
VkDeviceSize Compiled::transient_bytes_unaliased() const { return solution_->transient_bytes_unaliased; }
VkDeviceSize Compiled::buffer_bytes() const { return solution_->buffer_bytes; }
std::uint32_t Compiled::memory_type_bits() const { return solution_->memory_type_bits; }
VkDeviceSize Compiled::memory_alignment() const { return solution_->memory_alignment; }
std::uint32_t Compiled::kept_pass_of(PassId declared) const {
    return declared.index < solution_->kept_pass.size() ? solution_->kept_pass[declared.index] : none;
}
std::span<const Version> Compiled::made(std::uint32_t pass) const { return solution_->made[pass]; }

}  // namespace darkroom::graph
