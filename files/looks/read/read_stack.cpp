// SPDX-License-Identifier: MIT
// The list [[stack]]: effects in any order, wired by the names of outputs.
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effect.hpp>
#include <map>
#include <optional>
#include <system_error>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/read/look_reader.hpp"

namespace darkroom {

namespace {

/// The work of a plan grows with the square of them.
constexpr std::size_t max_entries = 4096;

class StackReader {
  public:
    explicit StackReader(LookReader& reader) : reader_(reader) {}

    Look read(const toml::array& array) {
        for (const toml::node& node : array) {
            if (const toml::table* const table = node.as_table())
                read_entry(*table);
            else
                reader_.report(node, Weight::Wrong,
                               fmt::format("an entry of stack is {}: expected a table", show(node)));
        }
        const auto shown_entry = [&](std::size_t index) { return shown(index); };
        for (const LookProblem& problem : problems_of(look_, shown_entry)) {
            const toml::table& table = *origins_[problem.entry].table;
            const toml::node* const place = problem.key.empty() ? nullptr : table.get(problem.key);
            reader_.report(place == nullptr ? table : *place, Weight::Wrong, problem.text);
        }
        return std::move(look_);
    }

  private:
    // One entry of the file; `table` is where its keys stand.
    struct Origin {
        const toml::table* table = nullptr;
        std::size_t number = 0;  ///< in the file, from 1
    };

    void read_entry(const toml::table& table) {
        ++number_;
        std::optional<LookEntry> made = read_effect(table);
        if (!made) return;
        LookEntry& entry = *made;
        for (const auto& [key, node] : table)
            if (key.str() != "effect") read_key(entry, key, node);
        reader_.put_lens(entry, [&](std::string_view row) { return table.contains(row); });
        look_.entries.push_back(std::move(entry));
        origins_.push_back({&table, number_});
    }

    std::optional<LookEntry> read_effect(const toml::table& table) {
        const toml::node* const node = table.get("effect");
        if (node == nullptr) {
            reader_.report(table, Weight::Wrong, fmt::format("stack entry {} has no key 'effect'", number_));
            return std::nullopt;
        }
        const auto* const name = node->as_string();
        if (name != nullptr && name->get().ends_with(".glsl")) return read_file(*node, name->get());
        const EffectInfo* const effect = name == nullptr ? nullptr : find_effect(name->get());
        if (effect != nullptr) return entry_of(*effect);
        std::vector<std::string> names;
        for (const EffectInfo* const known : all_effects()) names.emplace_back(known->name);
        reader_.report(*node, Weight::Wrong,
                       fmt::format("effect = {}{}, and the file of one (.glsl)", show(*node),
                                   alternatives(name == nullptr ? "" : name->get(), names)));
        return std::nullopt;
    }

    /// However often a look names a file, it is read once, and one effect.
    std::optional<LookEntry> read_file(const toml::node& node, const std::string& name) {
        const auto refuse = [&](std::string_view why) {
            reader_.report(node, Weight::Wrong, fmt::format("effect = {}: {}", show(node), why));
            return std::nullopt;
        };
        if (!reader_.options().allows_custom_effects)
            return refuse("the effect of a file is code, which is not allowed for this look");
        std::error_code ignored;
        const std::filesystem::path file = reader_.options().folder / name;
        const auto [found, is_new] = files_.try_emplace(std::filesystem::weakly_canonical(file, ignored));
        if (is_new) {
            Result<LookEntry> entry = custom_entry(file);
            if (!entry) return refuse(entry.error().text);
            if (const Result<> shared = share_effect(look_, *entry); !shared) return refuse(shared.error().text);
            found->second = std::move(*entry);
        }
        if (!found->second) return std::nullopt;
        LookEntry entry = *found->second;
        entry.effect_file = name;
        return entry;
    }

    void read_key(LookEntry& entry, const toml::key& key, const toml::node& node) {
        const std::string shown = printable(key.str());
        for (const WireInfo& wire : wires) {
            if (wire.key != key.str()) continue;
            return read_wire(entry, wire, node);
        }
        for (const ParamInfo& row : entry_rows.rows) {
            if (row.name != key.str()) continue;
            reader_.take(row, entry.state, node, shown);
            return;
        }
        if (const ParamInfo* const row = entry.effect->parameters.find(key.str())) {
            reader_.take(*row, entry, node, shown);
            return;
        }
        read_unknown(*entry.effect, key, node);
    }

    void read_wire(LookEntry& entry, const WireInfo& wire, const toml::node& node) {
        const auto* const text = node.as_string();
        std::string_view name = text == nullptr ? std::string_view() : text->get();
        if (wire.is_reference && is_file_name(name)) return reader_.take(wire, entry, text->get(), node);
        if (wire.is_reference && name.ends_with(previous_suffix)) name.remove_suffix(previous_suffix.size());
        if (is_look_name(name)) {
            entry.*wire.member = text->get();
            return;
        }
        reader_.report(node, Weight::Wrong,
                       fmt::format("{} = {}: expected a name of letters, digits, '_' and '-'{}", wire.key, show(node),
                                   wire.is_reference ? ", or the file of a picture" : ""));
    }

    void read_unknown(const EffectInfo& effect, const toml::key& key, const toml::node& node) {
        std::vector<std::string> known{"effect"};
        for (const WireInfo& wire : wires) known.emplace_back(wire.key);
        for (const ParamInfo& row : entry_rows.rows) known.emplace_back(row.name);
        std::string meant;
        for (const ParamInfo& row : effect.parameters.rows) {
            known.emplace_back(row.name);
            const bool is_own = row.name == effect.name && stands_for_amount(key.str(), effect.name);
            if (is_own || key.str() == flat_key(effect.name, row.name)) meant = row.name;
        }
        const auto allowed = [&](const std::string& near) {
            const ParamInfo* row = effect.parameters.find(near);
            for (const ParamInfo& own : entry_rows.rows)
                if (own.name == near) row = &own;
            return row == nullptr ? "a name" : interval(*row);
        };
        reader_.report_unknown(key, node, known, allowed, meant);
    }

    std::string shown(std::size_t index) const {
        return fmt::format("stack entry {} ({})", origins_[index].number, look_.entries[index].effect->name);
    }

    LookReader& reader_;
    Look look_{.is_flat = false};
    std::vector<Origin> origins_;
    std::size_t number_ = 0;
    std::map<std::filesystem::path, std::optional<LookEntry>> files_;  ///< of custom effects; empty: a wrong one
};

}  // namespace

Look read_stack(LookReader& reader, const toml::node& node) {
    const toml::array* const array = node.as_array();
    if (array != nullptr && array->size() <= max_entries) return StackReader(reader).read(*array);
    reader.report(node, Weight::Wrong,
                  array == nullptr ? fmt::format("stack = {}: expected [[stack]] entries", show(node))
                                   : fmt::format("{} entries of stack: allowed are {}", array->size(), max_entries));
    return Look{.is_flat = false};
}

}  // namespace darkroom
