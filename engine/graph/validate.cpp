// SPDX-License-Identifier: MIT
// The errors of a declaration. A gate may be on or off in any frame, so every read is followed through each
// combination that matters to it: the alternatives.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

enum class Certainty : std::uint8_t { On, Off, Maybe };

bool implies(const Declaration& declaration, std::int32_t gate, std::int32_t other) {
    if (gate == other) return true;
    return std::ranges::any_of(declaration.implications, [&](const Implication& implication) {
        return implication.gate == gate && implies(declaration, implication.implied, other);
    });
}

Certainty certainty(const Declaration& declaration, std::int32_t gate, std::span<const Assumption> assumptions) {
    if (gate < 0) return Certainty::On;
    for (const Assumption& assumption : assumptions) {
        if (assumption.is_on && implies(declaration, assumption.gate, gate)) return Certainty::On;
        if (!assumption.is_on && implies(declaration, gate, assumption.gate)) return Certainty::Off;
    }
    return Certainty::Maybe;
}

class Validator {
  public:
    Validator(const Declaration& declaration, const Extents& largest) : declaration_(declaration), largest_(largest) {}

    Result<> run() const {
        for (const Image& image : declaration_.images) {
            DARKROOM_TRY(check_image(image.desc));
        }
        if (!declaration_.first_error.empty()) return user_error(declaration_.first_error);
        DARKROOM_TRY(check_cycles());
        for (std::uint32_t pass = 0; pass < declaration_.passes.size(); ++pass) {
            DARKROOM_TRY(check_pass(pass));
        }
        for (std::uint32_t version = 0; version < declaration_.versions.size(); ++version) {
            if (!declaration_.versions[version].is_kept) continue;
            DARKROOM_TRY(check_kept(version));
        }
        return {};
    }

  private:
    const std::string& image_name(std::uint32_t version) const { return declaration_.image_of(version).desc.name; }
    const std::string& pass_name(std::uint32_t pass) const { return declaration_.passes[pass].desc.name; }
    std::int32_t gate_of(std::uint32_t pass) const { return declaration_.passes[pass].desc.gate; }

