// SPDX-License-Identifier: MIT
// A look in a Composer: from nothing, or from what another look has put there.
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/look.hpp>
#include <map>

#include "core/caught.hpp"
#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/apply/look_stack.hpp"
#include "looks/look_modulation.hpp"

namespace darkroom {

namespace {

/// The look's tables and pictures in a Composer, each defined once.
class Definitions {
  public:
    explicit Definitions(Composer& composer) : composer_(composer) {}

    /// What the Composer has already.
    void know(const LookResource* resource, std::uint32_t number) {
        if (resource != nullptr && composer_.resources().contains(number))
            known_.emplace(resource->data.get(), Resource{number});
    }
    Result<> define(const LookResource* resource, std::string_view key) {
        if (resource == nullptr || resource->data == nullptr)
            return user_error(fmt::format("{}: the entry has no such resource", key));
        if (used_.contains(resource->data.get())) return {};
        if (const auto found = known_.find(resource->data.get()); found != known_.end()) {
            used_.insert(*found);
            return {};
        }
        const auto number = composer_.define(*resource->data);
        if (!number)
            return failure(Error{number.error().fault,
                                 fmt::format("{} = \"{}\": {}", key, printable(resource->file), number.error().text)});
        used_.emplace(resource->data.get(), *number);
        return {};
    }
    Result<> define(const PlacedEntry& placed) {
        const LookEntry& entry = *placed.entry;
        for (const ParamInfo& row : entry.effect->parameters.rows)
            if (placed.has_values && row.kind == Kind::Resource && entry.words[row.word] != 0)
                DARKROOM_TRY(define(resource_of(entry, row), row.name));
        for (std::size_t i = 0; i < wires.size(); ++i)
            if (placed.ends[i].picture != nullptr) DARKROOM_TRY(define(placed.ends[i].picture, wires[i].key));
        return {};
    }
    Resource number_of(const LookResource& resource) const { return used_.at(resource.data.get()); }
    /// The entry's values with the Composer's numbers of its resources.
    std::vector<std::uint32_t> words_of(const PlacedEntry& placed) const {
        const std::span<const std::uint32_t> defaults = placed.entry->effect->parameters.defaults;
        if (!placed.has_values) return {defaults.begin(), defaults.end()};
        std::vector<std::uint32_t> words = placed.entry->words;
        for (const ParamInfo& row : placed.entry->effect->parameters.rows)
            if (row.kind == Kind::Resource && words[row.word] != 0)
                words[row.word] = number_of(*resource_of(*placed.entry, row)).id;
        return words;
    }
    void forget_unused() { forget(known_, used_); }
    void take_back() { forget(used_, known_); }

  private:
    using Numbers = std::map<const ResourceData*, Resource>;
    void forget(const Numbers& these, const Numbers& but_those) {
        for (const auto& [data, number] : these)
            if (!but_those.contains(data)) composer_.forget(number);
    }

    Composer& composer_;
    Numbers known_, used_;
};

class Follower {
  public:
    Follower(const Look& was, const Look& is, Composer& composer)
        : was_(was), is_(is), composer_(composer), definitions_(composer), modulation_(was, composer) {}

    Result<Followed> run(const ApplyOptions& options) {
        DARKROOM_TRY_VALUE(placed_, stack_of(is_, options));
        find_handles();
        for (const PlacedEntry& one : placed_)
            if (Result<> done = definitions_.define(one); !done) {
                definitions_.take_back();
                return failure(
                    Error{done.error().fault, fmt::format("{}: {}: {}", is_.shown_name, one.name, done.error().text)});
            }
        remove_rest();
        for (std::size_t i = 0; i < placed_.size(); ++i) DARKROOM_TRY(place(i));
        for (std::size_t i = 0; i < placed_.size(); ++i) DARKROOM_TRY(wire(i));
        definitions_.forget_unused();
        DARKROOM_TRY_VALUE(const bool is_moved, modulation_.follow(is_));
        return Followed{needs_compile_ || is_moved};
    }

  private:
    /// Which entries the Composer has, and which tables they name.
    void find_handles() {
        const std::vector<std::string> names = entry_names(was_);
        const std::vector<const LookEntry*> others = counterparts(is_, was_);
        handles_.resize(placed_.size());
        first_ = composer_.size();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto handle = composer_.find(names[i]);
            if (!handle) continue;
            const LookEntry& entry = was_.entries[i];
            for (std::size_t k = 0; k < first_; ++k)
                if (composer_.entry(k) == *handle) first_ = k;
            know_resources(entry, *handle);
            const auto is_this = [&](const PlacedEntry& one) {
                return others[static_cast<std::size_t>(one.entry - is_.entries.data())] == &entry;
            };
            const auto found = std::ranges::find_if(placed_, is_this);
            if (found == placed_.end())
                rest_.push_back(*handle);
            else
                handles_[static_cast<std::size_t>(found - placed_.begin())] = *handle;
        }
    }