    Result<> check_image(const ImageDesc& desc) const {
        if (desc.is_buffer()) return {};
        if (desc.size.denominator == 0 || (desc.size.numerator == 0 && desc.size.width == 0)) {
            return user_error(fmt::format("image '{}' has the size {}/{} of the frame: both must be at least 1",
                                          desc.name, desc.size.numerator, desc.size.denominator));
        }
        const VkExtent2D extent = desc.size.of(largest_);
        const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(extent.width, extent.height)));
        if (desc.mip_levels == 0 || desc.mip_levels > most) {
            return user_error(fmt::format("image '{}' of {}x{} has {} mip levels: 1 to {} are allowed", desc.name,
                                          extent.width, extent.height, desc.mip_levels, most));
        }
        if (desc.array_layers == 0)
            return user_error(fmt::format("image '{}' has 0 layers: at least 1 is needed", desc.name));
        if (desc.format == VK_FORMAT_UNDEFINED) return user_error(fmt::format("image '{}' has no format", desc.name));
        return {};
    }

    Result<> check_cycles() const {
        const std::size_t count = declaration_.versions.size();
        for (std::uint32_t start = 0; start < count; ++start) {
            std::string path = fmt::format("'{}'", image_name(start));
            std::uint32_t version = declaration_.versions[start].next();
            for (std::size_t step = 0; version != none && step < count; ++step) {
                path += fmt::format(" -> '{}'", image_name(version));
                if (version == start) return user_error("fall-backs form a cycle: " + path);
                version = declaration_.versions[version].next();
            }
        }
        return {};
    }

    Result<> check_pass(std::uint32_t pass) const {
        const PassRecord& record = declaration_.passes[pass];
        for (const Read& read : record.desc.reads) {
            DARKROOM_TRY(check_read(pass, read));
        }
        for (const Version made : record.made) {
            DARKROOM_TRY(check_kept_content(pass, made.index));
        }
        return check_layouts(record);
    }

    /// Follows `read` through all its alternatives.
    Result<> check_read(std::uint32_t pass, const Read& read) const {
        DARKROOM_TRY(check_own_cycle(pass, read));
        for (const Alternative& found :
             alternatives(declaration_, read.version.index, gate_of(pass), read.instead.index)) {
            if (found.version == none) {
                return user_error(fmt::format(
                    "pass '{}' reads '{}', but pass '{}' that writes it may be off: it needs a fall-back, or the same "
                    "gate",
                    pass_name(pass), image_name(found.last), pass_name(declaration_.versions[found.last].producer)));
            }
            const Image& image = declaration_.image_of(found.version);
            const std::string what = describe(pass, read.version.index, found.version);
            const std::uint32_t producer = declaration_.versions[found.version].producer;
            if (producer != none && producer >= pass) {
                return user_error(fmt::format("{} before pass '{}' wrote it", what, pass_name(producer)));
            }
            const MipMask mips = mip_mask(read.mips, image.desc.mip_levels);
            DARKROOM_TRY(check_overwritten(pass, found, mips, what));
            DARKROOM_TRY(check_content(found, mips, what));
        }
        return {};
    }

    /// What a reader asks for itself must not lead back to what it stands in for.
    Result<> check_own_cycle(std::uint32_t pass, const Read& read) const {
        if (!read.instead.is_valid()) return {};
        std::uint32_t own = read.instead.index;
        for (std::uint32_t start = read.version.index; start != none && own != none;
             start = declaration_.versions[start].next(own)) {
            std::string path = fmt::format("'{}'", image_name(start));
            for (std::uint32_t version = read.instead.index; version != none;
                 version = declaration_.versions[version].next()) {
                path += fmt::format(" -> '{}'", image_name(version));
                if (version == start)
                    return user_error(fmt::format("fall-backs of pass '{}' form a cycle: {}", pass_name(pass), path));
            }
        }
        return {};
    }

    std::string describe(std::uint32_t pass, std::uint32_t version, std::uint32_t resolved) const {
        if (version == resolved) return fmt::format("pass '{}' reads '{}'", pass_name(pass), image_name(version));
        const std::uint32_t producer = declaration_.versions[version].producer;
        return fmt::format("pass '{}' reads '{}' (instead of '{}' while pass '{}' is off)", pass_name(pass),
                           image_name(resolved), image_name(version), pass_name(producer));
    }

    /// A pass that runs before `pass`, or `pass` itself, must not have replaced what it reads.
    Result<> check_overwritten(std::uint32_t pass, const Alternative& found, MipMask mips, const std::string& what,
                               std::uint32_t own_write = none) const {
        for (const std::uint32_t later : declaration_.image_of(found.version).versions) {
            const VersionRecord& record = declaration_.versions[later];
            if (later <= found.version || later == own_write || record.producer > pass || (record.mips & mips) == 0)
                continue;
            if (certainty(declaration_, gate_of(record.producer), found.assumptions) == Certainty::Off) continue;
            if (record.producer == pass) {
                return user_error(what + " and writes the same mip level: StorageReadWrite or ColorBlend do both");
            }
            return user_error(fmt::format("{} after pass '{}' overwrote it", what, pass_name(record.producer)));
        }
        return {};
    }

    /// Every level of `mips` must have been written, whichever gates are off beyond those assumed.
    Result<> check_content(const Alternative& found, MipMask mips, const std::string& what) const {
        const Image& image = declaration_.image_of(found.version);
        for (std::uint32_t level = 0; level < image.desc.mip_levels; ++level) {
            if (!has_mip(mips, level)) continue;
            const auto level_text = image.desc.mip_levels > 1 ? fmt::format(", mip level {}", level) : std::string();
            std::uint32_t version = found.version;
            while (declaration_.versions[version].producer != none) {
                const VersionRecord& record = declaration_.versions[version];
                const bool is_on =
                    certainty(declaration_, gate_of(record.producer), found.assumptions) == Certainty::On;
                if (is_on && has_mip(record.mips, level) && !record.keeps_content) break;
                if (!is_on && record.next() != record.replaced) {
                    return user_error(fmt::format("{}{}: pass '{}', which writes part of it, may be off", what,
                                                  level_text, pass_name(record.producer)));
                }
                version = record.replaced;
            }
            if (declaration_.versions[version].producer == none && !image.starts_defined()) {
                return user_error(fmt::format("{}{}: declared, never written", what, level_text));
            }
        }
        return {};
    }

    /// A write that keeps content is a read of the version it replaces, and that must lie in the same image.
    Result<> check_kept_content(std::uint32_t pass, std::uint32_t made) const {
        const VersionRecord& record = declaration_.versions[made];
        if (!record.keeps_content) return {};
        for (const Alternative& found : alternatives(declaration_, record.replaced, gate_of(pass))) {
            const bool is_same = found.version != none && declaration_.versions[found.version].image == record.image;
            if (!is_same) {
                return user_error(fmt::format(
                    "pass '{}' keeps the content of '{}', but pass '{}' that writes it may be off: another image "
                    "cannot "
                    "stand in for it",
                    pass_name(pass), image_name(record.replaced),
                    pass_name(declaration_.versions[found.version == none ? found.last : record.replaced].producer)));
            }
            const std::string what = describe(pass, record.replaced, found.version);
            DARKROOM_TRY(check_overwritten(pass, found, record.mips, what, made));
            DARKROOM_TRY(check_content(found, record.mips, what));
        }
        return {};
    }

    /// In one pass, a mip level can be in one layout only, whatever the fall-backs make of its reads.
    Result<> check_layouts(const PassRecord& pass) const {
        struct Access {
            std::uint32_t image;
            MipMask mips;
            VkImageLayout layout;
        };
        std::vector<Access> accesses;
        for (const Read& read : pass.desc.reads) {
            for (const Alternative& found :
                 alternatives(declaration_, read.version.index, pass.desc.gate, read.instead.index)) {
                const std::uint32_t image = declaration_.versions[found.version].image;
                const MipMask mips = mip_mask(read.mips, declaration_.images[image].desc.mip_levels);
                accesses.push_back({image, mips, layout_of(read.use)});
            }
        }
        for (std::size_t i = 0; i < accesses.size(); ++i) {
            for (std::size_t j = i + 1; j < accesses.size(); ++j) {
                const Access &a = accesses[i], &b = accesses[j];
                if (a.image != b.image || (a.mips & b.mips) == 0 || a.layout == b.layout) continue;
                return user_error(fmt::format("pass '{}' reads '{}' in two ways that need different layouts",
                                              pass.desc.name, declaration_.images[a.image].desc.name));
            }
        }
        return {};
    }

    Result<> check_kept(std::uint32_t version) const {
        const VersionRecord& record = declaration_.versions[version];
        const Image& image = declaration_.images[record.image];
        if (record.killer != none) {
            return user_error(fmt::format("'{}' is kept, but pass '{}' overwrites that version", image.desc.name,
                                          pass_name(record.killer)));
        }
        if (image.kind == Slot::Kind::History) return {};
        const std::string what = fmt::format("'{}' is kept", image.desc.name);
        for (const Alternative& found : alternatives(declaration_, version, -1)) {
            const bool is_elsewhere =
                found.version != none && declaration_.versions[found.version].image != record.image;
            if (found.version == none || (is_elsewhere && image.kind == Slot::Kind::Import)) {
                const std::uint32_t writer =
                    is_elsewhere ? record.producer : declaration_.versions[found.last].producer;
                return user_error(fmt::format(
                    "{}, but pass '{}' that writes it may be off: {}", what, pass_name(writer),
                    is_elsewhere ? "another image cannot stand in for the host's" : "it needs a fall-back"));
            }
            const MipMask mips = all_mips(declaration_.image_of(found.version).desc.mip_levels);
            const auto end = static_cast<std::uint32_t>(declaration_.passes.size());
            DARKROOM_TRY(check_overwritten(end, found, mips, what));
            DARKROOM_TRY(check_content(found, mips, what));
        }
        return {};
    }

    const Declaration& declaration_;
    Extents largest_;
};

}  // namespace