    void know_resources(const LookEntry& entry, Handle handle) {
        const std::span<const std::uint32_t> words = composer_.words(handle);
        if (composer_.info(handle) != entry.effect) return;
        for (const ParamInfo& row : entry.effect->parameters.rows)
            if (row.kind == Kind::Resource) definitions_.know(resource_of(entry, row), words[row.word]);
        for (const WireInfo& end : wires)
            if (end.is_reference) definitions_.know(resource_of(entry, end), (composer_.desc(handle)->*end.handle).id);
    }

    void remove_rest() {
        for (const Handle handle : rest_) (void)composer_.remove(handle);
        needs_compile_ |= !rest_.empty();
    }

    Result<> place(std::size_t i) {
        const PlacedEntry& placed = placed_[i];
        const EffectInfo& effect = *placed.entry->effect;
        const std::vector<std::uint32_t> words = definitions_.words_of(placed);
        Handle& handle = handles_[i];
        const Handle at = composer_.entry(first_ + i);
        if (!handle.is_given()) {
            needs_compile_ = true;
            if (!at.is_given()) {
                handle = composer_.add(effect, words.data(), placed.desc);
                return handle.is_given() ? Result<>{} : machine_error("out of memory", ErrorCode::OutOfMemory);
            }
            DARKROOM_TRY_VALUE(handle, composer_.insert(at, effect, words.data(), placed.desc));
            return {};
        }
        if (handle != at) {
            needs_compile_ = true;
            DARKROOM_TRY(composer_.move(handle, at));
        }
        if (composer_.info(handle) != &effect) {
            needs_compile_ = true;
            return composer_.replace(handle, effect, words.data());
        }
        return set(placed, handle, words);
    }

    Result<> set(const PlacedEntry& placed, Handle handle, std::span<const std::uint32_t> words) {
        const EffectInfo& effect = *placed.entry->effect;
        for (const ParamInfo& row : effect.parameters.rows) {
            const auto own = words.subspan(row.word, row.words);
            if (std::ranges::equal(own, composer_.words(handle).subspan(row.word, row.words))) continue;
            needs_compile_ |= row.is_at_compile;
            DARKROOM_TRY(composer_.set(handle, row.name, own));
        }
        DARKROOM_TRY(composer_.set_enabled(handle, placed.desc.enabled));
        // What has passes is merged with its input only if it was not to replace it when the stack was compiled: what
        // is refused here, is wired anew.
        needs_compile_ |= composer_.desc(handle)->opacity == 1 && placed.desc.opacity != 1 && effect.build;
        (void)composer_.set_opacity(handle, placed.desc.opacity);
        return {};
    }

    Handle handle_of(std::string_view output) const {
        for (const auto& [name, handle] : given_wires)
            if (name == output) return handle;
        for (std::size_t i = 0; i < placed_.size(); ++i)
            if (placed_[i].entry->output == output) return handles_[i];
        return {};
    }

    Result<> wire(std::size_t i) {
        EntryDesc desc = placed_[i].desc;
        for (std::size_t k = 0; k < wires.size(); ++k) {
            const PlacedEntry::Wire& end = placed_[i].ends[k];
            if (end.picture != nullptr)
                desc.*wires[k].handle = Composer::picture_of(definitions_.number_of(*end.picture));
            else if (!end.output.empty())
                desc.*wires[k].handle = end.is_previous ? handle_of(end.output).previous() : handle_of(end.output);
        }
        const EntryDesc& now = *composer_.desc(handles_[i]);
        const auto parts = [](const EntryDesc& of) {
            return std::tie(of.input, of.source, of.second, of.mask, of.name, of.output, of.opacity, of.blend,
                            of.scale.numerator, of.scale.denominator, of.format);
        };
        if (parts(now) == parts(desc)) return {};
        needs_compile_ = true;
        return composer_.rewire(handles_[i], desc);
    }

    const Look& was_;
    const Look& is_;
    Composer& composer_;
    Definitions definitions_;
    ModulationFollower modulation_;
    std::vector<PlacedEntry> placed_;
    std::vector<Handle> handles_;  ///< of those; not given: not there yet
    std::vector<Handle> rest_;     ///< of what has no place any more
    std::size_t first_ = 0;        ///< where the look's entries begin
    bool needs_compile_ = false;
};

}  // namespace

Result<Followed> follow(const Look& was, const Look& is, Composer& composer, const ApplyOptions& options) try {
    return Follower(was, is, composer).run(options);
} catch (...) {
    return caught("follow");
}

Result<> apply(const Look& look, Composer& composer, const ApplyOptions& options) try {
    const auto done = follow(Look{.is_flat = false}, look, composer, options);
    return done ? Result<>{} : failure(done.error());
} catch (...) {
    return caught("apply");
}

}  // namespace darkroom