std::vector<Alternative> alternatives(const Declaration& declaration, std::uint32_t version, std::int32_t reader_gate,
                                      std::uint32_t instead) {
    std::vector<Alternative> result;
    std::vector<Assumption> assumptions;
    if (reader_gate >= 0) assumptions.push_back({reader_gate, true});
    std::uint32_t last = version;
    while (version != none) {
        last = version;
        const std::uint32_t producer = declaration.versions[version].producer;
        const std::int32_t gate = producer == none ? -1 : declaration.passes[producer].desc.gate;
        const Certainty certain = certainty(declaration, gate, assumptions);
        if (certain == Certainty::On) {
            result.push_back({version, last, assumptions});
            return result;
        }
        if (certain == Certainty::Maybe) {
            result.push_back({version, last, assumptions});
            result.back().assumptions.push_back({gate, true});
            assumptions.push_back({gate, false});
        }
        version = declaration.versions[version].next(instead);
    }
    result.push_back({none, last, assumptions});
    return result;
}

Result<> validate(const Declaration& declaration, const Extents& largest) {
    const VkExtent2D max_extent = largest.scene;
    if (max_extent.width == 0 || max_extent.height == 0) {
        return user_error(
            fmt::format("the largest frame is {}x{}: at least 1x1 is needed", max_extent.width, max_extent.height));
    }
    return Validator(declaration, largest).run();
}

}  // namespace darkroom::graph
